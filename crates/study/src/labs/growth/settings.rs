//! Settings for measuring one shape in several sizes, and the checks of these settings.

use std::time::Duration;

use sixfold::shapes::{Order, ShapeError};
use sixfold::{Facts, UnknownName};

use super::shapes::{SCALABLE_SHAPES, ScalableShape};
use crate::engine::effort::Effort;
use crate::inspect::inspect;
use crate::labs::orders::{chosen_operations, draw_bytes, prepared_bytes};
use crate::labs::study::{Settings, StudyError};
use sixfold_measure::{Operation, StudyMesh};
use sixfold_results::{BackendRefusal, BackendReport};
use sixfold_workload::Backend;

/// Minimum number of faces. Smaller meshes are too short to time.
const MIN_FACES: usize = 100;
/// Maximum number of faces. Corner handles cannot number more triangles.
const MAX_FACES: usize = 500_000_000;
/// Time for which one size is worth measuring.
const MIN_SIZE_BUDGET: Duration = Duration::from_millis(100);
/// Maximum number of sizes.
const MAX_STEPS: usize = 1000;

/// The settings of [`growth`](super::growth): the shape, the sizes of the shape, and the settings
/// of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct GrowthSettings {
    /// The backends, the operations, the seed and the effort. If the list of operations
    /// is empty, [`DEFAULT_OPERATIONS`](crate::DEFAULT_OPERATIONS) are measured.
    pub study: Settings,
    /// Name of a shape in [`SCALABLE_SHAPES`].
    pub shape: String,
    /// Order of the elements in memory.
    pub order: Order,
    /// Seed of the random order. It is the same in all launches of a measurement, so that they measure the
    /// same meshes; the seed in `study` differs from launch to launch.
    pub order_seed: u64,
    /// Approximate number of faces of the smallest size.
    pub from: usize,
    /// Approximate number of faces of the largest size.
    pub to: usize,
    /// Number of sizes. The ratio of two successive sizes is constant.
    pub steps: usize,
}

impl Default for GrowthSettings {
    fn default() -> Self {
        Self {
            study: Settings {
                effort: Effort::Budget(Duration::from_secs(60)),
                ..Settings::default()
            },
            shape: SCALABLE_SHAPES[0].name.into(),
            order: Order::Given,
            order_seed: 1,
            from: 1000,
            to: 1_000_000,
            steps: 13,
        }
    }
}

/// The reason why a shape cannot be measured in several sizes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum GrowthError {
    /// The settings of the study are invalid, or no requested backend can hold the shape.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The shape cannot be built with the requested number of faces.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The name of the shape is unknown.
    #[error(transparent)]
    UnknownShape(#[from] UnknownName),
    /// The largest size is not larger than the smallest size.
    #[error(
        "the first size ({from} faces) is not smaller than the last size ({to} faces): give the \
         smaller first"
    )]
    SizesReversed { from: usize, to: usize },
    /// A requested number of faces is too small to be timed, or too large for the handles of
    /// elements.
    #[error("a size of {faces} faces is out of range: choose from {MIN_FACES} to {MAX_FACES}")]
    SizeOutOfRange { faces: usize },
    /// The number of sizes is below two or too large.
    #[error("{steps} sizes are out of range: choose from 2 to {MAX_STEPS}")]
    StepsOutOfRange { steps: usize },
    /// All requested numbers of faces give the same mesh.
    #[error("the shape has only one size from {from} to {to} faces: use sizes further apart")]
    OneSize { from: usize, to: usize },
}

pub(super) struct Plan {
    pub(super) shape: &'static ScalableShape,
    /// Approximate numbers of faces, ascending.
    pub(super) sizes: Vec<usize>,
    pub(super) backends: Vec<Backend>,
    pub(super) operations: Vec<Operation>,
}

