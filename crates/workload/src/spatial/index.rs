//! The spatial indices as backends of a trial.

use std::hint::black_box;

use super::queries::{Input, Triangle, Vertex};
use sixfold::spatial::{
    Bvh, Item, ItemList, KdTree, Neighbour, Octree, PointQueries, SpatialError, SpatialIndex,
    SurfaceQueries, UniformGrid,
};
use sixfold::{QueryCost, VertexId};
use sixfold_measure::{Clock, Job, Outcome, Series, Task, TimedBackend, TimedRun};
use sixfold_results::{SpatialTask, Time};

/// The name of the list, which visits all elements for each query.
pub const LIST: &str = "list";

/// Both indices of a kind, as a backend of a trial.
pub type Built<'i> = Result<Box<dyn TimedBackend + 'i>, SpatialError>;

/// A kind of index: how to build it.
#[derive(Clone, Copy)]
pub struct IndexKind {
    /// The name of the kind, such as `grid`.
    pub name: &'static str,
    build: for<'i> fn(&'static str, &'i Input) -> Built<'i>,
}

/// All kinds of indices, in the order of the tables. The list comes first. A static, so that this crate compiles the
/// functions, and not each crate that uses the constant.
pub static KINDS: [IndexKind; 5] = [
    IndexKind::new::<ItemList<Vertex>, ItemList<Triangle>>(LIST),
    IndexKind::new::<UniformGrid<Vertex>, UniformGrid<Triangle>>("grid"),
    IndexKind::new::<Octree<Vertex>, Octree<Triangle>>("octree"),
    IndexKind::new::<KdTree<Vertex>, KdTree<Triangle>>("kd-tree"),
    IndexKind::new::<Bvh<Vertex>, Bvh<Triangle>>("bvh"),
];

impl IndexKind {
    const fn new<V, T>(name: &'static str) -> Self
    where
        V: SpatialIndex<Vertex> + 'static,
        T: SpatialIndex<Triangle> + 'static,
    {
        Self {
            name,
            build: build::<V, T>,
        }
    }

    /// Builds both indices of this kind.
    ///
    /// # Errors
    ///
    /// Returns an error if an index cannot hold the input.
    pub fn build<'i>(&self, input: &'i Input) -> Built<'i> {
        (self.build)(self.name, input)
    }
}

fn build<'i, V, T>(name: &'static str, input: &'i Input) -> Built<'i>
where
    V: SpatialIndex<Vertex> + 'static,
    T: SpatialIndex<Triangle> + 'static,
{
    Ok(Box::new(Indices::<V, T> {
        name,
        vertices: V::build(input.vertices.clone())?,
        triangles: T::build(input.triangles.clone())?,
        input,
    }))
}

/// The index of the vertices and the index of the triangles.
struct Indices<'i, V, T> {
    name: &'static str,
    input: &'i Input,
    vertices: V,
    triangles: T,
}

impl<V: SpatialIndex<Vertex>, T: SpatialIndex<Triangle>> Indices<'_, V, T> {
    /// Answers `count` queries of `task`, spread evenly over all of them. Returns a number computed from all
    /// answers.
    fn answer(&self, task: SpatialTask, count: usize) -> f64 {
        let points = evenly(&self.input.points, count);
        let rays = evenly(&self.input.rays, count);
        match task {
            SpatialTask::BuildVertices => self.vertices.items().len() as f64,
            SpatialTask::BuildTriangles => self.triangles.items().len() as f64,
            SpatialTask::NearestVertex => {
                let found = points.filter_map(|&p| self.vertices.nearest(p));
                found.map(|n| n.vertex.index() as f64).sum()
            }
            SpatialTask::VerticesWithin => {
                let mut sum = 0.0;
                for &point in points {
                    let add = |n: Neighbour<VertexId>| sum += n.vertex.index() as f64;
                    self.vertices.for_each_within(point, self.input.radius, add);
                }
                sum
            }
            SpatialTask::NearestEight => {
                let mut found = Vec::new();
                let mut sum = 0.0;
                for &point in points {
                    self.vertices.nearest_k_into(point, 8, &mut found);
                    sum += found.iter().map(|n| n.vertex.index() as f64).sum::<f64>();
                }
                sum
            }
            SpatialTask::ClosestPoint => {
                let found = points.filter_map(|&p| self.triangles.closest_point(p));
                found.map(|point| point.face.index() as f64).sum()
            }
            SpatialTask::FirstHit => {
                let hit = |ray| self.triangles.first_hit(ray, f64::INFINITY);
                let found = rays.filter_map(hit);
                found.map(|hit| hit.face.index() as f64).sum()
            }
        }
    }

    /// Returns the number of elements of a run on the whole input.
    fn elements(&self, task: SpatialTask) -> usize {
        match task {
            SpatialTask::BuildVertices => self.input.vertices.len(),
            SpatialTask::BuildTriangles => self.input.triangles.len(),
            SpatialTask::FirstHit => self.input.rays.len(),
            _ => self.input.points.len(),
        }
    }
}

