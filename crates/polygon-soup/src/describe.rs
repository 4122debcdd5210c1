//! The records of a polygon soup, as textbooks show them.

use sixfold_core::{Described, Editing, Field, Probe, RecordTable};

use crate::mesh::PolygonSoup;

impl<P: Probe, E: Editing> Described for PolygonSoup<E, P> {
    fn tables(&self) -> Vec<RecordTable> {
        self.faces.record_tables()
    }

    fn record(&self, table: &str, row: usize) -> Option<Vec<Field>> {
        self.faces
            .record(table, row, |v| Field::Point(v.position()))
    }
}
