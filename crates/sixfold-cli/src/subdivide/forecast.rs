//! How large the result of a subdivision will be, and whether the machine has room for it.

use sixfold::subdivision::{Extent, Method, Subdivision};
use sixfold::{Counts, MAX_ROWS, Point, PolygonMesh, Representation, VertexId, Visitor, visit};

use crate::failure::Failure;
use crate::free_memory::check_room;
use ::study::numbers::{bytes, counted};

/// What a pass over the faces adds up for each edge, in a hash map where edges have no rows.
const SUMS_BYTES: usize = 120;

/// What is kept for each vertex while limits are taken.
const LIMIT_BYTES: usize = 128;

/// The sizes of all levels, and the most memory that making them takes.
pub(crate) struct Forecast {
    /// Of the control mesh and of each level.
    levels: Vec<Counts>,
    /// Bytes at the worst moment.
    peak: usize,
}

impl Forecast {
    /// What `levels` steps make of `polygons`.
    pub(crate) fn of(
        subdivision: &Subdivision,
        method: Method,
        backend: &str,
        polygons: &PolygonMesh,
        levels: u32,
        limit: bool,
    ) -> Result<Self, Failure> {
        let mut extent = Extent::of(polygons);
        let mut counts = vec![extent.counts];
        for level in 0..levels {
            extent = subdivision.grown(&extent, level);
            let Counts {
                vertices,
                edges,
                corners,
                ..
            } = extent.counts;
            let rows = [
                ("vertices", vertices),
                ("half-edges", edges.saturating_mul(2)),
                ("corners", corners),
            ];
            if let Some((elements, _)) = rows.iter().find(|(_, number)| *number > MAX_ROWS) {
                return Err(Failure::unsupported(format!(
                    "level {} of {levels} would have more than {MAX_ROWS} {elements}, and handles are 32 bits: take fewer levels, or split the mesh",
                    level + 1
                )));
            }
            counts.push(extent.counts);
        }
        let peak = counts.windows(2).map(|pair| {
            let [old, new] = [&pair[0], &pair[1]];
            match method {
                // Two meshes, and at the end the polygons that are written.
                Method::Native => held(backend, old) + held(backend, new) + flat(new),
                // The polygons of both, the structure, and data by handle beside it.
                Method::Gather => flat(old) + flat(new) + 3 * held(backend, old),
                Method::Scatter => {
                    flat(old) + flat(new) + held(backend, old) + old.edges * SUMS_BYTES
                }
            }
        });
        let steps = peak.max().unwrap_or_else(|| flat(&counts[0]));
        let result = &counts[counts.len() - 1];
        let limits = match limit {
            true => 2 * flat(result) + held("face-vertex", result) + result.vertices * LIMIT_BYTES,
            false => 0,
        };
        Ok(Self {
            peak: steps.max(limits),
            levels: counts,
        })
    }

    /// Faces of all levels but the first.
    pub(crate) fn faces_in_all(&self) -> usize {
        self.levels.iter().skip(1).map(|counts| counts.faces).sum()
    }

    /// What to expect, in a line.
    pub(crate) fn told(&self) -> String {
        let result = &self.levels[self.levels.len() - 1];
        format!(
            "to make: {}, {}; some {} of memory",
            counted(result.vertices, "vertex", "vertices"),
            counted(result.faces, "face", "faces"),
            bytes(self.peak)
        )
    }

    /// Refuses what the machine has no room for, unless told to go on.
    pub(crate) fn check(&self, force: bool) -> Result<(), Failure> {
        let result = &self.levels[self.levels.len() - 1];
        let faces = counted(result.faces, "face", "faces");
        check_memory(&format!("a result of {faces}"), self.peak, force)
    }
}

/// Refuses `what` if it takes more than the memory that is free, unless told to go on.
pub(super) fn check_memory(what: &str, peak: usize, force: bool) -> Result<(), Failure> {
    match force {
        true => Ok(()),
        false => check_room(
            what,
            peak as u64,
            "take fewer levels, or go on with --force",
        ),
    }
}

/// Bytes of the positions and faces of a polygon mesh.
fn flat(counts: &Counts) -> usize {
    let positions = counts.vertices.saturating_mul(size_of::<Point>());
    positions.saturating_add(counts.corners.saturating_mul(size_of::<VertexId>()))
}

/// Bytes of the structure called `backend`.
fn held(backend: &str, counts: &Counts) -> usize {
    struct Layout<'a>(&'a Counts);

    impl Visitor for Layout<'_> {
        type Output = usize;

        fn visit<M: Representation + 'static>(&mut self) -> usize {
            M::layout_bytes(self.0)
        }
    }

    visit(backend, &mut Layout(counts)).unwrap_or(0)
}
