//! The queries of a half-edge mesh, as textbooks write them.

use sixfold_core::{Line, Relation};

const FIRST_AT_VERTEX: Line = Line::new("h = half-edge of v", &[("leaving", Line::ASKED)]);
const REPEAT: Line = Line::text("repeat");
const TWIN: Line = Line::new("  t = twin(h)", &[("halves", "twin")]);
const TURN: Line = Line::text("  h = next(t)");
const UNTIL: Line = Line::text("until h is the first half-edge again");
const FIRST_OF_FACE: Line = Line::new("h = half-edge of f", &[("first", Line::ASKED)]);
const ALONG: Line = Line::new("  read h", &[("halves", "half-edge"), ("halves", "next")]);
const FOLLOW: Line = Line::text("  h = next(h)");
const HALVES: Line = Line::new("for both half-edges h of e", &[("halves", Line::ASKED)]);

pub(super) fn of(relation: Relation) -> &'static [Line] {
    match relation {
        Relation::VertexVertices => {
            const {
                &[
                    FIRST_AT_VERTEX,
                    REPEAT,
                    TWIN,
                    Line::text("  yield origin(t)"),
                    TURN,
                    UNTIL,
                ]
            }
        }
        Relation::VertexEdges => {
            const {
                &[
                    FIRST_AT_VERTEX,
                    REPEAT,
                    TWIN,
                    Line::text("  yield edge(t)"),
                    TURN,
                    UNTIL,
                ]
            }
        }
        Relation::VertexFaces => {
            const {
                &[
                    FIRST_AT_VERTEX,
                    REPEAT,
                    TWIN,
                    Line::text("  if t has a face, yield face(t)"),
                    TURN,
                    UNTIL,
                ]
            }
        }
        Relation::EdgeVertices => const { &[HALVES, Line::text("  yield origin(h)")] },
        Relation::EdgeEdges => {
            const {
                &[
                    HALVES,
                    Line::text("  g = next(h)"),
                    Line::text("  until g is twin(h)"),
                    Line::new("    t = twin(g)", &[("halves", "twin")]),
                    Line::text("    yield edge(t)"),
                    Line::text("    g = next(t)"),
                ]
            }
        }
        Relation::EdgeFaces => const { &[HALVES, Line::text("  if h has a face, yield face(h)")] },
        Relation::FaceVertices => {
            const {
                &[
                    FIRST_OF_FACE,
                    REPEAT,
                    ALONG,
                    Line::text("  yield origin(h)"),
                    FOLLOW,
                    UNTIL,
                ]
            }
        }
        Relation::FaceEdges => {
            const {
                &[
                    FIRST_OF_FACE,
                    REPEAT,
                    ALONG,
                    Line::text("  yield edge(h)"),
                    FOLLOW,
                    UNTIL,
                ]
            }
        }
        Relation::FaceFaces => {
            const {
                &[
                    FIRST_OF_FACE,
                    REPEAT,
                    Line::new(
                        "  read h and t = twin(h), which are adjacent rows",
                        &[
                            ("halves", "half-edge"),
                            ("halves", "next"),
                            ("halves", "twin"),
                        ],
                    ),
                    Line::text("  if t has a face that is new, yield face(t)"),
                    FOLLOW,
                    UNTIL,
                ]
            }
        }
    }
}
