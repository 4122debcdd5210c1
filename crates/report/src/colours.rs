//! Colours that are distinguishable on white and on black, and with colour blindness.
//!
//! Figures are drawn once, in fixed colours. On dark pages, a style sheet replaces these colours,
//! because style rules override the presentation attributes of SVG.

use crate::canvas::PointShape;

pub(crate) const TEXT_COLOUR: &str = "#17181a";
pub(crate) const BACKGROUND: &str = "#fdfdfc";
pub(crate) const FAINT_COLOUR: &str = "#66686c";
pub(crate) const GRID_COLOUR: &str = "#dcdcda";
pub(crate) const INTERVAL_COLOUR: &str = "#33353a";

/// The names of the structures and their colours on light pages and on dark pages, in the order of
/// tables. The colours follow Okabe and Ito (2008).
const STRUCTURES: [(&str, (&str, &str)); 6] = [
    ("polygon-soup", ("#7f7f84", "#a3a3a8")),
    ("indexed-face-set", ("#d98e04", "#f0b13c")),
    ("face-vertex", ("#3f9fd4", "#6cc1f0")),
    ("winged-edge", ("#0a8f66", "#2fc796")),
    ("half-edge", ("#1f6fb0", "#5ba4e6")),
    ("corner-table", ("#c8511b", "#f08553")),
];
/// The name and the colours of relation tables.
const RELATION_TABLES: (&str, (&str, &str)) = ("relation-tables", ("#b0618f", "#dd93bd"));
/// The beginnings of the names of libraries that are often compared, and their colours on light pages and on dark pages.
const LIBRARIES: [(&str, (&str, &str)); 6] = [
    ("lox", ("#6a5acd", "#a094f0")),
    ("openmesh", ("#8c8a1e", "#c9c655")),
    ("cgal", ("#8f3b46", "#d98490")),
    ("pmp", ("#3d7a6e", "#74c4b4")),
    ("opensubdiv", ("#7a4fa0", "#bd97e0")),
    ("geometry-central", ("#7d5a33", "#c9a377")),
];
/// Colours of all other columns on light pages and on dark pages.
const OTHERS: [(&str, &str); 4] = [
    ("#555a60", "#b9bec4"),
    ("#a0522d", "#e09468"),
    ("#4a6b1f", "#9cc464"),
    ("#a03a78", "#e084bd"),
];
/// Colours of the tables of a structure on light pages and on dark pages. Names in the colour of the background are on
/// them. Neighbours in a bar differ in grey, too: every other colour is darker (lighter on dark pages).
const TABLES: [(&str, &str); 8] = [
    ("#1f6f9f", "#5fb0de"),
    ("#6b4500", "#f2c063"),
    ("#1b7a5e", "#43b393"),
    ("#7d3410", "#ffb48c"),
    ("#8d5a8d", "#c48ec4"),
    ("#3c5412", "#a8cc60"),
    ("#4f66a8", "#8f9fd8"),
    ("#4a4a4a", "#c4c4c4"),
];
/// Colours of the orders of the elements on light pages and on dark pages.
const ORDERS: [(&str, &str); 5] = [
    ("#202a6b", "#aab4ff"),
    ("#00838f", "#4dd0d8"),
    ("#ad1457", "#f48fb1"),
    ("#a87900", "#ffd54f"),
    ("#5d4037", "#bcaaa4"),
];

/// Returns the place of the column `name` among all columns, which has its colour and its shape. The name of a structure
/// beyond [`STRUCTURES`], and of an unknown program, chooses one of [`OTHERS`].
fn place_of_column(name: &str) -> usize {
    let known = STRUCTURES.iter().map(|(structure, _)| *structure == name);
    let known = known.chain([name == RELATION_TABLES.0]);
    let libraries = LIBRARIES.iter().map(|(start, _)| name.starts_with(start));
    // Names that differ in one letter, and the programs in benches/external, have different turns.
    let turn = name
        .bytes()
        .map(|byte| usize::from(byte) + 1)
        .sum::<usize>()
        % OTHERS.len();
    let other = STRUCTURES.len() + 1 + LIBRARIES.len() + turn;
    known
        .chain(libraries)
        .position(|is_it| is_it)
        .unwrap_or(other)
}

/// Returns the colours of all columns on light pages and on dark pages.
fn columns() -> impl Iterator<Item = (&'static str, &'static str)> {
    let named = STRUCTURES
        .into_iter()
        .chain([RELATION_TABLES])
        .chain(LIBRARIES);
    named.map(|(_, colours)| colours).chain(OTHERS)
}

/// Returns the colour of the column `name`.
pub(crate) fn column_colour(name: &str) -> &'static str {
    let mut colours = columns().skip(place_of_column(name));
    colours.next().map_or(TEXT_COLOUR, |(light, _)| light)
}

/// Returns the shape of the points of the column `name`. Columns with different colours have different shapes, so that they are
/// told apart in grey.
pub(crate) fn column_shape(name: &str) -> PointShape {
    PointShape::ALL[place_of_column(name)]
}

