//! The queries of a corner table, as textbooks write them.
//!
//! A corner stands for the edge that it faces: its opposite is the other corner that faces the edge.

use sixfold_core::{Line, Relation};

const FIRST: Line = Line::new("n = next(corner of v)", &[("corner", Line::ASKED)]);
const REPEAT: Line = Line::text("repeat");
const ACROSS: Line = Line::new(
    "  o = opposite(n)",
    &[("opposite", "next"), ("opposite", "prev")],
);
const TURN: Line = Line::text("  n = prev(o)");
const UNTIL: Line = Line::text("until n is the first corner again, or o is none");

pub(super) fn of(relation: Relation) -> &'static [Line] {
    match relation {
        Relation::VertexVertices => {
            const {
                &[
                    FIRST,
                    REPEAT,
                    ACROSS,
                    Line::new(
                        "  yield vertex(n)",
                        &[("vertex", "next"), ("vertex", "prev")],
                    ),
                    TURN,
                    UNTIL,
                    Line::new("if o is none, yield vertex(next(n))", &[("vertex", "next")]),
                ]
            }
        }
        Relation::VertexEdges => {
            const {
                &[
                    FIRST,
                    REPEAT,
                    ACROSS,
                    Line::text("  yield the edge that n faces"),
                    TURN,
                    UNTIL,
                    Line::text("if o is none, yield the edge that next(the first n) faces"),
                ]
            }
        }
        Relation::VertexFaces => {
            const {
                &[
                    FIRST,
                    REPEAT,
                    ACROSS,
                    Line::text("  yield triangle(n)"),
                    TURN,
                    UNTIL,
                ]
            }
        }
        Relation::EdgeVertices => {
            const {
                &[Line::new(
                    "yield vertex(next(c)), vertex(prev(c))",
                    &[("vertex", "next"), ("vertex", "prev")],
                )]
            }
        }
        Relation::EdgeEdges => {
            const {
                &[
                    Line::new("o = opposite(c)", &[("opposite", Line::ASKED)]),
                    Line::text("for x in (c, o): n = prev(x)"),
                    Line::text("  until n faces the edge itself"),
                    Line::new(
                        "    p = opposite(n)",
                        &[("opposite", "prev"), ("opposite", "next")],
                    ),
                    Line::text("    yield the edge that n faces"),
                    Line::text("    n = prev(p)"),
                    Line::text(
                        "  if p is none: n = next(the other of c, o), and turn the other way",
                    ),
                ]
            }
        }
        Relation::EdgeFaces => {
            const {
                &[
                    Line::new("o = opposite(c)", &[("opposite", Line::ASKED)]),
                    Line::text("yield triangle(c)"),
                    Line::text("if o is not none, yield triangle(o)"),
                ]
            }
        }
        Relation::FaceVertices => {
            const {
                &[Line::new(
                    "for the three corners c of f: yield vertex(c)",
                    &[("vertex", Line::ASKED)],
                )]
            }
        }
        Relation::FaceEdges => {
            const {
                &[
                    Line::new(
                        "for the three corners c of f: o = opposite(c)",
                        &[("opposite", Line::ASKED)],
                    ),
                    Line::text("  yield the edge that c and o face"),
                ]
            }
        }
        Relation::FaceFaces => {
            const {
                &[
                    Line::new(
                        "for the three corners c of f: o = opposite(c)",
                        &[("opposite", Line::ASKED)],
                    ),
                    Line::text("  if triangle(o) is new, yield it"),
                ]
            }
        }
    }
}
