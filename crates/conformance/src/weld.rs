//! The conversion of a mesh for structures that identify a vertex by its coordinates.

use std::collections::BTreeMap;

use sixfold_core::{Point, PolygonError, PolygonMesh, VertexId};

/// Merges vertices with equal positions. The new vertices are numbered in the order in which faces
/// first use them.
///
/// The coordinates −0 and 0 are equal. Isolated vertices are dropped.
///
/// # Errors
///
/// Returns [`PolygonError::RepeatedVertex`] if two corners of one face have equal positions.
pub fn welded(polygons: &PolygonMesh) -> Result<PolygonMesh, PolygonError> {
    let numbers = weld_numbers(polygons);
    let mut positions = vec![Point::ZERO; numbers.values().max().map_or(0, |n| *n as usize + 1)];
    for (&v, &number) in &numbers {
        positions[number as usize] = polygons.position(v);
    }
    let faces = polygons.faces().iter().map(|(_, corners)| {
        let welded = corners.iter().map(|v| numbers[v]);
        welded.collect::<Vec<u32>>()
    });
    PolygonMesh::new(positions, faces)
}

/// Returns the new number of each vertex with a face.
pub(crate) fn weld_numbers(polygons: &PolygonMesh) -> BTreeMap<VertexId, u32> {
    let mut number_at: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let mut numbers = BTreeMap::new();
    for &v in polygons.faces().corners() {
        let next = number_at.len() as u32;
        let number = *number_at
            .entry(position_key(polygons.position(v)))
            .or_insert(next);
        numbers.insert(v, number);
    }
    numbers
}

/// Returns the bits of the coordinates, with −0 as 0.
pub(crate) fn position_key(point: Point) -> [u32; 3] {
    let bits = |x: f32| if x == 0.0 { 0 } else { x.to_bits() };
    point.to_array().map(bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_with_equal_positions_are_merged_in_order_of_first_use() {
        let negative_zero = Point::new(-0.0, 0.0, 0.0);
        let points = [Point::Y, Point::ZERO, Point::X, negative_zero, Point::Z];
        let mesh = PolygonMesh::new(points, [[2, 1, 0], [4, 0, 3]]).expect("valid");
        let merged = welded(&mesh).expect("no face has two corners with equal positions");
        let expected = PolygonMesh::new(
            [Point::X, Point::ZERO, Point::Y, Point::Z],
            [[0, 1, 2], [3, 2, 1]],
        );
        assert_eq!(Ok(merged), expected);
        let flat = PolygonMesh::new(points, [[1, 3, 0]]).expect("valid");
        assert!(welded(&flat).is_err());
    }
}
