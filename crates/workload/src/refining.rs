//! Subdivision as a workload: one scheme, one way to run it, so many levels, on one structure.

use std::fmt;

use serde::{Serialize, Serializer};
use sixfold::subdivision::{Method, Scheme, Subdivision, SubdivisionError, built, renumbered};
use sixfold::{
    Creases, Point, PolygonMesh, Refine, RefineVisitor, Representation, Visitor, visit,
    visit_refinable,
};

/// How the levels are made, and where they are put.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Way {
    /// By queries for each new point; the structure is built anew from each level.
    Gather,
    /// By a pass over the faces; the structure is built anew from each level.
    Scatter,
    /// In the structure's own tables, into meshes that are allocated for it.
    NativeFresh,
    /// In the structure's own tables, into those of the run before: what an animation does.
    Native,
}

impl Way {
    /// All four.
    pub const ALL: [Self; 4] = [Self::Gather, Self::Scatter, Self::NativeFresh, Self::Native];

    /// What users call it: `native_fresh`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gather => "gather",
            Self::Scatter => "scatter",
            Self::NativeFresh => "native_fresh",
            Self::Native => "native",
        }
    }

    /// The method that it is of.
    pub const fn method(self) -> Method {
        match self {
            Self::Gather => Method::Gather,
            Self::Scatter => Method::Scatter,
            Self::NativeFresh | Self::Native => Method::Native,
        }
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Serialize for Way {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// What to refine and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refining {
    /// The scheme with its options.
    pub subdivision: Subdivision,
    /// How.
    pub way: Way,
    /// How often; at least once.
    pub levels: u32,
}

/// A subdivision that is set up to be run again and again: the control mesh stands built.
pub trait Refiner: Send {
    /// Makes all levels.
    ///
    /// # Errors
    ///
    /// What the scheme or the structure refuses.
    fn run(&mut self) -> Result<(), SubdivisionError>;

    /// The faces of the last level that was made, and a number made of all its positions:
    /// Σ |x| + 2|y| + 3|z|.
    fn result(&self) -> (usize, f64);
}

impl Refining {
    /// `scheme` with its usual options.
    pub fn new(scheme: Scheme, way: Way, levels: u32) -> Self {
        Self {
            subdivision: Subdivision::new(scheme),
            way,
            levels,
        }
    }

    /// Sets it up on the structure called `backend`; `None` where there is none, or none that does it
    /// this way.
    ///
    /// # Errors
    ///
    /// Why the structure cannot hold `polygons`, or the scheme does not take `creases`.
    pub fn on(
        self,
        backend: &str,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Option<Result<Box<dyn Refiner>, SubdivisionError>> {
        let mut start = self.start(polygons, creases);
        match self.way {
            Way::Gather | Way::Scatter => visit(backend, &mut start),
            Way::NativeFresh | Way::Native => visit_refinable(backend, &mut start),
        }
    }

    /// As [`on`](Self::on), on a structure of type `M`, which need not be of the roster where it is
    /// built anew from each level.
    pub(crate) fn of<M: Representation + 'static>(
        self,
        polygons: &PolygonMesh,
        creases: &Creases,
    ) -> Option<Result<Box<dyn Refiner>, SubdivisionError>> {
        match self.way.method() {
            Method::Native => self.on(M::NAME, polygons, creases),
            _ => Some(Visitor::visit::<M>(&mut self.start(polygons, creases))),
        }
    }

    fn start<'a>(self, polygons: &'a PolygonMesh, creases: &'a Creases) -> Start<'a> {
        Start {
            job: self,
            polygons,
            creases,
        }
    }
}

/// Builds the control mesh in a structure chosen at run time.
struct Start<'a> {
    job: Refining,
    polygons: &'a PolygonMesh,
    creases: &'a Creases,
}

impl Start<'_> {
    fn control<M: Representation>(&self) -> Result<(M, Creases), SubdivisionError> {
        let mesh = built::<M>(self.polygons, 0)?;
        let creases = self
            .job
            .subdivision
            .control(&mesh, self.polygons, self.creases)?;
        Ok((mesh, creases))
    }
}

impl Visitor for Start<'_> {
    type Output = Result<Box<dyn Refiner>, SubdivisionError>;

    fn visit<M: Representation + 'static>(&mut self) -> Self::Output {
        let (mesh, creases) = self.control::<M>()?;
        Ok(Box::new(Rebuilt {
            job: self.job,
            mesh,
            creases,
            last: PolygonMesh::default(),
        }))
    }
}

