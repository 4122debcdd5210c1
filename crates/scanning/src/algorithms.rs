//! The queries that scan all corners, as textbooks write them.

use sixfold_core::{Line, Relation};

/// The ways to the corners of the face of the query.
const OF_ASKED_FACE: &[(&str, &str)] = &[
    ("offsets", Line::ASKED),
    ("offsets", Line::NEXT_ROW),
    ("spans", Line::ASKED),
    ("corners", Line::ASKED),
];
/// The ways to the face of a corner: by its number if all faces have the same degree, else by a
/// search or by the owner of the corner.
const FACE_OF_CORNER: &[(&str, &str)] = &[
    ("offsets", Line::SEARCH),
    ("offsets", "face"),
    ("offsets", Line::NEXT_ROW),
    ("owners", Line::SAME),
    ("spans", "face"),
];
const BESIDE: &[(&str, &str)] = &[("corners", "face"), ("corners", Line::SAME)];
const SCAN: Line = Line::new("for every corner c of the mesh", &[("corners", Line::SCAN)]);
const AT_VERTEX: Line = Line::new("  if c is at v: f = face of c", FACE_OF_CORNER);
const CORNERS: Line = Line::new("for each corner c of f", OF_ASKED_FACE);

/// Returns the steps of a query of a structure that scans all corners, for
/// [`Described`](sixfold_core::Described).
pub fn algorithm_of(relation: Relation) -> &'static [Line] {
    match relation {
        Relation::VertexVertices => {
            const {
                &[
                    SCAN,
                    AT_VERTEX,
                    Line::new("    read the corners before and after c in f", BESIDE),
                    Line::text("    yield their vertices, if they are new"),
                ]
            }
        }
        Relation::VertexEdges => {
            const {
                &[
                    SCAN,
                    AT_VERTEX,
                    Line::new("    read the corners before and after c in f", BESIDE),
                    Line::text("    yield the edges to their vertices, if they are new"),
                ]
            }
        }
        Relation::VertexFaces => const { &[SCAN, AT_VERTEX, Line::text("    yield f")] },
        Relation::EdgeVertices => const { &[Line::text("yield both ends: they are the edge")] },
        Relation::EdgeEdges => {
            const {
                &[
                    SCAN,
                    Line::new("  if c is at an end of e: f = face of c", FACE_OF_CORNER),
                    Line::new("    read the corners before and after c in f", BESIDE),
                    Line::text("    note the edges to their vertices"),
                    Line::text("yield each noted edge once, except e"),
                ]
            }
        }
        Relation::EdgeFaces => {
            const {
                &[
                    SCAN,
                    Line::new(
                        "  if c is at the first end of e: f = face of c",
                        FACE_OF_CORNER,
                    ),
                    Line::new("    read the corners before and after c in f", BESIDE),
                    Line::text("    if one of them is at the other end, yield f"),
                ]
            }
        }
        Relation::FaceVertices => const { &[CORNERS, Line::text("  yield the vertex of c")] },
        Relation::FaceEdges => {
            const { &[CORNERS, Line::text("  yield the edge to the next corner")] }
        }
        Relation::FaceFaces => {
            const {
                &[
                    Line::new("read the corners of f", OF_ASKED_FACE),
                    SCAN,
                    Line::new(
                        "  if c is at every second corner of f: g = face of c",
                        FACE_OF_CORNER,
                    ),
                    Line::new("    read the corners before and after c in g", BESIDE),
                    Line::text("    if g has a side of f, and is new: yield g"),
                ]
            }
        }
    }
}
