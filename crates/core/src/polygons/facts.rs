//! Topological properties of a list of faces.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::handles::row_id::FaceId;
use crate::polygons::classes::Classes;
use crate::polygons::error::PolygonError;
use crate::polygons::face_list::FaceList;
use crate::polygons::faces_by_lowest::FacesByLowest;
use crate::polygons::fans::Fans;
use crate::polygons::incidence::Incidence;
use crate::polygons::partition::Partition;
use crate::polygons::polygon_mesh::{PolygonMesh, repeated};
use crate::tables::threads::join;

/// Topological properties of a list of faces, computed without a mesh data structure.
///
/// A face is degenerate if the face names a vertex twice or has fewer than three corners. The
/// fields `faces`, `face_degree` and `isolated_vertices` treat a degenerate face with three or more
/// corners like every other face. The field `degenerate_faces` counts the degenerate faces. All
/// fields except `faces`, `face_degree`, `isolated_vertices` and `degenerate_faces` ignore
/// degenerate faces. A field is `None` if its value is not defined for the mesh.
///
/// The field `genus` is computed from the Euler–Poincaré formula v − e + f = 2(c − g) − h, for v
/// vertices, e edges, f faces, c components, h boundary loops and genus g. In this formula, a
/// vertex whose faces form several fans (chains of faces that share edges) counts once per fan.
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
    #[cfg_attr(feature = "serde", serde(default, deserialize_with = "histogram"))]
    pub hist: Option<BTreeMap<usize, usize>>,
}

/// Reads a histogram. In files its values are strings, because JSON requires strings as keys.
#[cfg(feature = "serde")]
fn histogram<'de, D>(deserializer: D) -> Result<Option<BTreeMap<usize, usize>>, D::Error>
where
    D: serde::Deserializer<'de>,
{
    let hist: Option<BTreeMap<String, usize>> = serde::Deserialize::deserialize(deserializer)?;
    let parsed = hist.map(|hist| {
        hist.iter()
            .map(|(value, n)| Ok((value.parse()?, *n)))
            .collect()
    });
    let parsed: Result<_, std::num::ParseIntError> = parsed.transpose();
    parsed.map_err(serde::de::Error::custom)
}

impl Distribution {
    fn from_values(values: impl Iterator<Item = usize>) -> Option<Self> {
        let mut hist = BTreeMap::new();
        // Most values equal the value before them.
        let mut run = (0, 0);
        for value in values {
            if value != run.0 {
                *hist.entry(run.0).or_insert(0_usize) += run.1;
                run = (value, 0);
            }
            run.1 += 1;
        }
        *hist.entry(run.0).or_insert(0) += run.1;
        hist.retain(|_, &mut times| times > 0);
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
    /// Returns the topological properties of a polygon mesh; O(n log n) for n corners.
    pub fn from_polygons(polygons: &PolygonMesh) -> Self {
        let faces = polygons.faces();
        let incidence = Incidence::new(polygons.vertex_count(), faces, |_| true);
        Self::from_fans(&Fans::new(&incidence))
    }

    /// Returns the topological properties of the polygon mesh whose fans are known; O(n log n) for n
    /// corners. The incidence of the fans must have the sides of all faces of a [`PolygonMesh`].
    ///
    /// With the feature `rayon`, two threads share the work.
    pub fn from_fans(fans: &Fans<'_>) -> Self {
        let faces = fans.incidence().faces();
        let mut named = vec![false; fans.incidence().vertex_count()];
        for vertex in faces.corners() {
            named[vertex.index()] = true;
        }
        FaceFacts::new(fans, None).facts(&named)
    }

    /// Returns the topological properties of a list of faces; O(n log n) expected for n corners.
    /// The faces may be degenerate, for example if they were read from a file.
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
        let incidence = Incidence::new(vertices, faces, |f| used[f.index()]);
        Ok(FaceFacts::new(&Fans::new(&incidence), Some(&used)).facts(&named))
    }
}

/// What the facts are computed from.
struct FaceFacts<'a> {
    fans: &'a Fans<'a>,
    /// By face: whether it is not degenerate; `None` if no face is.
    used: Option<&'a [bool]>,
    edges: EdgeFacts,
    /// The number of classes of faces that are connected by shared edges. Each unused face is a
    /// class of its own.
    components: usize,
    duplicate_faces: usize,
}

/// Numbers of edges.
struct EdgeFacts {
    edges: usize,
    boundary_edges: usize,
    non_manifold_edges: usize,
    inconsistent_edges: usize,
    /// The two fans at the ends of each boundary edge.
    boundary_fans: Vec<[u32; 2]>,
    /// By vertex: the number of edges that end there.
    valence: Vec<u32>,
    /// By vertex: whether a non-manifold edge ends there.
    on_non_manifold_edge: Vec<bool>,
}

impl EdgeFacts {
    fn new(fans: &Fans<'_>) -> Self {
        let incidence = fans.incidence();
        let vertices = incidence.vertex_count();
        let mut facts = Self {
            edges: 0,
            boundary_edges: 0,
            non_manifold_edges: 0,
            inconsistent_edges: 0,
            boundary_fans: Vec::new(),
            valence: vec![0; vertices],
            on_non_manifold_edge: vec![false; vertices],
        };
        for edge in incidence.edges() {
            facts.edges += 1;
            for v in edge.ends {
                facts.valence[v.index()] += 1;
            }
            match edge.len() {
                1 => {
                    facts.boundary_edges += 1;
                    let corners = incidence.corners_at_ends(edge.first());
                    facts.boundary_fans.push(corners.map(|c| fans.root(c)));
                }
                2 => facts.inconsistent_edges += usize::from(edge.downward() != 1),
                _ => {
                    facts.non_manifold_edges += 1;
                    for v in edge.ends {
                        facts.on_non_manifold_edge[v.index()] = true;
                    }
                }
            }
        }
        facts
    }

