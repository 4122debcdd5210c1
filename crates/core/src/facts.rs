//! Topological properties of a list of faces.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::error::PolygonError;
use crate::face_list::FaceList;
use crate::faces_by_lowest::FacesByLowest;
use crate::incidence::{Incidence, corners_at_ends};
use crate::partition::Partition;
use crate::polygon_mesh::{PolygonMesh, repeated};

/// Topological properties of a list of faces, computed without a mesh data structure.
///
/// A face is degenerate if the face names a vertex twice or has fewer than three corners. The
/// fields `faces`, `face_degree` and `isolated_vertices` treat a degenerate face with three or more
/// corners like every other face. The field `degenerate_faces` counts the degenerate faces. All
/// fields except `faces`, `face_degree`, `isolated_vertices` and `degenerate_faces` ignore
/// degenerate faces. A field is `None` if its value is not defined for the mesh.
///
/// `genus` is computed from the Euler–Poincaré formula v − e + f = 2(c − g) − h, for v vertices, e
/// edges, f faces, c components, h boundary loops and genus g. In this formula, a vertex whose
/// faces form several fans (chains of faces that share edges) counts once per fan.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
pub struct Facts {
    /// The number of vertices, including isolated vertices.
    pub vertices: usize,
    /// The number of edges: unordered pairs of vertices that are adjacent in a face that is not
    /// degenerate.
    pub edges: usize,
    /// The number of faces with three or more corners, including degenerate faces.
    pub faces: usize,
    /// V − E + F, for V vertices with an edge, E edges, and F faces that are not degenerate.
    pub euler_characteristic: i64,
    /// The number of connected components; faces that share an edge are in the same component.
    pub components: usize,
    /// The number of edges with exactly one face.
    pub boundary_edges: usize,
    /// The number of closed boundary curves. At each vertex, a curve continues along the same fan
    /// (chain of faces that share edges). `None` if an edge has three or more faces.
    /// [`MeshQuery::boundary_loops`](crate::MeshQuery::boundary_loops) lists the curves.
    pub boundary_loops: Option<usize>,
    /// The number of edges with three or more faces.
    pub non_manifold_edges: usize,
    /// The number of vertices that are an end of an edge with three or more faces, or whose faces
    /// form several fans (chains of faces that share edges).
    pub non_manifold_vertices: usize,
    /// The number of edges with two faces that run along the edge in the same direction.
    pub inconsistent_edges: usize,
    /// True if, at every edge with two faces, the faces run along the edge in opposite directions.
    /// `None` if all faces are degenerate, or if there are no faces.
    pub consistently_oriented: Option<bool>,
    /// True if the faces can be flipped so that, at every edge with two faces, the faces run along
    /// the edge in opposite directions. `None` if all faces are degenerate, or if there are no
    /// faces.
    pub orientable: Option<bool>,
    /// True if at least one face is not degenerate, and every edge has two or more faces.
    pub closed: bool,
    /// The sum of the genera of all components. `None` if there are no faces, if all faces are
    /// degenerate, or if a component is not orientable or has an edge with three or more faces.
    pub genus: Option<i64>,
    /// The number of vertices that are in no face with three or more corners.
    pub isolated_vertices: usize,
    /// The number of faces that have the same set of vertices as an earlier face. Degenerate faces
    /// are not compared.
    pub duplicate_faces: usize,
    /// The number of faces that name a vertex twice or have fewer than three corners.
    pub degenerate_faces: usize,
    /// The distribution of the valence (number of edges at a vertex) over all vertices with an
    /// edge.
    pub valence: Option<Distribution>,
    /// The distribution of the degree (number of corners) over all faces with three or more
    /// corners.
    pub face_degree: Option<Distribution>,
}

/// The distribution of an integer property, such as the valence: minimum, maximum, mean and
/// histogram.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
pub struct Distribution {
    /// The smallest value.
    pub min: usize,
    /// The largest value.
    pub max: usize,
    /// The arithmetic mean.
    pub mean: f64,
    /// The number of times that each value occurs. `None` if there are more than 64 different
    /// values.
    #[cfg_attr(feature = "serde", serde(default, with = "Histogram"))]
    pub hist: Option<BTreeMap<usize, usize>>,
}

/// The form of a histogram in files. The values are strings, because JSON requires strings as keys.
#[cfg(feature = "serde")]
type Histogram = serde_with::As<Option<BTreeMap<serde_with::DisplayFromStr, serde_with::Same>>>;

