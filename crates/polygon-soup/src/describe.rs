//! The records of a polygon soup, as textbooks show them.

use sixfold_core::{
    BuildError, Described, Editing, Element, Field, Line, Probe, RecordTable, Relation, RowName,
};
use sixfold_scanning::algorithm_of;

use crate::mesh::PolygonSoup;

impl<P: Probe, E: Editing> Described for PolygonSoup<E, P> {
    fn tables(&self) -> Vec<RecordTable> {
        self.faces.record_tables()
    }

    fn record(&self, table: &str, row: usize, _walks: bool) -> Option<Vec<Field>> {
        self.faces
            .record(table, row, |v| Field::Point(v.position()))
    }

    /// A vertex has no row: its handle is its position.
    fn rows_of(&self, element: Element<Self>) -> Vec<RowName> {
        match element {
            Element::Vertex(_) | Element::Edge(_) => Vec::new(),
            Element::Face(f) => vec![RowName::new("f", f)],
        }
    }

    fn no_room(refusal: &BuildError) -> Option<String> {
        Some(match refusal {
            BuildError::IsolatedVertex { vertex, .. } => {
                format!(
                    "vertices are stored in the corners of faces only, so {vertex} has no place"
                )
            }
            BuildError::CoincidentCorners { .. } => {
                "a vertex is its position, so the two corners are one vertex".to_owned()
            }
            _ => return None,
        })
    }

    fn algorithm(relation: Relation) -> &'static [Line] {
        algorithm_of(relation)
    }
}
