//! The queries of a face-vertex mesh, as textbooks write them.

use sixfold_core::{Line, Relation};

/// The ways to the corners of a face that the pool names.
const OF_NAMED_FACE: &[(&str, &str)] = &[
    ("offsets", "face"),
    ("offsets", Line::NEXT_ROW),
    ("spans", "face"),
    ("corners", "face"),
];
/// The ways to the corners of the face of the query.
const OF_ASKED_FACE: &[(&str, &str)] = &[
    ("offsets", Line::ASKED),
    ("offsets", Line::NEXT_ROW),
    ("spans", Line::ASKED),
    ("corners", Line::ASKED),
];
const FAN: Line = Line::new(
    "for each face f in the fan of v",
    &[
        ("fans", Line::ASKED),
        ("pool", "first"),
        ("pool", Line::NEXT_ROW),
    ],
);
const FIND: Line = Line::new("  find v among the corners of f", OF_NAMED_FACE);
const NOTE: Line = Line::text("  note the vertices before and after v in f");
const CORNERS: Line = Line::new("for each corner c of f", OF_ASKED_FACE);

pub(super) fn of(relation: Relation) -> &'static [Line] {
    match relation {
        Relation::VertexVertices => {
            const { &[FAN, FIND, NOTE, Line::text("yield each noted vertex once")] }
        }
        Relation::VertexEdges => {
            const {
                &[
                    FAN,
                    FIND,
                    NOTE,
                    Line::text("yield the edge to each noted vertex once"),
                ]
            }
        }
        Relation::VertexFaces => const { &[FAN, Line::text("  yield f")] },
        Relation::EdgeVertices => const { &[Line::text("yield both ends: they are the edge")] },
        Relation::EdgeEdges => {
            const {
                &[
                    Line::text("for both ends v of e"),
                    Line::new(
                        "  for each face f in the fan of v",
                        &[
                            ("fans", Line::ASKED),
                            ("pool", "first"),
                            ("pool", Line::NEXT_ROW),
                        ],
                    ),
                    Line::new("    find v among the corners of f", OF_NAMED_FACE),
                    Line::text("    note the vertices before and after v in f"),
                    Line::text("  yield the edge to each noted vertex once, except e"),
                ]
            }
        }
        Relation::EdgeFaces => {
            const {
                &[
                    Line::new(
                        "v = the end of e with fewer faces",
                        &[("fans", Line::ASKED)],
                    ),
                    Line::new(
                        "for each face f in the fan of v",
                        &[("pool", "first"), ("pool", Line::NEXT_ROW)],
                    ),
                    Line::new("  find v among the corners of f", OF_NAMED_FACE),
                    Line::text("  if the other end is beside v, yield f"),
                ]
            }
        }
        Relation::FaceVertices => const { &[CORNERS, Line::text("  yield vertex(c)")] },
        Relation::FaceEdges => {
            const { &[CORNERS, Line::text("  yield the edge to the next corner")] }
        }
        Relation::FaceFaces => {
            const {
                &[
                    Line::new("for each side of f", OF_ASKED_FACE),
                    Line::new(
                        "  v = the end of the side with fewer faces",
                        &[("fans", "vertex")],
                    ),
                    Line::new(
                        "  for each face g in the fan of v",
                        &[("pool", "first"), ("pool", Line::NEXT_ROW)],
                    ),
                    Line::new("    find v among the corners of g", OF_NAMED_FACE),
                    Line::text("    if the other end is beside v, and g is new: yield g"),
                ]
            }
        }
    }
}