/// Returns the colour and the shape of the points of an order of the elements.
pub(crate) fn order_mark(number: usize) -> (&'static str, PointShape) {
    let shape = PointShape::ALL[number % PointShape::ALL.len()];
    (ORDERS[number % ORDERS.len()].0, shape)
}

/// Returns the name of each structure with its colours on light pages and on dark pages, as `#rrggbb`.
pub fn structure_colours() -> Vec<(&'static str, &'static str, &'static str)> {
    let colours = STRUCTURES.into_iter();
    colours
        .map(|(name, (light, dark))| (name, light, dark))
        .collect()
}

pub(crate) fn table_colour(number: usize) -> &'static str {
    TABLES[number % TABLES.len()].0
}

pub(crate) fn dark_rules() -> String {
    let page = [
        (TEXT_COLOUR, "#e4e4e2"),
        (BACKGROUND, "#17181a"),
        (FAINT_COLOUR, "#a0a2a6"),
        (GRID_COLOUR, "#3a3b3e"),
        (INTERVAL_COLOUR, "#d0d0ce"),
    ];
    let pairs = page
        .into_iter()
        .chain(columns())
        .chain(TABLES)
        .chain(ORDERS);
    let rule = |(light, dark): (&str, &str)| {
        format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
    };
    pairs.map(rule).collect()
}

/// Returns the contrast of two colours, from 1 to 21, as the guidelines for accessible pages (WCAG 2.2, 2023) define it.
#[cfg(test)]
pub(crate) fn contrast(a: &str, b: &str) -> f64 {
    let luminance = |colour: &str| {
        let part = |from: usize| {
            let value = u8::from_str_radix(&colour[from..from + 2], 16).expect("two digits");
            let value = f64::from(value) / 255.0;
            match value <= 0.04045 {
                true => value / 12.92,
                false => ((value + 0.055) / 1.055).powf(2.4),
            }
        };
        0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5) + 0.05
    };
    let [a, b] = [a, b].map(luminance);
    a.max(b) / a.min(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_and_marks_are_seen_on_light_and_dark_pages() {
        for (light, dark) in TABLES {
            assert!(contrast(light, BACKGROUND) >= 4.5, "{light}");
            assert!(contrast(dark, "#17181a") >= 4.5, "{dark}");
        }
        for (light, dark) in columns().chain(ORDERS) {
            assert!(contrast(light, BACKGROUND) >= 2.4, "{light}");
            assert!(contrast(dark, "#17181a") >= 4.5, "{dark}");
        }
    }

    /// A contrast of 1.25 is seen between areas that touch.
    #[test]
    fn tables_side_by_side_differ_in_grey() {
        let next = TABLES.iter().skip(1).chain(&TABLES[..1]);
        for (one, other) in TABLES.iter().zip(next) {
            assert!(contrast(one.0, other.0) >= 1.25, "{one:?} {other:?}");
            assert!(contrast(one.1, other.1) >= 1.25, "{one:?} {other:?}");
        }
    }

    /// Many of their colours have nearly the same grey.
    #[test]
    fn columns_and_orders_have_shapes_of_their_own() {
        let names = STRUCTURES.into_iter().chain([RELATION_TABLES]);
        let names = names.chain(LIBRARIES).map(|(name, _)| name);
        // One name for each of the other colours.
        let mut shapes: Vec<PointShape> = Vec::new();
        for name in names.chain(["a", "b", "c", "d"]) {
            let shape = column_shape(name);
            assert!(!shapes.contains(&shape), "{name}");
            shapes.push(shape);
        }
        assert_eq!(shapes.len(), columns().count());
        let [alum, parry, tri_mesh] = ["alum", "parry3d", "tri-mesh"].map(column_shape);
        assert!(alum != parry && parry != tri_mesh && tri_mesh != alum);
        for (number, (colour, _)) in ORDERS.into_iter().enumerate() {
            assert_eq!(order_mark(number), (colour, shapes[number]));
        }
    }

    #[test]
    fn all_colours_are_different() {
        let mut all: Vec<&str> = columns().map(|(light, _)| light).collect();
        all.extend(ORDERS.iter().map(|(light, _)| *light));
        all.extend([
            TEXT_COLOUR,
            BACKGROUND,
            FAINT_COLOUR,
            GRID_COLOUR,
            INTERVAL_COLOUR,
        ]);
        all.extend(TABLES.iter().map(|(light, _)| *light));
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        assert!(all.iter().all(|hex| hex.len() == 7 && hex.starts_with('#')));
        let libraries = [
            "lox",
            "openmesh",
            "cgal-surface-mesh",
            "pmp-library",
            "half-edge",
        ];
        let mut colours = libraries.map(column_colour);
        colours.sort_unstable();
        assert!(colours.windows(2).all(|pair| pair[0] != pair[1]));
        let infos = sixfold::structure_infos();
        let names: Vec<&str> = infos.iter().map(|info| info.name).collect();
        assert_eq!(
            names,
            STRUCTURES.map(|(name, _)| name),
            "add the colours of the structure"
        );
    }
}
