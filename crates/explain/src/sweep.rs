//! Many queries, one after the other: what a page times.

use std::hint::black_box;

use sixfold::{Handle, MeshQuery, PolygonMesh, Relation, Representation};

use crate::error::ExplainError;

/// A structure without a probe and without room for edits, as a study measures it.
pub(crate) trait Swept {
    /// Runs a query from `queries` elements, in the order of the structure and from the first one again after the
    /// last. Returns the number of results.
    fn sweep(&self, relation: Relation, queries: usize) -> usize;
}

/// Builds the structure of Sixfold with this name; `None` if there is none.
pub(crate) fn swept(
    name: &str,
    polygons: &PolygonMesh,
) -> Option<Result<Box<dyn Swept>, ExplainError>> {
    let mut found = None;
    sixfold::for_each_representation!(M => {
        if M::NAME == name {
            found = Some(build::<M>(polygons));
        }
    });
    found
}

fn build<M: Representation + 'static>(
    polygons: &PolygonMesh,
) -> Result<Box<dyn Swept>, ExplainError> {
    match M::from_polygons(polygons) {
        Ok(mesh) => Ok(Box::new(mesh)),
        Err(refusal) => Err(ExplainError::Refused {
            structure: M::NAME,
            refusal,
            room: None,
        }),
    }
}

impl<M: MeshQuery> Swept for M {
    fn sweep(&self, relation: Relation, queries: usize) -> usize {
        macro_rules! run_relation {
            ($query:ident $list:ident $from:ident $to:ident) => {
                run(
                    queries,
                    || self.$list(),
                    |element| count(self.$query(element)),
                )
            };
        }
        sixfold_core::match_relation!(relation, run_relation!)
    }
}

fn run<I: Iterator>(
    queries: usize,
    elements: impl Fn() -> I,
    query: impl Fn(I::Item) -> usize,
) -> usize {
    let (mut left, mut results) = (queries, 0);
    while left > 0 {
        let before = left;
        for element in elements().take(left) {
            results += query(element);
            left -= 1;
        }
        if left == before {
            break; // There is no element.
        }
    }
    results
}

/// Counts the results of a query. The compiler cannot leave them out.
fn count<H: Handle>(results: impl IntoIterator<Item = H>) -> usize {
    results.into_iter().map(black_box).count()
}

#[cfg(test)]
mod tests {
    use sixfold::shapes;

    use super::*;

    #[test]
    fn a_sweep_begins_again_after_the_last_element() {
        let cube = shapes::cube();
        let half_edge = swept("half-edge", &cube)
            .expect("a structure")
            .expect("a cube");
        for (relation, queries, results) in [
            (Relation::VertexVertices, 8, 24),
            (Relation::VertexVertices, 20, 60),
            (Relation::VertexEdges, 1, 3),
            (Relation::VertexFaces, 0, 0),
            (Relation::EdgeVertices, 12, 24),
            (Relation::EdgeEdges, 12, 48),
            (Relation::EdgeFaces, 13, 26),
            (Relation::FaceVertices, 6, 24),
            (Relation::FaceEdges, 5, 20),
            (Relation::FaceFaces, 6, 24),
        ] {
            assert_eq!(half_edge.sweep(relation, queries), results, "{relation}");
        }
        let empty = PolygonMesh::default();
        let none = swept("face-vertex", &empty)
            .expect("a structure")
            .expect("no element");
        assert_eq!(none.sweep(Relation::FaceFaces, 5), 0);
        assert!(swept("corner-table", &cube).expect("a structure").is_err());
        assert!(swept("corner", &cube).is_none());
    }
}