impl RefineVisitor for Start<'_> {
    type Output = Result<Box<dyn Refiner>, SubdivisionError>;

    fn visit<M: Refine + 'static>(&mut self) -> Self::Output {
        let (mesh, creases) = self.control::<M>()?;
        Ok(Box::new(InPlace {
            job: self.job,
            mesh,
            creases,
            levels: Vec::new(),
            numbers: M::EdgeNumbers::default(),
        }))
    }
}

/// Each level as polygons, and built from them.
struct Rebuilt<M> {
    job: Refining,
    mesh: M,
    creases: Creases,
    /// The last level as it was made. Its structure may have merged vertices that have met.
    last: PolygonMesh,
}

impl<M: Representation + 'static> Refiner for Rebuilt<M> {
    fn run(&mut self) -> Result<(), SubdivisionError> {
        let subdivision = &self.job.subdivision;
        let mut creases = self.creases.clone();
        // Let go of what the run before has made, as every run must be the same.
        self.last = PolygonMesh::default();
        let mut at: Option<M> = None;
        for level in 0..self.job.levels {
            let mesh = at.as_ref().unwrap_or(&self.mesh);
            let step = match self.job.way {
                Way::Gather => subdivision.gather(mesh, &creases, level)?,
                _ => subdivision.scatter(mesh, &creases, level)?,
            };
            let next = built::<M>(&step.polygons, level + 1)?;
            creases = renumbered(&next, &step.polygons, &step.creases);
            self.last = step.polygons;
            at = Some(next);
        }
        Ok(())
    }

    fn result(&self) -> (usize, f64) {
        let points = self.last.positions().iter().copied();
        (self.last.face_count(), checksum(points))
    }
}

/// Each level in tables of its own.
struct InPlace<M: Refine> {
    job: Refining,
    mesh: M,
    creases: Creases,
    levels: Vec<M>,
    numbers: M::EdgeNumbers,
}

impl<M: Refine + 'static> Refiner for InPlace<M> {
    fn run(&mut self) -> Result<(), SubdivisionError> {
        if self.job.way == Way::NativeFresh {
            self.levels.clear();
            self.numbers = M::EdgeNumbers::default();
        }
        self.levels.resize_with(self.job.levels as usize, M::empty);
        let mut creases = self.creases.clone();
        let mut parent = &self.mesh;
        for (level, child) in (0..).zip(&mut self.levels) {
            let subdivision = &self.job.subdivision;
            creases = subdivision.refine_into(parent, &creases, level, &mut self.numbers, child)?;
            parent = child;
        }
        Ok(())
    }

    fn result(&self) -> (usize, f64) {
        let mesh = self.levels.last().unwrap_or(&self.mesh);
        (
            mesh.face_count(),
            checksum(mesh.position_rows().iter().copied()),
        )
    }
}

fn checksum(points: impl Iterator<Item = Point>) -> f64 {
    let each = points.map(|p| {
        let [x, y, z] = p.to_array().map(|x| f64::from(x).abs());
        x + 2.0 * y + 3.0 * z
    });
    each.sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sixfold::{roster, shapes};

    #[test]
    fn every_way_does_the_same_work() {
        let polygons = shapes::geodesic(3).expect("small");
        let none = Creases::default();
        for (scheme, levels) in [(Scheme::Loop, 2), (Scheme::CatmullClark, 1)] {
            let mut results = Vec::new();
            for way in Way::ALL {
                for backend in roster() {
                    let job = Refining::new(scheme, way, levels);
                    let Some(Ok(mut refiner)) = job.on(backend.name, &polygons, &none) else {
                        continue;
                    };
                    match refiner.run() {
                        Ok(()) => results.push(refiner.result()),
                        // Quads do not fit a corner table.
                        Err(_) => assert_eq!(backend.name, "corner-table"),
                    }
                    if refiner.run().is_ok() {
                        assert_eq!(results.last(), Some(&refiner.result()), "a second run");
                    }
                }
            }
            let (faces, sum) = results[0];
            assert_eq!(
                faces,
                polygons.face_count() * if levels == 2 { 16 } else { 3 }
            );
            for &(others, other) in &results {
                assert_eq!(others, faces);
                assert!((other - sum).abs() < 1e-5 * sum, "{other} and {sum}");
            }
            assert!(results.len() > 15, "most ways on most structures");
        }
    }
}
