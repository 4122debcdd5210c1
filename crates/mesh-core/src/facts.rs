//! The topology of a list of faces, in facts.

use std::collections::BTreeMap;

use rustc_hash::FxHashSet;
use serde::{Deserialize, Serialize};
use serde_with::{DisplayFromStr, serde_as};

use crate::error::PolygonError;
use crate::face_list::FaceList;
use crate::incidence::{Incidence, corners_at_ends};
use crate::partition::Partition;
use crate::polygon_mesh::{PolygonMesh, repeated};

/// What a list of faces is, topologically; exact, and independent of any structure.
///
/// Faces that name a vertex twice are counted as `degenerate_faces` and take part in `faces`,
/// `face_degree` and `isolated_vertices` only. Fewer than three corners make no face at all: they
/// are counted as degenerate and nowhere else. Fields that are `None` are not defined for the mesh.
///
/// With vertices cut apart where fans meet, v − e + f = 2(c − g) − h for c components, h boundary
/// loops and genus g (Euler–Poincaré); `genus` is solved from it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Facts {
    /// Vertices, isolated ones included.
    pub vertices: usize,
    /// Unordered pairs of vertices that follow each other in some face.
    pub edges: usize,
    /// Faces with three corners or more, in whatever shape.
    pub faces: usize,
    /// V − E + F over the vertices and faces that are used.
    pub euler_characteristic: i64,
    /// Classes of faces under "share an edge".
    pub components: usize,
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Closed boundary curves, vertices cut apart where fans meet; `None` with a non-manifold edge.
    pub boundary_loops: Option<usize>,
    /// Edges with three faces or more.
    pub non_manifold_edges: usize,
    /// Used vertices with more than one fan, or at the end of a non-manifold edge.
    pub non_manifold_vertices: usize,
    /// Edges with two faces that both run along it in the same direction.
    pub inconsistent_edges: usize,
    /// No inconsistent edge; `None` without faces.
    pub consistently_oriented: Option<bool>,
    /// Whether turning faces over can make every edge of two faces consistent; `None` without faces.
    pub orientable: Option<bool>,
    /// There are faces, and no boundary edge.
    pub closed: bool,
    /// Sum over the components; `None` unless all are orientable and without non-manifold edges.
    pub genus: Option<i64>,
    /// Vertices that no face names.
    pub isolated_vertices: usize,
    /// Used faces less the distinct vertex sets among them.
    pub duplicate_faces: usize,
    /// Faces that name a vertex twice, and lists of fewer than three corners.
    pub degenerate_faces: usize,
    /// Edges at a vertex, over the used vertices.
    pub valence: Option<Spread>,
    /// Corners of a face.
    pub face_degree: Option<Spread>,
}

/// How a count is spread: its extremes, its mean, and how often each value occurs.
#[serde_as]
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Spread {
    /// The smallest value.
    pub min: usize,
    /// The largest value.
    pub max: usize,
    /// The arithmetic mean.
    pub mean: f64,
    /// How often each value occurs; `None` where there are more than 64 values.
    #[serde_as(as = "Option<BTreeMap<DisplayFromStr, _>>")]
    pub hist: Option<BTreeMap<usize, usize>>,
}

impl Spread {
    /// The spread of `values`; `None` if there are none.
    fn of(values: impl Iterator<Item = usize>) -> Option<Self> {
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
    /// The facts of a polygon mesh; O(corners) expected.
    pub fn of(polygons: &PolygonMesh) -> Self {
        let (vertices, faces) = (polygons.vertex_count(), polygons.faces());
        let mut named = vec![false; vertices];
        for vertex in faces.corners() {
            named[vertex.index()] = true;
        }
        Survey::of(vertices, faces, &vec![true; faces.len()]).facts(&named)
    }

    /// The facts of faces as a file gives them, degenerate ones included; O(corners) expected.
    ///
    /// # Errors
    ///
    /// [`PolygonError::VertexOutOfRange`] for the first corner that names no vertex.
    pub fn of_faces(vertices: usize, faces: &FaceList) -> Result<Self, PolygonError> {
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
        Ok(Survey::of(vertices, faces, &used).facts(&named))
    }
}

/// Everything that one walk over the edges tells.
struct Survey<'a> {
    faces: &'a FaceList,
    used: &'a [bool],
    edges: usize,
    boundary_edges: usize,
    non_manifold_edges: usize,
    inconsistent_edges: usize,
    orientable: bool,
    /// Classes of faces under "share an edge"; unused faces are classes of their own.
    components: Partition,
    /// Classes of corners under "same fan"; corners of unused faces are classes of their own.
    fans: Partition,
    /// Classes of fans under "joined by a boundary edge".
    loops: Partition,
    /// One fan of every boundary edge.
    boundary_fans: Vec<usize>,
    /// By vertex: how many edges end there.
    valence: Vec<usize>,
    /// By vertex: whether a non-manifold edge ends there.
    on_non_manifold_edge: Vec<bool>,
}

