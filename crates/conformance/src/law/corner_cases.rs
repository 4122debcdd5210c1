//! The required answers in corner cases, written by hand.

use sixfold_core::Representation;

use crate::answers::answers;
use crate::element::Element;
use crate::gallery::gallery;
use crate::print::one_line;
use crate::weld::welded;

/// Expected [`answers`] for a mesh of the gallery; "none" means that the mesh has no such ring or
/// loop.
struct Case {
    mesh: &'static str,
    answers: &'static [(&'static str, &'static str)],
}

const CASES: &[Case] = &[
    Case {
        mesh: "pillow of two triangles",
        answers: &[
            ("vertex_vertices v0", "v1 v2"),
            ("vertex_edges v0", "v0–v1 v0–v2"),
            ("vertex_faces v0", "f0 f1"),
            ("edge_edges v0–v1", "v0–v2 v1–v2"),
            ("edge_faces v0–v1", "f0 f1"),
            ("face_faces f0", "f1"),
            ("face_faces f1", "f0"),
            ("face_edges f0", "v0–v1 v1–v2 v0–v2"),
            ("face_edges f1", "v0–v1 v0–v2 v1–v2"),
            ("one_ring v0", "v1 v2"),
        ],
    },
    Case {
        mesh: "pillow of two quads",
        answers: &[
            ("vertex_vertices v0", "v1 v3"),
            ("face_faces f0", "f1"),
            ("edge_edges v0–v1", "v0–v3 v1–v2"),
            ("one_ring v0", "v1 v3"),
        ],
    },
    Case {
        mesh: "two quads sharing two edges",
        answers: &[
            ("vertex_vertices v1", "v0 v2"),
            ("vertex_faces v1", "f0 f1"),
            ("edge_faces v0–v1", "f0 f1"),
            ("edge_edges v0–v1", "v0–v3 v0–v4 v1–v2"),
            ("face_faces f0", "f1"),
            ("face_faces f1", "f0"),
            ("one_ring v1", "v0 v2"),
            ("one_ring v0", "v4 v1 v3"),
            ("boundary_loop 0", "v0 v3 v2 v4"),
            ("boundary_loop 1", "none"),
        ],
    },
    Case {
        mesh: "single triangle",
        answers: &[
            ("vertex_vertices v0", "v1 v2"),
            ("edge_faces v0–v1", "f0"),
            ("edge_edges v0–v1", "v0–v2 v1–v2"),
            ("face_faces f0", ""),
            ("one_ring v0", "v1 v2"),
            ("one_ring v1", "v2 v0"),
            ("boundary_loop 0", "v0 v2 v1"),
        ],
    },
    Case {
        mesh: "points only",
        answers: &[
            ("vertex_vertices v0", ""),
            ("vertex_edges v0", ""),
            ("one_ring v0", ""),
        ],
    },
    Case {
        mesh: "isolated vertices first, between and last",
        answers: &[
            ("vertex_vertices v3", ""),
            ("vertex_edges v3", ""),
            ("vertex_faces v3", ""),
            ("one_ring v3", ""),
            ("one_ring v2", "v5 v4 v1"),
        ],
    },
    Case {
        mesh: "duplicate face",
        answers: &[
            ("vertex_faces v0", "f0 f1"),
            ("vertex_vertices v0", "v1 v2"),
            ("edge_faces v0–v1", "f0 f1"),
            ("edge_faces v1–v2", "f0 f1 f2"),
            ("face_faces f0", "f1 f2"),
            ("face_faces f1", "f0 f2"),
            ("one_ring v0", "none"),
            ("one_ring v3", "v2 v1"),
        ],
    },
    Case {
        mesh: "one face, three times",
        answers: &[
            ("face_faces f0", "f1 f2"),
            ("edge_edges v0–v1", "v0–v2 v1–v2"),
            ("one_ring v0", "none"),
        ],
    },
    Case {
        mesh: "open bow-tie",
        answers: &[
            ("vertex_vertices v0", "v1 v2 v3 v4"),
            ("vertex_faces v0", "f0 f1"),
            ("edge_edges v0–v1", "v0–v2 v0–v3 v0–v4 v1–v2"),
            ("face_faces f0", ""),
            ("one_ring v0", "none"),
            ("one_ring v1", "v2 v0"),
            ("boundary_loop 0", "v0 v2 v1"),
            ("boundary_loop 1", "v0 v4 v3"),
        ],
    },
    Case {
        mesh: "closed bow-tie",
        answers: &[
            ("vertex_vertices v0", "v1 v2 v3 v4 v5 v6"),
            ("face_faces f0", "f1 f2 f3"),
            ("one_ring v0", "none"),
        ],
    },
    Case {
        mesh: "three faces on an edge",
        answers: &[
            ("edge_faces v0–v1", "f0 f1 f2"),
            ("face_faces f0", "f1 f2"),
            ("face_faces f2", "f0 f1"),
            ("vertex_vertices v0", "v1 v2 v3 v4"),
            ("one_ring v0", "none"),
            ("one_ring v2", "v0 v1"),
            ("boundary_chain 0", "v0 v2 v1"),
            ("boundary_chain 1", "v0 v4 v1"),
            ("boundary_chain 2", "v1 v3 v0"),
        ],
    },
    Case {
        mesh: "two triangles with the same side",
        answers: &[
            ("face_faces f0", "f1"),
            ("edge_faces v0–v1", "f0 f1"),
            ("one_ring v0", "none"),
            ("one_ring v2", "v0 v1"),
            ("boundary_loop 0", "v0 v2 v1 v3"),
        ],
    },
    Case {
        mesh: "two holes that touch at a vertex",
        answers: &[
            (
                "boundary_loop 0",
                "v0 v5 v10 v15 v20 v21 v22 v23 v24 v19 v14 v9 v4 v3 v2 v1",
            ),
            ("boundary_loop 1", "v6 v7 v12 v13 v18 v17 v12 v11"),
            ("boundary_loop 2", "none"),
        ],
    },
];

/// In corner cases, the answers of the structure equal a table made by hand.
pub fn corner_cases<M: Representation>() {
    let gallery = gallery();
    let mut compared = 0;
    for case in CASES {
        let entry = gallery.iter().find(|entry| entry.name == case.mesh);
        let polygons = &entry.expect("the gallery has it").polygons;
        // If vertices are identified by coordinates, meshes that welding changes are skipped.
        if !M::CAPABILITIES.coincident_vertices && welded(polygons).as_ref() != Ok(polygons) {
            continue;
        }
        let Some(got) = answers::<M>(polygons) else {
            continue;
        };
        compared += 1;
        for &(query, expected) in case.answers {
            let got = got
                .get(query)
                .map_or("none".to_owned(), |items| joined(items));
            assert_eq!(
                got,
                expected,
                "{}: {query} on “{}” ({})",
                M::NAME,
                case.mesh,
                one_line(polygons)
            );
        }
    }
    assert!(
        compared > 0,
        "{}: cannot hold any mesh of the corner cases",
        M::NAME
    );
}

fn joined(items: &[Element]) -> String {
    let joined: Vec<String> = items.iter().map(ToString::to_string).collect();
    joined.join(" ")
}
