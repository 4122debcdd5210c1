//! The queries of a winged-edge mesh, as textbooks write them.
//!
//! An edge has one direction, but a walk may meet it from either end. Each step of a walk therefore has
//! an `if`.

use sixfold_core::{Line, Relation};

const FIRST_AT_VERTEX: Line = Line::new(
    "e = edge of v",
    &[("spokes", Line::ASKED), ("edges", "edge")],
);
const REPEAT: Line = Line::text("repeat");
const OUT: Line = Line::new(
    "  if e starts at v: e = left prev(e)",
    &[("edges", "left prev")],
);
const IN: Line = Line::new("  else: e = right prev(e)", &[("edges", "right prev")]);
const UNTIL: Line = Line::text("until e is the first edge again");
const FIRST_OF_FACE: Line = Line::new(
    "e = edge of f",
    &[("sides", Line::ASKED), ("edges", "edge")],
);
const FORWARD: Line = Line::new(
    "  if f is on the left of e: e = left next(e)",
    &[("edges", "left next")],
);
const BACKWARD: Line = Line::new("  else: e = right next(e)", &[("edges", "right next")]);
const RECORD: Line = Line::new("read e", &[("edges", Line::ASKED)]);

pub(super) fn of(relation: Relation) -> &'static [Line] {
    match relation {
        Relation::VertexVertices => {
            const {
                &[
                    FIRST_AT_VERTEX,
                    REPEAT,
                    Line::text("  yield the other end of e"),
                    OUT,
                    IN,
                    UNTIL,
                ]
            }
        }
        Relation::VertexEdges => {
            const {
                &[
                    FIRST_AT_VERTEX,
                    REPEAT,
                    Line::text("  yield e"),
                    OUT,
                    IN,
                    UNTIL,
                ]
            }
        }
        Relation::VertexFaces => {
            const {
                &[
                    FIRST_AT_VERTEX,
                    REPEAT,
                    Line::text("  yield the face on the left, seen from v, if there is one"),
                    OUT,
                    IN,
                    UNTIL,
                ]
            }
        }
        Relation::EdgeVertices => const { &[RECORD, Line::text("yield start(e), end(e)")] },
        Relation::EdgeEdges => {
            const {
                &[
                    RECORD,
                    Line::text("for both ends v of e: g = the wing before e at v"),
                    Line::text("  until g is e"),
                    Line::text("    yield g"),
                    Line::new(
                        "    if g starts at v: g = left prev(g)",
                        &[("edges", "left prev")],
                    ),
                    Line::new("    else: g = right prev(g)", &[("edges", "right prev")]),
                ]
            }
        }
        Relation::EdgeFaces => {
            const {
                &[
                    RECORD,
                    Line::text("yield left(e), right(e) if they are faces"),
                ]
            }
        }
        Relation::FaceVertices => {
            const {
                &[
                    FIRST_OF_FACE,
                    REPEAT,
                    Line::text("  yield the end of e where the walk comes from"),
                    FORWARD,
                    BACKWARD,
                    UNTIL,
                ]
            }
        }
        Relation::FaceEdges => {
            const {
                &[
                    FIRST_OF_FACE,
                    REPEAT,
                    Line::text("  yield e"),
                    FORWARD,
                    BACKWARD,
                    UNTIL,
                ]
            }
        }
        Relation::FaceFaces => {
            const {
                &[
                    FIRST_OF_FACE,
                    REPEAT,
                    Line::text("  yield the face across e, if there is one that is new"),
                    FORWARD,
                    BACKWARD,
                    UNTIL,
                ]
            }
        }
    }
}
