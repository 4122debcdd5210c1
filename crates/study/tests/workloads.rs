//! Every operation on every backend against a plain computation from the list of faces.

use std::collections::{BTreeMap, BTreeSet};

use sixfold::{Point, PolygonMesh, Relation, roster, shapes};
use study::{MachineClock, Operation, Solo};

/// What the operations should find, worked out slowly.
struct Oracle<'a> {
    mesh: &'a PolygonMesh,
    faces: Vec<Vec<usize>>,
    /// By edge, lower end first: its faces.
    edges: BTreeMap<[usize; 2], BTreeSet<usize>>,
}

impl<'a> Oracle<'a> {
    fn of(mesh: &'a PolygonMesh) -> Self {
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

    /// By vertex: its neighbours.
    fn neighbours(&self) -> Vec<BTreeSet<usize>> {
        let mut sets = vec![BTreeSet::new(); self.mesh.vertex_count()];
        for &[a, b] in self.edges.keys() {
            sets[a].insert(b);
            sets[b].insert(a);
        }
        sets
    }

    /// By face: those that share an edge.
    fn beside(&self) -> Vec<BTreeSet<usize>> {
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
            Relation::FaceFaces => self.beside().iter().map(BTreeSet::len).sum(),
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
        let beside = self.beside();
        let mut depths = vec![None; self.faces.len()];
        while let Some(seed) = depths.iter().position(Option::is_none) {
            depths[seed] = Some(0);
            let (mut ring, mut depth) = (BTreeSet::from([seed]), 0);
            while !ring.is_empty() {
                depth += 1;
                let next: BTreeSet<usize> =
                    ring.iter().flat_map(|&f| &beside[f]).copied().collect();
                ring = next.into_iter().filter(|&f| depths[f].is_none()).collect();
                ring.iter().for_each(|&f| depths[f] = Some(depth));
            }
        }
        depths.into_iter().flatten().sum()
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
        }
    }

    fn elements(&self, operation: Operation) -> usize {
        match operation.per() {
            "vertex" => self.mesh.vertex_count(),
            "edge" => self.edges.len(),
            "face" => self.faces.len(),
            _ => self.checksum(operation) as usize,
        }
    }
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn field(vectors: impl Iterator<Item = [f64; 3]>) -> f64 {
    vectors
        .map(|[x, y, z]| x.abs() + 2.0 * y.abs() + 3.0 * z.abs())
        .sum()
}

/// A mesh with a boundary, faces of three to six corners, and two components.
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

#[test]
fn operations_find_what_the_face_list_says() {
    let meshes = [
        ("patchwork", patchwork()),
        ("icosahedron", shapes::icosahedron()),
        ("torus", shapes::torus(7, 5).expect("a torus")),
        ("grid", shapes::triangle_grid(6, 4).expect("a grid")),
    ];
    for (name, mesh) in &meshes {
        let oracle = Oracle::of(mesh);
        for backend in roster() {
            if backend.verdict(mesh).is_err() {
                continue;
            }
            let mut solo = Solo::new(backend.name, mesh).expect("it can hold it");
            for operation in Operation::ALL {
                let run = solo.run(operation, &MachineClock::start());
                let expected = oracle.checksum(operation);
                let near = (run.checksum - expected).abs() <= 1e-5 * expected.abs();
                let context = format!("{operation} of {name} on {}", backend.name);
                assert!(near, "{context}: {} for {expected}", run.checksum);
                assert_eq!(
                    run.elements as usize,
                    oracle.elements(operation),
                    "{context}"
                );
            }
        }
    }
}