impl<V: SpatialIndex<Vertex>, T: SpatialIndex<Triangle>> TimedBackend for Indices<'_, V, T> {
    fn name(&self) -> &str {
        self.name
    }

    fn costs(&self) -> [QueryCost; 9] {
        match self.name {
            LIST => [QueryCost::Scan; 9],
            _ => [QueryCost::Local; 9],
        }
    }

    fn merged_vertices(&self) -> usize {
        0
    }

    fn bytes(&self) -> usize {
        self.vertices.memory_bytes() + self.triangles.memory_bytes()
    }

    fn rebuild(&mut self) {
        // The items were accepted when the index was first built.
        if let Ok(vertices) = V::build(self.input.vertices.clone()) {
            self.vertices = vertices;
        }
        if let Ok(triangles) = T::build(self.input.triangles.clone()) {
            self.triangles = triangles;
        }
    }

    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        let Task::Part(part) = job.task else {
            return TimedRun::refused("a spatial index has no operations of meshes".into(), series);
        };
        let task = SpatialTask::ALL[part];
        let all = self.elements(task);
        let count = job.sample.map_or(all, |sample| sample.size.min(all));
        let time = match task {
            SpatialTask::BuildVertices => time_build::<V, _>(&self.input.vertices, series),
            SpatialTask::BuildTriangles => time_build::<T, _>(&self.input.triangles, series),
            query => {
                let time = series.time_together(|| _ = black_box(self.answer(query, count)));
                time.scaled(all as f64 / count.max(1) as f64)
            }
        };
        let outcome = series.check.then(|| Outcome {
            checksum: self.answer(task, count),
            elements: all as u64,
            refused: 0,
        });
        TimedRun::done(time.scaled(1.0 / f64::from(series.runs)), outcome)
    }
}

/// Returns `count` of the queries, or all of them, at equal distances.
fn evenly<Q>(queries: &[Q], count: usize) -> impl Iterator<Item = &Q> {
    let step = (queries.len() / count.max(1)).max(1);
    queries.iter().step_by(step).take(count)
}

/// Times building an index from a copy of `items`. Copying is not timed.
fn time_build<T: SpatialIndex<I>, I: Item>(items: &[I], series: &Series<'_>) -> Time {
    let mut total = Time::zero_like(series.clock.now());
    for run in 0..series.untimed + series.runs {
        let items = items.to_vec();
        series.begin();
        let (time, built) = timed(series.clock, || black_box(T::build(items)));
        drop(built);
        if run >= series.untimed {
            total = total.plus(time);
        }
    }
    total
}

/// Returns the time of `work` and its result.
fn timed<R>(clock: &dyn Clock, work: impl FnOnce() -> R) -> (Time, R) {
    let mut result = None;
    let time = sixfold_measure::timed(clock, || result = Some(work()));
    (time, result.expect("the work was run"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_the_queries_is_spread_over_all_of_them() {
        let queries: Vec<usize> = (0..10).collect();
        let chosen = |count| evenly(&queries, count).copied().collect::<Vec<_>>();
        assert_eq!(chosen(3), [0, 3, 6]);
        assert_eq!(chosen(4), [0, 2, 4, 6]);
        assert_eq!(chosen(10), queries);
        assert_eq!(chosen(11), queries);
        assert_eq!(chosen(0), [0; 0]);
        assert_eq!(evenly(&[0; 0], 3).count(), 0);
    }
}