impl<'a> Survey<'a> {
    fn of(vertices: usize, faces: &'a FaceList, used: &'a [bool]) -> Self {
        let incidence = Incidence::of(vertices, faces, |f| used[f.index()]);
        let corners = faces.corners().len();
        let mut survey = Self {
            faces,
            used,
            edges: 0,
            boundary_edges: 0,
            non_manifold_edges: 0,
            inconsistent_edges: 0,
            orientable: true,
            components: Partition::new(faces.len()),
            fans: incidence.fans(faces),
            loops: Partition::new(corners),
            boundary_fans: Vec::new(),
            valence: vec![0; vertices],
            on_non_manifold_edge: vec![false; vertices],
        };
        // Which faces have to be turned over against which, apart from what is joined.
        let mut turned = Partition::new(faces.len());
        for edge in incidence.edges() {
            survey.edges += 1;
            for v in edge.ends {
                survey.valence[v.index()] += 1;
                survey.on_non_manifold_edge[v.index()] |= edge.sides.len() > 2;
            }
            for pair in edge.sides.windows(2) {
                survey
                    .components
                    .join(pair[0].face.index(), pair[1].face.index());
            }
            match edge.sides {
                [side] => {
                    survey.boundary_edges += 1;
                    let ends = corners_at_ends(side, faces);
                    let [a, b] = ends.map(|corner| survey.fans.root(corner).0);
                    survey.loops.join(a, b);
                    survey.boundary_fans.push(a);
                }
                [a, b] => {
                    let same = a.downward == b.downward;
                    survey.inconsistent_edges += usize::from(same);
                    survey.orientable &= turned.relate(a.face.index(), b.face.index(), same);
                }
                _ => survey.non_manifold_edges += 1,
            }
        }
        survey
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
        let any = used_faces > 0;
        let signed = |count: usize| i64::try_from(count).expect("counts fit");
        let genus = boundary_loops
            .filter(|_| any && self.orientable)
            .map(|loops| {
                let cut = signed(fans) - signed(self.edges) + signed(used_faces);
                (2 * signed(components) - cut - signed(loops)) / 2
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
            consistently_oriented: any.then_some(self.inconsistent_edges == 0),
            orientable: any.then_some(self.orientable),
            closed: any && self.boundary_edges == 0,
            genus,
            isolated_vertices: named.iter().filter(|&&named| !named).count(),
            duplicate_faces: used_faces - self.distinct_vertex_sets(),
            degenerate_faces: faces.len() - used_faces,
            valence: Spread::of(self.valence.iter().copied().filter(|&valence| valence > 0)),
            face_degree: Spread::of(polygons.map(|(_, face)| face.len())),
        }
    }

    /// Classes of fans under "joined by a boundary edge", of those that have one.
    fn boundary_loops(&mut self) -> usize {
        let fans = std::mem::take(&mut self.boundary_fans);
        let loops = fans.into_iter().map(|fan| self.loops.root(fan).0);
        loops.collect::<FxHashSet<_>>().len()
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
        self.on_non_manifold_edge.iter().filter(|&&not| not).count()
    }

    fn distinct_vertex_sets(&self) -> usize {
        let mut corners = self.faces.corners().to_vec();
        for (f, _) in self.faces.iter() {
            corners[self.faces.range(f)].sort_unstable();
        }
        let used = self.faces.iter().filter(|(f, _)| self.used[f.index()]);
        let sets = used.map(|(f, _)| &corners[self.faces.range(f)]);
        sets.collect::<FxHashSet<_>>().len()
    }
}
