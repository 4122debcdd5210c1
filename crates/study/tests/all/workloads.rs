//! Compares every operation on every backend with a plain computation from the list of faces.

use std::collections::{BTreeMap, BTreeSet};

use sixfold::remeshing::{Decimation, Target, decimate};
use sixfold::subdivision::Scheme;
use sixfold::{EditableHalfEdgeMesh, Point, PolygonMesh, Relation, Representation, shapes};
use sixfold_conformance::edit::{Action, Model, Rules};
use sixfold_study::{Backend, BackendRunner, EditPass, MachineClock, Operation, SubdivisionJob};

struct Oracle<'a> {
    mesh: &'a PolygonMesh,
    faces: Vec<Vec<usize>>,
    /// The faces of each edge. The lower end of the edge comes first.
    edges: BTreeMap<[usize; 2], BTreeSet<usize>>,
}

impl<'a> Oracle<'a> {
    fn new(mesh: &'a PolygonMesh) -> Self {
        let corners = |face: &[sixfold::VertexId]| face.iter().map(|v| v.index()).collect();
        let faces: Vec<Vec<usize>> = mesh.faces().iter().map(|(_, f)| corners(f)).collect();
        let mut edges: BTreeMap<_, BTreeSet<usize>> = BTreeMap::new();
        for (f, face) in faces.iter().enumerate() {
            for i in 0..face.len() {
                let (a, b) = (face[i], face[(i + 1) % face.len()]);
                edges.entry([a.min(b), a.max(b)]).or_default().insert(f);
            }
        }
        Self { mesh, faces, edges }
    }

    fn at(&self, vertex: usize) -> [f64; 3] {
        self.mesh.positions()[vertex].to_array().map(f64::from)
    }

    fn neighbours(&self) -> Vec<BTreeSet<usize>> {
        let mut sets = vec![BTreeSet::new(); self.mesh.vertex_count()];
        for &[a, b] in self.edges.keys() {
            sets[a].insert(b);
            sets[b].insert(a);
        }
        sets
    }

    fn adjacent_faces(&self) -> Vec<BTreeSet<usize>> {
        let mut sets = vec![BTreeSet::new(); self.faces.len()];
        for faces in self.edges.values() {
            for &f in faces {
                sets[f].extend(faces.iter().filter(|&&g| g != f));
            }
        }
        sets
    }

    fn relation(&self, relation: Relation) -> usize {
        let corners = self.mesh.corner_count();
        let valences = self.neighbours().into_iter().map(|set| set.len());
        match relation {
            Relation::VertexVertices | Relation::VertexEdges | Relation::EdgeVertices => {
                2 * self.edges.len()
            }
            Relation::VertexFaces | Relation::FaceVertices | Relation::FaceEdges => corners,
            Relation::EdgeEdges => valences.map(|n| n * n.saturating_sub(1)).sum(),
            Relation::EdgeFaces => self.edges.values().map(BTreeSet::len).sum(),
            Relation::FaceFaces => self.adjacent_faces().iter().map(BTreeSet::len).sum(),
        }
    }

    fn mean(&self, vertices: impl Iterator<Item = usize> + Clone) -> [f64; 3] {
        let count = vertices.clone().count() as f64;
        let sum = vertices.fold([0.0; 3], |sum, v| add(sum, self.at(v)));
        sum.map(|x| x / count)
    }

    fn face_normal(&self, face: &[usize]) -> [f64; 3] {
        let first = self.at(face[0]);
        let spokes: Vec<[f64; 3]> = face[1..].iter().map(|&v| sub(self.at(v), first)).collect();
        spokes.windows(2).fold([0.0; 3], |sum, pair| {
            let ([a, b, c], [x, y, z]) = (pair[0], pair[1]);
            add(sum, [b * z - c * y, c * x - a * z, a * y - b * x])
        })
    }

