//! The mesh as flat arrays.

use std::error::Error;
use std::fs;

/// A mesh as flat arrays, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Input {
    /// The position of each vertex.
    pub positions: Vec<[f32; 3]>,
    /// The vertices of all faces, one face after the other.
    pub corners: Vec<u32>,
    /// The index of the first corner of each face. The last entry is the number of corners.
    pub starts: Vec<usize>,
}

impl Input {
    /// Reads the file that Sixfold writes for its columns. It has only lines `v x y z` and `f a b c
    /// …`. General OBJ readers drop isolated vertices, so they cannot be used.
    pub(crate) fn read(path: &str) -> Result<Self, Box<dyn Error>> {
        Self::parse(&fs::read_to_string(path)?)
    }

    fn parse(text: &str) -> Result<Self, Box<dyn Error>> {
        let mut input = Self {
            starts: vec![0],
            ..Self::default()
        };
        for line in text.lines() {
            let mut words = line.split_ascii_whitespace();
            match words.next() {
                Some("v") => {
                    let mut coordinate = || -> Result<f32, Box<dyn Error>> {
                        Ok(words
                            .next()
                            .ok_or("a vertex has fewer than three coordinates")?
                            .parse()?)
                    };
                    input
                        .positions
                        .push([coordinate()?, coordinate()?, coordinate()?]);
                }
                Some("f") => {
                    for word in words {
                        let number: u32 = word.parse()?;
                        let corner = number.checked_sub(1).ok_or("vertex numbers start at 1")?;
                        if corner as usize >= input.positions.len() {
                            return Err(format!("no vertex has the number {number}").into());
                        }
                        input.corners.push(corner);
                    }
                    input.starts.push(input.corners.len());
                }
                _ => {}
            }
        }
        Ok(input)
    }

    /// Returns the vertices of each face.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        let ends = self.starts.windows(2);
        ends.map(|ends| &self.corners[ends[0]..ends[1]])
    }

    /// Returns the vertices of each triangle.
    ///
    /// # Errors
    ///
    /// Returns an error if a face is not a triangle.
    pub fn triangles(&self) -> Result<impl Iterator<Item = [u32; 3]>, String> {
        match self.faces().position(|face| face.len() != 3) {
            Some(face) => Err(format!("face {face} is not a triangle")),
            None => Ok(self.corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn isolated_vertices_are_kept() {
        let input = Input::parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n").expect("a mesh");
        assert_eq!((input.positions.len(), input.faces().count()), (4, 1));
        assert_eq!(input.triangles().expect("one").next(), Some([0, 1, 2]));
        for wrong in ["v 1 2\n", "f 1 2 3\n", "v 0 0 0\nf 0 1 1\n"] {
            assert!(Input::parse(wrong).is_err(), "{wrong}");
        }
    }
}
