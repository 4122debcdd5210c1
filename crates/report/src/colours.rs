//! Colours that are distinguishable on white and on black, and with colour blindness.
//!
//! Figures are drawn once, in fixed colours. On dark pages, a style sheet replaces these colours,
//! because style rules override the presentation attributes of SVG.

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
/// Colours of all other columns on light pages and on dark pages.
const OTHERS: [(&str, &str); 3] = [
    ("#6a5acd", "#a094f0"),
    ("#8c8a1e", "#c9c655"),
    ("#555a60", "#b9bec4"),
];
/// Colours of the tables of a structure on light pages and on dark pages.
const TABLES: [(&str, &str); 8] = [
    ("#1f6f9f", "#5fb0de"),
    ("#e0a030", "#f2c063"),
    ("#2f9f7f", "#5fd0b0"),
    ("#c05f30", "#ef9060"),
    ("#9f6f9f", "#d09fd0"),
    ("#6f8f2f", "#a8cc60"),
    ("#4f5f8f", "#8f9fd8"),
    ("#8f8f8f", "#bcbcbc"),
];

/// Returns the colour of the column `name`. A structure beyond [`STRUCTURES`], and an external
/// program, gets one of [`OTHERS`], chosen by its name.
pub(crate) fn column_colour(name: &str) -> &'static str {
    let mut known = STRUCTURES.into_iter().chain([RELATION_TABLES]);
    let known = known.find(|(column, _)| *column == name);
    let turn = name.bytes().map(usize::from).sum::<usize>() % OTHERS.len();
    known.map_or(OTHERS[turn], |(_, colours)| colours).0
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
    let named = STRUCTURES.into_iter().chain([RELATION_TABLES]);
    let columns = named.map(|(_, colours)| colours);
    let pairs = page.into_iter().chain(columns).chain(OTHERS).chain(TABLES);
    let rule = |(light, dark): (&str, &str)| {
        format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
    };
    pairs.map(rule).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_colours_are_different() {
        let mut all: Vec<&str> = STRUCTURES.iter().map(|(_, (light, _))| *light).collect();
        all.push(RELATION_TABLES.1.0);
        all.extend(OTHERS.iter().map(|(light, _)| *light));
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
        assert_ne!(column_colour("half-edge"), column_colour("lox"));
        let infos = sixfold::structure_infos();
        let names: Vec<&str> = infos.iter().map(|info| info.name).collect();
        assert_eq!(
            names,
            STRUCTURES.map(|(name, _)| name),
            "add the colours of the structure"
        );
    }
}