    fn vertex_normals(&self) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; self.mesh.vertex_count()];
        for face in &self.faces {
            let normal = self.face_normal(face);
            for &v in face {
                sums[v] = add(sums[v], normal);
            }
        }
        let unit = |n: [f64; 3]| {
            let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
            n.map(|x| x / length)
        };
        sums.into_iter().map(unit).collect()
    }

    fn depths(&self) -> usize {
        let adjacent = self.adjacent_faces();
        let mut depths = vec![None; self.faces.len()];
        while let Some(seed) = depths.iter().position(Option::is_none) {
            depths[seed] = Some(0);
            let (mut ring, mut depth) = (BTreeSet::from([seed]), 0);
            while !ring.is_empty() {
                depth += 1;
                let next: BTreeSet<usize> =
                    ring.iter().flat_map(|&f| &adjacent[f]).copied().collect();
                ring = next.into_iter().filter(|&f| depths[f].is_none()).collect();
                ring.iter().for_each(|&f| depths[f] = Some(depth));
            }
        }
        depths.into_iter().flatten().sum()
    }

    /// Returns the points after one step of the published rules. The boundary becomes a cubic
    /// B-spline. A vertex with a single face keeps its position.
    fn refined(&self, scheme: Scheme) -> Vec<[f64; 3]> {
        let quads = scheme == Scheme::CatmullClark;
        let centre = |f: &usize| self.mean(self.faces[*f].iter().copied());
        let mut points = Vec::new();
        if quads {
            points.extend((0..self.faces.len()).map(|f| centre(&f)));
        }
        for (&[a, b], faces) in &self.edges {
            let middle = self.mean([a, b].into_iter());
            let far = |f: &usize| {
                let mut corners = self.faces[*f].iter().copied();
                self.at(corners
                    .find(|v| ![a, b].contains(v))
                    .expect("three corners"))
            };
            points.push(match (faces.len(), quads) {
                (2, true) => mix([(0.5, middle), (0.5, mean_of(faces.iter().map(centre)))]),
                (2, false) => mix([(0.75, middle), (0.25, mean_of(faces.iter().map(far)))]),
                _ => middle,
            });
        }
        for (v, ring) in self.neighbours().into_iter().enumerate() {
            let at = self.at(v);
            let around: Vec<usize> = (0..self.faces.len())
                .filter(|&f| self.faces[f].contains(&v))
                .collect();
            let n = ring.len() as f64;
            let rim = ring.iter().copied();
            let rim = rim.filter(|&w| self.edges[&[v.min(w), v.max(w)]].len() == 1);
            let rim: Vec<usize> = rim.collect();
            let ring_mean = self.mean(ring.iter().copied());
            points.push(match (rim.len(), quads) {
                (0, true) => {
                    let faces = mean_of(around.iter().map(centre));
                    mix([(1.0 - 2.0 / n, at), (1.0 / n, ring_mean), (1.0 / n, faces)])
                }
                (0, false) => {
                    let turn = 3.0 / 8.0 + (std::f64::consts::TAU / n).cos() / 4.0;
                    let weight = 5.0 / 8.0 - turn * turn;
                    mix([(1.0 - weight, at), (weight, ring_mean)])
                }
                _ if around.len() == 1 => at,
                _ => mix([(0.75, at), (0.25, self.mean(rim.into_iter()))]),
            });
        }
        points
    }

    fn checksum(&self, operation: Operation) -> f64 {
        let boundary = self.edges.values().filter(|faces| faces.len() == 1);
        let length = |&[a, b]: &[usize; 2]| {
            let d = sub(self.at(a), self.at(b));
            d.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        let all = || {
            Relation::ALL
                .map(|r| self.relation(r))
                .into_iter()
                .sum::<usize>() as f64
        };
        match operation {
            Operation::Build => (self.mesh.vertex_count() + self.faces.len()) as f64,
            Operation::Relation(relation) => self.relation(relation) as f64,
            Operation::Circulate => 2.0 * self.mesh.corner_count() as f64,
            Operation::FaceBarycenter => {
                field(self.faces.iter().map(|f| self.mean(f.iter().copied())))
            }
            Operation::VertexNormal => field(self.vertex_normals().into_iter()),
            Operation::VvSmooth => {
                let sets = self.neighbours();
                field(sets.iter().map(|set| self.mean(set.iter().copied())))
            }
            Operation::EdgeLength => self.edges.keys().map(length).sum(),
            Operation::Boundary => boundary.count() as f64,
            Operation::FfBfs => self.depths() as f64,
            Operation::AllQueries => all(),
            Operation::CatmullClark(_) => field(self.refined(Scheme::CatmullClark).into_iter()),
            Operation::Loop(_) => field(self.refined(Scheme::Loop).into_iter()),
            Operation::EditPass(EditPass::SplitCollapse) => self.edges.keys().map(length).sum(),
            Operation::EditPass(EditPass::FlipAll) => self.flipped(),
            Operation::EditPass(EditPass::DecimateHalf) => self.decimated(0.5),
            Operation::EditPass(EditPass::DecimateTenth) => self.decimated(0.1),
        }
    }

    /// Flips every edge twice in the model of `sixfold-conformance`. Returns the sum of the edge
    /// lengths.
    fn flipped(&self) -> f64 {
        let mut model = Model::from_polygons(self.mesh);
        let rules = Rules::new::<EditableHalfEdgeMesh>();
        let mut edges: Vec<[usize; 2]> = Vec::new();
        for face in &self.faces {
            for (i, &a) in face.iter().enumerate() {
                let b = face[(i + 1) % face.len()];
                let edge = [a.min(b), a.max(b)];
                if !edges.contains(&edge) {
                    edges.push(edge);
                }
            }
        }
        for _ in 0..2 {
            for edge in &mut edges {
                let faces = model.edges().remove(edge).expect("an edge of the model");
                let corners = faces.iter().filter_map(|&(f, _)| model.face(f)).flatten();
                let apexes: Vec<usize> = corners.copied().filter(|v| !edge.contains(v)).collect();
                if let Some(after) = model.after(&Action::FlipEdge { e: *edge }, &rules) {
                    model = after;
                    *edge = [apexes[0].min(apexes[1]), apexes[0].max(apexes[1])];
                }
            }
        }
        Oracle::new(&model.to_polygons()).checksum(Operation::EdgeLength)
    }

    fn decimated(&self, ratio: f64) -> f64 {
        let mut mesh = EditableHalfEdgeMesh::from_polygons(self.mesh).expect("a manifold");
        let to = Decimation {
            target: Target::Ratio(ratio),
            ..Decimation::default()
        };
        decimate(&mut mesh, &to).expect("triangles");
        Oracle::new(&mesh.to_polygons()).checksum(Operation::EdgeLength)
    }

    fn elements(&self, operation: Operation) -> usize {
        if operation == Operation::EditPass(EditPass::FlipAll) {
            return 2 * self.edges.len();
        }
        match operation.unit() {
            "vertex" => self.mesh.vertex_count(),
            "edge" => self.edges.len(),
            "face" => self.faces.len(),
            "new face" => match operation {
                Operation::Loop(_) => 4 * self.faces.len(),
                _ => self.mesh.corner_count(),
            },
            _ => self.checksum(operation) as usize,
        }
    }
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn mix<const N: usize>(terms: [(f64, [f64; 3]); N]) -> [f64; 3] {
    let weighed = terms.map(|(weight, point)| point.map(|x| weight * x));
    weighed.into_iter().fold([0.0; 3], add)
}

fn mean_of(points: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    let points: Vec<_> = points.collect();
    let weight = 1.0 / points.len() as f64;
    points.into_iter().fold([0.0; 3], add).map(|x| weight * x)
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn field(vectors: impl Iterator<Item = [f64; 3]>) -> f64 {
    vectors
        .map(|[x, y, z]| x.abs() + 2.0 * y.abs() + 3.0 * z.abs())
        .sum()
}

fn patchwork() -> PolygonMesh {
    let at = |x: f32, y: f32| Point::new(x, y, 0.3 * x * y - 0.1 * x);
    let positions = vec![
        at(0.0, 0.0),
        at(2.0, 0.1),
        at(2.2, 1.7),
        at(0.3, 2.0),
        at(3.5, 0.8),
        at(-1.0, 1.0),
        at(-0.8, 3.0),
        at(1.0, 3.5),
        at(8.0, 8.0),
        at(9.0, 8.5),
        at(8.5, 9.5),
    ];
    let faces: [&[u32]; 4] = [&[0, 1, 2, 3], &[1, 4, 2], &[5, 0, 3, 2, 7, 6], &[8, 9, 10]];
    PolygonMesh::new(positions, faces).expect("valid")
}

/// Returns whether the operation can run on this backend and mesh.
fn can_run(operation: Operation, backend: &Backend, mesh: &PolygonMesh) -> bool {
    let Some(job) = SubdivisionJob::of(operation) else {
        return !operation.creates_mesh() || mesh.faces().uniform_degree() == Some(3);
    };
    let scheme = job.subdivision.scheme;
    let row = backend.info.support(scheme);
    let accepts_degrees = scheme != Scheme::Loop || mesh.faces().uniform_degree() == Some(3);
    accepts_degrees && row.holds_result && row.methods.contains(&job.way.method())
}

#[test]
fn operations_agree_with_the_face_list() {
    let meshes = [
        ("patchwork", patchwork()),
        ("icosahedron", shapes::icosahedron()),
        ("torus", shapes::torus(7, 5).expect("a torus")),
        ("grid", shapes::triangle_grid(6, 4).expect("a grid")),
    ];
    for (name, mesh) in &meshes {
        let oracle = Oracle::new(mesh);
        for backend in Backend::structures() {
            if backend.info.check(mesh).is_err() {
                continue;
            }
            let mut runner = BackendRunner::new(&backend, mesh).expect("it can hold the mesh");
            for operation in Operation::ALL {
                let run = runner.run(operation, &MachineClock::start());
                if !can_run(operation, &backend, mesh) {
                    assert!(run.checksum.is_nan() && run.elements == 0, "{run:?}");
                    continue;
                }
                let expected = oracle.checksum(operation);
                let near = (run.checksum - expected).abs() <= 1e-5 * expected.abs();
                let context = format!("{operation} of {name} on {}", backend.name());
                assert!(near, "{context}: {}, expected {expected}", run.checksum);
                assert_eq!(
                    run.elements as usize,
                    oracle.elements(operation),
                    "{context}"
                );
            }
        }
    }
}
