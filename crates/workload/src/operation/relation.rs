//! Queries one relation at every element of one kind.

use sixfold::{MeshQuery, Relation};

use crate::sweeps::{SweepResult, query_each};

/// **Timed**: queries `relation` of all elements.
///
/// Each loop is a function of its own, of the shape that programs of users have. In one function with
/// nine loops, the compiler changes the loops: on an Intel Xeon (family 6, model 167), `face_vertices`
/// of a half-edge mesh then took 1.57 ns for a face instead of 1.42. `benches/checks/plain_program.py`
/// compares each loop with a program of a user.
#[inline]
pub(crate) fn query_all<M: MeshQuery>(relation: Relation, mesh: &M) -> SweepResult {
    macro_rules! sweep_relation {
        (edge_vertices $list:ident $from:ident $to:ident) => {{
            // Programs of users take the array of the two ends apart.
            #[inline(never)]
            fn edge_vertices<M: MeshQuery>(mesh: &M) -> SweepResult {
                query_each(mesh.$list(), |sink, element| {
                    let [a, b] = mesh.edge_vertices(element);
                    sink.with_one(a).with_one(b)
                })
            }
            edge_vertices(mesh)
        }};
        ($query:ident $list:ident $from:ident $to:ident) => {{
            #[inline(never)]
            fn $query<M: MeshQuery>(mesh: &M) -> SweepResult {
                query_each(mesh.$list(), |sink, element| {
                    sink.with(mesh.$query(element))
                })
            }
            $query(mesh)
        }};
    }
    sixfold_core::match_relation!(relation, sweep_relation!)
}