impl Distribution {
    fn from_values(values: impl Iterator<Item = usize>) -> Option<Self> {
        let mut hist = BTreeMap::new();
        for value in values {
            *hist.entry(value).or_insert(0_usize) += 1;
        }
        let count: usize = hist.values().sum();
        let sum: f64 = hist
            .iter()
            .map(|(&value, &times)| value as f64 * times as f64)
            .sum();
        Some(Self {
            min: *hist.first_key_value()?.0,
            max: *hist.last_key_value()?.0,
            mean: sum / count as f64,
            hist: (hist.len() <= 64).then_some(hist),
        })
    }
}

impl Facts {
    /// Returns the topological properties of a polygon mesh; O(corners) expected.
    pub fn from_polygons(polygons: &PolygonMesh) -> Self {
        let (vertices, faces) = (polygons.vertex_count(), polygons.faces());
        let mut named = vec![false; vertices];
        for vertex in faces.corners() {
            named[vertex.index()] = true;
        }
        EdgePass::new(vertices, faces, &vec![true; faces.len()]).facts(&named)
    }

    /// Returns the topological properties of a list of faces; O(corners) expected. The faces may be
    /// degenerate, for example if they were read from a file.
    ///
    /// # Errors
    ///
    /// [`PolygonError::VertexOutOfRange`] for the first corner whose vertex does not exist.
    pub fn from_faces(vertices: usize, faces: &FaceList) -> Result<Self, PolygonError> {
        let mut named = vec![false; vertices];
        for (face, corners) in faces.iter() {
            for &vertex in corners {
                let seen = named.get_mut(vertex.index());
                let seen = seen.ok_or(PolygonError::VertexOutOfRange {
                    face,
                    vertex,
                    vertices,
                })?;
                *seen |= corners.len() >= 3;
            }
        }
        let used: Vec<bool> = faces
            .iter()
            .map(|(_, f)| f.len() >= 3 && repeated(f).is_none())
            .collect();
        Ok(EdgePass::new(vertices, faces, &used).facts(&named))
    }
}

struct EdgePass<'a> {
    faces: &'a FaceList,
    used: &'a [bool],
    edges: usize,
    boundary_edges: usize,
    non_manifold_edges: usize,
    inconsistent_edges: usize,
    orientable: bool,
    /// Sets of faces that are connected by shared edges. Each unused face is a set of its own.
    components: Partition,
    /// Sets of corners in the same fan. Each corner of an unused face is a set of its own.
    fans: Partition,
    /// The two fans at the ends of each boundary edge.
    boundary_fans: Vec<[usize; 2]>,
    /// By vertex: the number of edges that end there.
    valence: Vec<usize>,
    /// By vertex: whether a non-manifold edge ends there.
    on_non_manifold_edge: Vec<bool>,
}

impl<'a> EdgePass<'a> {
    fn new(vertices: usize, faces: &'a FaceList, used: &'a [bool]) -> Self {
        let incidence = Incidence::new(vertices, faces, |f| used[f.index()]);
        let mut pass = Self {
            faces,
            used,
            edges: 0,
            boundary_edges: 0,
            non_manifold_edges: 0,
            inconsistent_edges: 0,
            orientable: true,
            components: Partition::new(faces.len()),
            fans: incidence.fans(faces),
            boundary_fans: Vec::new(),
            valence: vec![0; vertices],
            on_non_manifold_edge: vec![false; vertices],
        };
        // For each edge with two faces: whether exactly one of the two faces must be flipped.
        let mut flipped = Partition::new(faces.len());
        for edge in incidence.edges() {
            pass.edges += 1;
            for v in edge.ends {
                pass.valence[v.index()] += 1;
                pass.on_non_manifold_edge[v.index()] |= edge.sides.len() > 2;
            }
            for pair in edge.sides.windows(2) {
                pass.components
                    .join(pair[0].face.index(), pair[1].face.index());
            }
            match edge.sides {
                [side] => {
                    pass.boundary_edges += 1;
                    let ends = corners_at_ends(side, faces);
                    let fans = ends.map(|corner| pass.fans.root(corner).0);
                    pass.boundary_fans.push(fans);
                }
                [a, b] => {
                    let same = a.downward == b.downward;
                    pass.inconsistent_edges += usize::from(same);
                    pass.orientable &= flipped.relate(a.face.index(), b.face.index(), same);
                }
                _ => pass.non_manifold_edges += 1,
            }
        }
        pass
    }

