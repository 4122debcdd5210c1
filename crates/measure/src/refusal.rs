//! Why a structure cannot hold a mesh, as text: all kinds of faults, not only the first.

use std::cell::OnceCell;

use sixfold::{BuildError, Capabilities, Facts, PolygonMesh};
use sixfold_core::Counts;

use crate::study_mesh::StudyMesh;
use sixfold_results::numbers::counted;

/// A mesh from which backends are built. The facts that explain refusals are computed once, for the
/// first refusal.
pub struct BuildInput<'a> {
    pub polygons: &'a PolygonMesh,
    pub counts: Counts,
    facts: OnceCell<Facts>,
}

impl<'a> BuildInput<'a> {
    /// Creates the input from a mesh whose facts are not known, except its number of edges.
    pub fn new(polygons: &'a PolygonMesh, edges: usize) -> Self {
        Self {
            polygons,
            counts: polygons.counts(edges),
            facts: OnceCell::new(),
        }
    }

    /// Creates the input with known `facts` of `polygons`.
    pub fn with_facts(polygons: &'a PolygonMesh, facts: &Facts) -> Self {
        Self {
            facts: OnceCell::from(facts.clone()),
            ..Self::new(polygons, facts.edges)
        }
    }

    /// Creates the input from the polygons of `study_mesh`. If the file has degenerate faces, the
    /// facts of the file are not those of the polygons.
    pub fn from_study_mesh(study_mesh: &'a StudyMesh) -> Self {
        let StudyMesh {
            polygons, facts, ..
        } = study_mesh;
        match facts.degenerate_faces {
            0 => Self::with_facts(polygons, facts),
            _ => Self::new(polygons, facts.edges),
        }
    }

    /// Returns why a structure with `capabilities` refused the mesh with `refusal`, as
    /// [`reason`] does. The first call takes O(corners) if the facts are not known; other calls
    /// take O(1).
    pub fn reason(&self, refusal: &BuildError, capabilities: &Capabilities) -> String {
        let facts = || Facts::from_polygons(self.polygons);
        let facts = self.facts.get_or_init(facts);
        reason(refusal, capabilities, facts)
    }
}

/// A kind of fault that some structures cannot hold.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fault {
    Polygons,
    NonManifoldEdges,
    NonManifoldVertices,
    Orientation,
    IsolatedVertices,
}

/// Returns why a structure with `capabilities` refused a mesh with `refusal`: the elements of the
/// first fault, then the number of faults of each other kind, which `facts` of the mesh have.
fn reason(refusal: &BuildError, capabilities: &Capabilities, facts: &Facts) -> String {
    let (first, text) = match refusal {
        BuildError::NotATriangle { .. } => (Some(Fault::Polygons), refusal.to_string()),
        BuildError::NonManifoldEdge { .. } => (Some(Fault::NonManifoldEdges), refusal.to_string()),
        BuildError::NonManifoldVertex { .. } => {
            (Some(Fault::NonManifoldVertices), refusal.to_string())
        }
        BuildError::RepeatedSide {
            from,
            to,
            first,
            second,
        } if facts.orientable == Some(false) => (
            Some(Fault::Orientation),
            format!(
                "faces {first} and {second} both run {from}→{to}, and flipping cannot help, because the surface is not orientable: cut it open, or choose a structure that holds any orientation"
            ),
        ),
        BuildError::RepeatedSide { .. } => (Some(Fault::Orientation), refusal.to_string()),
        BuildError::IsolatedVertex { .. } => (Some(Fault::IsolatedVertices), refusal.to_string()),
        _ => (None, refusal.to_string()),
    };
    let others: Vec<String> = faults(capabilities, facts)
        .into_iter()
        .filter(|(fault, _)| Some(*fault) != first)
        .map(|(_, text)| text)
        .collect();
    match &others[..] {
        [] => text,
        others => format!("{text}; the mesh also has {}", others.join(", ")),
    }
}

/// Returns the kinds of faults of a mesh that a structure cannot hold, each with its number.
fn faults(capabilities: &Capabilities, facts: &Facts) -> Vec<(Fault, String)> {
    let most_corners = facts.face_degree.as_ref().map_or(0, |degree| degree.max);
    let mut faults = Vec::new();
    if !capabilities.polygons && most_corners > 3 {
        faults.push((
            Fault::Polygons,
            format!("faces with up to {most_corners} corners"),
        ));
    }
    let edges = facts.non_manifold_edges;
    if !capabilities.non_manifold_edges && edges > 0 {
        let text = counted(edges, "non-manifold edge", "non-manifold edges");
        faults.push((Fault::NonManifoldEdges, text));
    }
    // The ends of non-manifold edges count as non-manifold vertices, too.
    let vertices = facts.non_manifold_vertices;
    if !capabilities.non_manifold_vertices && vertices > 0 && edges == 0 {
        let text = counted(vertices, "non-manifold vertex", "non-manifold vertices");
        faults.push((Fault::NonManifoldVertices, text));
    }
    let inconsistent = facts.inconsistent_edges;
    if !capabilities.inconsistent_orientation && inconsistent > 0 {
        let text = counted(
            inconsistent,
            "edge along which both faces run in the same direction",
            "edges along which both faces run in the same direction",
        );
        faults.push((Fault::Orientation, text));
    }
    let isolated = facts.isolated_vertices;
    if !capabilities.isolated_vertices && isolated > 0 {
        let text = counted(isolated, "isolated vertex", "isolated vertices");
        faults.push((Fault::IsolatedVertices, text));
    }
    faults
}

#[cfg(test)]
mod tests {
    use sixfold::Point;

    use super::*;

    fn reason_of(faces: &[&[u32]], vertices: usize) -> String {
        let positions = (0..vertices).map(|i| Point::new(i as f32, (i * i) as f32, 0.0));
        let polygons = PolygonMesh::new(positions, faces).expect("valid faces");
        let capabilities = Capabilities {
            polygons: false,
            isolated_vertices: false,
            ..Capabilities::ORIENTED_MANIFOLDS
        };
        let refusal = capabilities.check(&polygons).expect_err("faults");
        let facts = Facts::from_polygons(&polygons);
        let input = BuildInput::with_facts(&polygons, &facts);
        input.reason(&refusal, &capabilities)
    }

    #[test]
    fn every_kind_of_fault_is_named() {
        let three: &[&[u32]] = &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4, 5]];
        let text = reason_of(three, 7);
        assert!(text.starts_with("face f2 has 4 corners"), "{text}");
        assert!(
            text.ends_with("also has 1 non-manifold edge, 1 isolated vertex"),
            "{text}"
        );
        let text = reason_of(&[&[0, 1, 2], &[3, 4, 0]], 5);
        assert!(text.contains("meet at vertex v0"), "{text}");
        assert!(!text.contains("also"), "{text}");
    }

    #[test]
    fn flipping_is_advised_only_if_it_can_help() {
        let flippable = reason_of(&[&[0, 1, 2], &[0, 1, 3]], 4);
        assert!(flippable.contains("reverse one of them"), "{flippable}");
        // A Möbius strip of five triangles.
        let strip: &[&[u32]] = &[&[0, 1, 2], &[2, 1, 3], &[2, 3, 4], &[4, 3, 0], &[4, 0, 1]];
        let text = reason_of(strip, 5);
        assert!(text.contains("not orientable"), "{text}");
        assert!(!text.contains("reverse one"), "{text}");
    }
}
