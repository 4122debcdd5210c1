//! The laws of `conformance`, on this structure.

conformance::suite!(polygon_soup::PolygonSoup);
conformance::edit_suite!(polygon_soup::EditablePolygonSoup);