    fn facts(mut self, named: &[bool]) -> Facts {
        let faces = self.faces;
        let used_faces = self.used.iter().filter(|&&used| used).count();
        let used_vertices = self.valence.iter().filter(|&&valence| valence > 0).count();
        let components = self.components.classes() - (faces.len() - used_faces);
        let unused_corners: usize = faces
            .iter()
            .filter(|(f, _)| !self.used[f.index()])
            .map(|(_, c)| c.len())
            .sum();
        let fans = self.fans.classes() - unused_corners;
        let polygons = faces.iter().filter(|(_, face)| face.len() >= 3);
        let boundary_loops = (self.non_manifold_edges == 0).then(|| self.boundary_loops());
        let has_faces = used_faces > 0;
        let signed = |count: usize| i64::try_from(count).expect("counts fit");
        let genus = boundary_loops
            .filter(|_| has_faces && self.orientable)
            .map(|loops| {
                let characteristic = signed(fans) - signed(self.edges) + signed(used_faces);
                (2 * signed(components) - characteristic - signed(loops)) / 2
            });
        Facts {
            vertices: named.len(),
            edges: self.edges,
            faces: polygons.clone().count(),
            euler_characteristic: signed(used_vertices) - signed(self.edges) + signed(used_faces),
            components,
            boundary_edges: self.boundary_edges,
            boundary_loops,
            non_manifold_edges: self.non_manifold_edges,
            non_manifold_vertices: self.non_manifold_vertices(),
            inconsistent_edges: self.inconsistent_edges,
            consistently_oriented: has_faces.then_some(self.inconsistent_edges == 0),
            orientable: has_faces.then_some(self.orientable),
            closed: has_faces && self.boundary_edges == 0,
            genus,
            isolated_vertices: named.iter().filter(|&&named| !named).count(),
            duplicate_faces: self.duplicate_faces(),
            degenerate_faces: faces.len() - used_faces,
            valence: Distribution::from_values(
                self.valence.iter().copied().filter(|&valence| valence > 0),
            ),
            face_degree: Distribution::from_values(polygons.map(|(_, face)| face.len())),
        }
    }

    /// Returns the number of sets of fans that are joined by boundary edges.
    fn boundary_loops(&self) -> usize {
        let mut fans: Vec<usize> = self.boundary_fans.iter().flatten().copied().collect();
        fans.sort_unstable();
        fans.dedup();
        let mut loops = Partition::new(fans.len());
        for ends in &self.boundary_fans {
            let [a, b] = ends.map(|fan| fans.binary_search(&fan).expect("listed above"));
            loops.join(a, b);
        }
        loops.classes()
    }

    fn non_manifold_vertices(&mut self) -> usize {
        let mut fan: Vec<Option<usize>> = vec![None; self.valence.len()];
        for (f, face) in self.faces.iter().filter(|(f, _)| self.used[f.index()]) {
            for (corner, v) in self.faces.range(f).zip(face) {
                let (root, _) = self.fans.root(corner);
                let first = *fan[v.index()].get_or_insert(root);
                self.on_non_manifold_edge[v.index()] |= root != first;
            }
        }
        self.on_non_manifold_edge
            .iter()
            .filter(|&&is_non_manifold| is_non_manifold)
            .count()
    }

    /// Returns the number of faces with the same vertices as an earlier face.
    fn duplicate_faces(&self) -> usize {
        let vertices = self.valence.len();
        let by_lowest = FacesByLowest::new(vertices, self.faces, |f| self.used[f.index()]);
        let mut corners = Vec::new();
        let mut sets: Vec<Range<usize>> = Vec::new();
        let mut duplicates = 0;
        for faces in by_lowest.several() {
            corners.clear();
            sets.clear();
            for &f in faces {
                let start = corners.len();
                corners.extend_from_slice(self.faces.face(f));
                corners[start..].sort_unstable();
                sets.push(start..corners.len());
            }
            sets.sort_unstable_by(|a, b| corners[a.clone()].cmp(&corners[b.clone()]));
            let pairs = sets.windows(2);
            let equal =
                |pair: &&[Range<usize>]| corners[pair[0].clone()] == corners[pair[1].clone()];
            duplicates += pairs.filter(equal).count();
        }
        duplicates
    }
}
