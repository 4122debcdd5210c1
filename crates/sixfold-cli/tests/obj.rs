//! Reads an OBJ file without Sixfold.

use std::collections::BTreeMap;

pub(crate) struct Obj {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) faces: Vec<Vec<usize>>,
}

impl Obj {
    pub(crate) fn parse(text: &str) -> Self {
        let rows = |kind: &str| {
            let of_kind = move |line: &str| Some(line.strip_prefix(kind)?.trim().to_owned());
            text.lines().filter_map(of_kind).collect::<Vec<_>>()
        };
        let position = |row: &String| {
            let numbers: Vec<f32> = row
                .split(' ')
                .map(|x| x.parse().expect("a number"))
                .collect();
            numbers.try_into().expect("three coordinates")
        };
        let corner = |word: &str| word.split('/').next().expect("a vertex").parse();
        let face = |row: &String| {
            row.split(' ')
                .map(|word| corner(word).expect("a row"))
                .collect()
        };
        Self {
            positions: rows("v ").iter().map(position).collect(),
            faces: rows("f ").iter().map(face).collect(),
        }
    }

    pub(crate) fn counts(&self) -> [usize; 2] {
        [self.positions.len(), self.faces.len()]
    }

    /// Counts the edges with one face.
    pub(crate) fn boundary_edges(&self) -> usize {
        self.edges().values().filter(|&&faces| faces == 1).count()
    }

    pub(crate) fn euler_characteristic(&self) -> isize {
        let [vertices, faces] = self.counts().map(usize::cast_signed);
        vertices - self.edges().len().cast_signed() + faces
    }

    pub(crate) fn lengths(&self) -> Vec<f32> {
        let at = |v: usize| self.positions[v - 1];
        let length = |(a, b): (usize, usize)| {
            let squares = [0, 1, 2].map(|i| (at(a)[i] - at(b)[i]).powi(2));
            squares.iter().sum::<f32>().sqrt()
        };
        self.edges().into_keys().map(length).collect()
    }

    /// Returns the positions of the corners of each face. The result does not depend on the
    /// numbering of the vertices: each face starts at its smallest corner, and the faces are
    /// sorted.
    pub(crate) fn canonical_faces(&self) -> Vec<Vec<[u32; 3]>> {
        let faces = self.faces.iter().map(|face| {
            let bits = |&v: &usize| self.positions[v - 1].map(f32::to_bits);
            let mut corners: Vec<[u32; 3]> = face.iter().map(bits).collect();
            let least = (0..corners.len()).min_by_key(|&i| corners[i]);
            corners.rotate_left(least.unwrap_or(0));
            corners
        });
        let mut faces: Vec<_> = faces.collect();
        faces.sort_unstable();
        faces
    }

    /// Returns the ends of each edge, the lower end first, with the number of its faces.
    fn edges(&self) -> BTreeMap<(usize, usize), usize> {
        let mut uses = BTreeMap::new();
        for face in &self.faces {
            for (i, &a) in face.iter().enumerate() {
                let b = face[(i + 1) % face.len()];
                *uses.entry((a.min(b), a.max(b))).or_insert(0) += 1;
            }
        }
        uses
    }
}
