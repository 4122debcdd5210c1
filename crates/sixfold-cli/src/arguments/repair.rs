//! Arguments of `sixfold repair`.

use std::path::PathBuf;

use clap::Args;
use sixfold::repair::{
    Components, Facing, FillHoles, HoleFilling, OppositeFaces, Step, Tolerance, Weld, WeldMethod,
};

use super::{MeshInOut, ReadFiles, backend};

const EXAMPLES: &str = "Examples:
  sixfold repair scan.obj --for half-edge -o repaired.obj     all that this structure needs
  sixfold repair cad.obj --weld -o welded.obj                 merge vertices at equal positions
  sixfold repair cad.obj --weld=0.01% --for corner-table -o triangles.obj
  sixfold repair part.obj --cut --fill-holes=20 --json report.json -o filled.obj

Steps run in the order of the options above, --for last. Each changes only what it must: a mesh
without faults stays as it is.

STL does not keep cuts: readers join vertices at equal positions. Write PLY or OBJ.

Exit codes: 0 success; 1 the STL file that was written does not keep the repair of --for; 2 wrong
usage or unusable input; 3 the mesh cannot be repaired in this way; 4 interrupted, nothing written.";

/// Repair a mesh: weld, orient, cut, fill holes.
///
/// Prints what each step did, and what it could not repair. The input file is never changed.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Repair {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    /// Merge vertices within 0.01, or 0.01% of the diagonal; default 0
    #[arg(long, value_name = "DISTANCE", num_args = 0..=1, require_equals = true, default_missing_value = "0", value_parser = tolerance)]
    pub(crate) weld: Option<Tolerance>,
    /// How --weld finds vertices: grid or kd-tree
    #[arg(long, value_name = "NAME", default_value = "grid")]
    pub(crate) weld_method: WeldMethod,
    /// Remove faces that repeat another face
    #[arg(long)]
    pub(crate) duplicates: bool,
    /// Remove pairs of faces with the same vertices in opposite order, too
    #[arg(long)]
    pub(crate) opposite: bool,
    /// Remove faces without area
    #[arg(long)]
    pub(crate) flat: bool,
    /// Remove components with fewer faces than this
    #[arg(long, value_name = "FACES")]
    pub(crate) components: Option<usize>,
    /// Cut polygons into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Flip faces until they agree: majority (like most faces) or outward
    #[arg(long, value_name = "RULE")]
    pub(crate) orient: Option<Facing>,
    /// Cut non-manifold edges and vertices
    #[arg(long)]
    pub(crate) cut: bool,
    /// Fill holes, or only those with at most EDGES edges
    #[arg(long, value_name = "EDGES", num_args = 0..=1, require_equals = true)]
    pub(crate) fill_holes: Option<Option<usize>>,
    /// Triangles in holes: smallest (area) or ears
    #[arg(long, value_name = "NAME", default_value = "smallest")]
    pub(crate) hole_method: HoleFilling,
    /// Remove vertices without a face
    #[arg(long)]
    pub(crate) isolated: bool,
    /// Repair what this structure refuses
    #[arg(long = "for", value_name = "NAME", value_parser = backend)]
    pub(crate) structure: Option<String>,
    /// Write the report as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

impl Repair {
    /// Returns the chosen steps, in order.
    pub(crate) fn steps(&self) -> Vec<Step> {
        let weld = self.weld.map(|tolerance| {
            let method = self.weld_method;
            Step::Weld(Weld { tolerance, method })
        });
        let opposite = match self.opposite {
            true => OppositeFaces::Remove,
            false => OppositeFaces::Keep,
        };
        let duplicates = self.duplicates || self.opposite;
        let components = self.components;
        let orient = self.orient.map(|facing| Step::Orient {
            facing,
            which: Components::All,
        });
        let holes = self.fill_holes.map(|max_edges| {
            Step::FillHoles(FillHoles {
                max_edges,
                method: self.hole_method,
            })
        });
        let steps = [
            weld,
            duplicates.then_some(Step::RemoveDuplicateFaces(opposite)),
            self.flat.then_some(Step::RemoveFlatFaces),
            components.map(|min_faces| Step::RemoveSmallComponents { min_faces }),
            self.triangulate.then_some(Step::Triangulate),
            orient,
            self.cut.then_some(Step::Cut),
            holes,
            self.isolated.then_some(Step::RemoveIsolatedVertices),
        ];
        steps.into_iter().flatten().collect()
    }
}

/// Returns the options that choose these steps; the inverse of [`Repair::steps`] for steps with the
/// settings of [`FaultKind::repairs`](sixfold::repair::FaultKind::repairs).
pub(crate) fn repair_options(steps: &[Step]) -> String {
    let option = |step: &Step| {
        let option = match step {
            Step::Weld(Weld {
                tolerance: Tolerance::Absolute(distance),
                ..
            }) => return format!("--weld={distance}"),
            Step::Weld(_) => "--weld",
            Step::RemoveDuplicateFaces(OppositeFaces::Keep) => "--duplicates",
            Step::RemoveDuplicateFaces(OppositeFaces::Remove) => "--opposite",
            Step::RemoveFlatFaces => "--flat",
            Step::Triangulate => "--triangulate",
            Step::Orient { facing, .. } => match facing {
                Facing::Majority => "--orient majority",
                Facing::Outward => "--orient outward",
            },
            Step::Cut => "--cut",
            Step::FillHoles(_) => "--fill-holes",
            Step::RemoveIsolatedVertices => "--isolated",
            _ => unreachable!("no kind of fault needs the step {step}"),
        };
        option.to_owned()
    };
    steps.iter().map(option).collect::<Vec<_>>().join(" ")
}

/// Parses a distance, or a part of the diagonal in percent.
fn tolerance(text: &str) -> Result<Tolerance, String> {
    let (number, is_relative) = match text.trim().strip_suffix('%') {
        Some(number) => (number, true),
        None => (text.trim(), false),
    };
    match number.parse::<f64>() {
        Ok(0.0) => Ok(Tolerance::Exact),
        Ok(value) if is_relative => Ok(Tolerance::Relative(value / 100.0)),
        Ok(value) => Ok(Tolerance::Absolute(value)),
        Err(_) => Err("write a distance, such as 0.01, or a percentage of the diagonal of the bounding box, such as 0.01%".into()),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use sixfold::repair::FaultKind;

    use super::*;
    use crate::arguments::{Arguments, Command};

    #[test]
    fn options_choose_the_steps_that_repair_a_fault() {
        for kind in FaultKind::ALL {
            let steps = kind.repairs();
            let line = format!("sixfold repair a.obj {} -o b.obj", repair_options(&steps));
            let arguments = Arguments::try_parse_from(line.split_whitespace());
            match arguments.expect("valid options").command {
                Some(Command::Repair(repair)) => assert_eq!(repair.steps(), steps, "{line}"),
                other => panic!("{other:?}"),
            }
        }
    }
}
