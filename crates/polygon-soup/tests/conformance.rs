//! The conformance tests for the polygon soup.

sixfold_conformance::suite!(sixfold_polygon_soup::PolygonSoup);
sixfold_conformance::edit_suite!(sixfold_polygon_soup::EditablePolygonSoup);