    /// Returns the number of sets of fans that are joined by boundary edges.
    fn boundary_loops(&self) -> usize {
        let mut fans: Vec<u32> = self.boundary_fans.iter().flatten().copied().collect();
        fans.sort_unstable();
        fans.dedup();
        let mut loops = Classes::new(fans.len());
        for ends in &self.boundary_fans {
            let [a, b] = ends.map(|fan| fans.binary_search(&fan).expect("listed above"));
            loops.join(a, b);
        }
        loops.into_numbers().1
    }
}

impl<'a> FaceFacts<'a> {
    fn new(fans: &'a Fans<'a>, used: Option<&'a [bool]>) -> Self {
        let incidence = fans.incidence();
        let (edges, (components, duplicate_faces)) = join(
            || EdgeFacts::new(fans),
            || (components(incidence), duplicate_faces(incidence, used)),
        );
        Self {
            fans,
            used,
            edges,
            components,
            duplicate_faces,
        }
    }

    fn is_used(&self, f: FaceId) -> bool {
        self.used.is_none_or(|used| used[f.index()])
    }

    fn facts(self, named: &[bool]) -> Facts {
        let faces = self.fans.incidence().faces();
        let unused = faces.iter().filter(|&(f, _)| !self.is_used(f));
        let (unused_faces, unused_corners) = unused.fold((0, 0), |(faces, corners), (_, face)| {
            (faces + 1, corners + face.len())
        });
        let used_faces = faces.len() - unused_faces;
        let components = self.components - unused_faces;
        let fans = self.fans.len() - unused_corners;
        let edges = &self.edges;
        let used_vertices = edges.valence.iter().filter(|&&valence| valence > 0).count();
        let polygons = faces.iter().filter(|(_, face)| face.len() >= 3);
        let boundary_loops = (edges.non_manifold_edges == 0).then(|| edges.boundary_loops());
        let has_faces = used_faces > 0;
        let orientable = edges.inconsistent_edges == 0 || is_orientable(self.fans.incidence());
        let signed = |count: usize| i64::try_from(count).expect("counts fit");
        let genus = boundary_loops
            .filter(|_| has_faces && orientable)
            .map(|loops| {
                let characteristic = signed(fans) - signed(edges.edges) + signed(used_faces);
                (2 * signed(components) - characteristic - signed(loops)) / 2
            });
        let valences = edges.valence.iter().filter(|&&valence| valence > 0);
        Facts {
            vertices: named.len(),
            edges: edges.edges,
            faces: polygons.clone().count(),
            euler_characteristic: signed(used_vertices) - signed(edges.edges) + signed(used_faces),
            components,
            boundary_edges: edges.boundary_edges,
            boundary_loops,
            non_manifold_edges: edges.non_manifold_edges,
            non_manifold_vertices: self.non_manifold_vertices(),
            inconsistent_edges: edges.inconsistent_edges,
            consistently_oriented: has_faces.then_some(edges.inconsistent_edges == 0),
            orientable: has_faces.then_some(orientable),
            closed: has_faces && edges.boundary_edges == 0,
            genus,
            isolated_vertices: named.iter().filter(|&&named| !named).count(),
            duplicate_faces: self.duplicate_faces,
            degenerate_faces: unused_faces,
            valence: Distribution::from_values(valences.map(|&valence| valence as usize)),
            face_degree: Distribution::from_values(polygons.map(|(_, face)| face.len())),
        }
    }

    fn non_manifold_vertices(&self) -> usize {
        let on_edge = &self.edges.on_non_manifold_edge;
        let several = self.fans.several_of(|f| self.is_used(f));
        let others = several.iter().filter(|(v, _)| !on_edge[v.index()]).count();
        others + on_edge.iter().filter(|&&on_edge| on_edge).count()
    }
}

fn components(incidence: &Incidence<'_>) -> usize {
    let mut components = Classes::new(incidence.faces().len());
    for edge in incidence.edges() {
        let first = edge.first().face;
        for side in edge.sides().skip(1) {
            components.join(first.index(), side.face.index());
        }
    }
    components.into_numbers().1
}

fn is_orientable(incidence: &Incidence<'_>) -> bool {
    // For each edge with two faces: whether exactly one of the two faces must be flipped.
    let mut flipped = Partition::new(incidence.faces().len());
    incidence
        .edges()
        .filter_map(|edge| edge.pair())
        .all(|[a, b]| {
            let same = a.downward == b.downward;
            flipped.relate(a.face.index(), b.face.index(), same)
        })
}

/// Returns the number of faces with the same vertices as an earlier face.
fn duplicate_faces(incidence: &Incidence<'_>, used: Option<&[bool]>) -> usize {
    let (vertices, faces) = (incidence.vertex_count(), incidence.faces());
    let is_used = |f: FaceId| used.is_none_or(|used| used[f.index()]);
    let by_lowest = FacesByLowest::new(vertices, faces, is_used);
    let mut corners = Vec::new();
    let mut sets: Vec<Range<usize>> = Vec::new();
    let mut duplicates = 0;
    for listed in by_lowest.several() {
        corners.clear();
        sets.clear();
        for &f in listed {
            let start = corners.len();
            corners.extend_from_slice(faces.face(f));
            corners[start..].sort_unstable();
            sets.push(start..corners.len());
        }
        sets.sort_unstable_by(|a, b| corners[a.clone()].cmp(&corners[b.clone()]));
        let pairs = sets.windows(2);
        let equal = |pair: &&[Range<usize>]| corners[pair[0].clone()] == corners[pair[1].clone()];
        duplicates += pairs.filter(equal).count();
    }
    duplicates
}