impl GrowthSettings {
    /// Creates settings with the given `study` and with the default shape and sizes. If the time
    /// budget of `study` is short, fewer sizes are measured.
    pub fn from_study(study: Settings) -> Self {
        let usual = Self::default();
        let time_for = match study.effort {
            Effort::Budget(budget) => budget.as_millis() / MIN_SIZE_BUDGET.as_millis(),
            Effort::Rounds(_) => u128::MAX,
        };
        let steps = usize::try_from(time_for).unwrap_or(usize::MAX);
        Self {
            study,
            steps: steps.clamp(2, usual.steps),
            ..usual
        }
    }

    pub(super) fn plan(&self) -> Result<Plan, GrowthError> {
        let Self {
            study,
            from,
            to,
            steps,
            ..
        } = self;
        let (from, to, steps) = (*from, *to, *steps);
        let known = || SCALABLE_SHAPES.iter().map(|shape| shape.name);
        let unknown = || {
            let meanings = SCALABLE_SHAPES.iter().map(|shape| shape.summary);
            UnknownName::new("scalable shape", &self.shape, known()).with_meanings(meanings)
        };
        let shape = ScalableShape::from_name(&self.shape).ok_or_else(unknown)?;
        for faces in [from, to] {
            if !(MIN_FACES..=MAX_FACES).contains(&faces) {
                return Err(GrowthError::SizeOutOfRange { faces });
            }
        }
        if from >= to {
            return Err(GrowthError::SizesReversed { from, to });
        }
        if !(2..=MAX_STEPS).contains(&steps) {
            return Err(GrowthError::StepsOutOfRange { steps });
        }
        // Different face counts can give the same mesh.
        let mut sizes = sizes(from, to, steps);
        sizes.dedup_by_key(|faces| shape.parameters(*faces));
        if sizes.len() < 2 {
            return Err(GrowthError::OneSize { from, to });
        }
        Ok(Plan {
            shape,
            sizes,
            backends: study.chosen_backends()?,
            operations: chosen_operations(study),
        })
    }
}

/// Returns sizes that grow by a constant factor, from `from` to `to`.
fn sizes(from: usize, to: usize, steps: usize) -> Vec<usize> {
    let factor = to as f64 / from as f64;
    let size = |step: usize| from as f64 * factor.powf(step as f64 / (steps - 1) as f64);
    let mut sizes: Vec<usize> = (0..steps).map(|s| size(s).round() as usize).collect();
    sizes.dedup();
    sizes
}

/// Returns the approximate numbers of faces of all sizes, and the backends that cannot hold the
/// smallest size of the shape, each with the reason.
///
/// # Errors
///
/// Returns an error if the settings are invalid, or if no requested backend can hold the shape.
pub fn growth_plan(
    settings: &GrowthSettings,
) -> Result<(Vec<usize>, Vec<BackendRefusal>), GrowthError> {
    let plan = settings.plan()?;
    let small = plan.shape.make(plan.sizes[0])?;
    let inspection = inspect(
        &StudyMesh::new(settings.shape.clone(), small),
        &plan.backends,
    );
    let refused = inspection
        .backends
        .iter()
        .filter_map(BackendReport::refusal);
    let refused: Vec<BackendRefusal> = refused.collect();
    if refused.len() == plan.backends.len() {
        return Err(StudyError::none_holds(refused).into());
    }
    Ok((plan.sizes, refused))
}

/// Estimates the peak memory of [`growth`](super::growth) with these settings, in bytes.
///
/// # Errors
///
/// Returns an error if the settings are invalid.
pub fn growth_bytes(settings: &GrowthSettings) -> Result<u64, GrowthError> {
    let plan = settings.plan()?;
    // A small mesh has the same proportions as a large mesh.
    let small = plan.shape.make(plan.sizes[0])?;
    let counts = small.counts(Facts::from_polygons(&small).edges);
    let counts = scaled(&counts, settings.to as f64 / counts.faces as f64);
    let bytes = plan.backends.iter().map(|b| prepared_bytes(b, &counts));
    let (all, most) = bytes.fold((0, 0), |(all, most): (u64, u64), one| {
        (all + one, most.max(one))
    });
    // Three times the largest structure: the control, and memory for building one structure.
    Ok(all + 3 * most + 2 * draw_bytes(&counts))
}

