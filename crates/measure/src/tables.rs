//! Flat tables of relations, as they are measured.

use std::hint::black_box;

use sixfold::{PolygonMesh, Relation, Representation};
use sixfold_relation_table::RelationTables;

use crate::series::{Series, time_making};
use sixfold_results::Time;

/// The name of the tables in rankings.
pub const TABLES: &str = "relation-tables";
/// The path of their type.
pub const TABLE_TYPE: &str = "sixfold_relation_table::RelationTables";

/// Builds the structure and the tables, and returns the time. The tables are dropped outside the
/// timing.
pub fn time_building<M: Representation>(
    polygons: &PolygonMesh,
    relations: &[Relation],
    bytes: usize,
    series: &Series<'_>,
) -> Time {
    let build = || {
        let mesh = M::from_polygons(black_box(polygons)).ok();
        mesh.map(|mesh| RelationTables::new(&mesh, relations))
    };
    time_making(series, bytes, build).0
}