pub(super) fn scaled(counts: &sixfold_core::Counts, factor: f64) -> sixfold_core::Counts {
    let scaled = |count: usize| (count as f64 * factor).round() as usize;
    sixfold_core::Counts {
        vertices: scaled(counts.vertices),
        edges: scaled(counts.edges),
        faces: scaled(counts.faces),
        corners: scaled(counts.corners),
        uniform: counts.uniform,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_grow_by_one_factor() {
        assert_eq!(
            sizes(1000, 1_000_000, 4),
            [1000, 10_000, 100_000, 1_000_000]
        );
        assert_eq!(sizes(100, 200, 2), [100, 200]);
        assert_eq!(sizes(100, 102, 9), [100, 101, 102]);
        assert_eq!(
            GrowthSettings::default().plan().expect("sound").sizes.len(),
            13
        );
    }

    #[test]
    fn a_plan_has_the_sizes_and_the_backends_that_refuse_the_shape() {
        let mut settings = GrowthSettings {
            shape: "grid".into(),
            from: 1000,
            to: 100_000,
            steps: 3,
            ..GrowthSettings::default()
        };
        let (sizes, refused) = growth_plan(&settings).expect("most backends hold it");
        assert_eq!(sizes, [1000, 10_000, 100_000]);
        let names: Vec<&str> = refused.iter().map(|r| r.backend.as_str()).collect();
        assert_eq!(names, ["corner-table"], "a grid has quads");
        settings.study.backends = vec!["corner-table".into()];
        let error = growth_plan(&settings).expect_err("no backend holds it");
        let expected = GrowthError::Study(StudyError::none_holds(refused));
        assert_eq!(error, expected);
    }

    #[test]
    fn invalid_settings_are_refused_with_a_specific_error() {
        let refused = |change: fn(&mut GrowthSettings)| {
            let mut settings = GrowthSettings::default();
            change(&mut settings);
            let refusal = settings.plan().err().expect("refused");
            assert_eq!(growth_bytes(&settings), Err(refusal.clone()), "same error");
            refusal.to_string()
        };
        type Case = (fn(&mut GrowthSettings), &'static str);
        let cases: [Case; 8] = [
            (|s| s.to = 1001, "further apart"),
            (|s| s.shape = "teapot".into(), "geodesic"),
            (|s| (s.from, s.to) = (5000, 1000), "the smaller first"),
            (|s| (s.from, s.to) = (5000, 5000), "the smaller first"),
            (|s| s.from = 3, "choose from 100"),
            (|s| s.to = usize::MAX, "to 500000000"),
            (|s| s.steps = 1, "from 2"),
            (|s| s.study.backends = vec!["abacus".into()], "half-edge"),
        ];
        for (change, expected) in cases {
            let message = refused(change);
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn a_short_budget_has_fewer_sizes_but_at_least_two() {
        let steps = |milliseconds| {
            let settings = GrowthSettings::from_study(Settings {
                effort: Effort::Budget(Duration::from_millis(milliseconds)),
                ..Settings::default()
            });
            (settings.steps, settings.plan().is_ok())
        };
        assert_eq!(steps(60_000), (GrowthSettings::default().steps, true));
        assert_eq!(steps(550), (5, true));
        assert_eq!(steps(100), (2, true));
    }

    #[test]
    fn the_memory_estimate_grows_with_the_mesh_and_the_structures() {
        let mut settings = GrowthSettings::default();
        let all = growth_bytes(&settings).expect("sound");
        // Seven structures of a million triangles, with about 50 bytes per face.
        assert!((200 << 20..2 << 30).contains(&all), "{all}");
        settings.to = 10_000_000;
        let tenfold = growth_bytes(&settings).expect("sound") as f64 / all as f64;
        assert!((tenfold - 10.0).abs() < 0.01, "{tenfold}");
        settings.study.backends = vec!["corner-table".into()];
        assert!(growth_bytes(&settings).expect("sound") < 6 * all);
    }
}
