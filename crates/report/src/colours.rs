//! Colours that can be told apart on white and on black, and by eyes that see fewer of them.
//!
//! Figures are drawn once, in fixed colours; a style sheet maps these to others where the page is
//! dark. Presentation attributes of SVG give way to style rules, so that `[fill="#17181a"]` in a rule is
//! all it takes.

/// Letters and axes.
pub(crate) const INK: &str = "#17181a";
/// What lies behind.
pub(crate) const PAPER: &str = "#fdfdfc";
/// Lines to read values by.
pub(crate) const GRID: &str = "#dcdcda";
/// Intervals over bars.
pub(crate) const WHISKER: &str = "#33353a";

/// Of columns: after Okabe and Ito (2008), who chose them for all kinds of eyes; a lighter one each for
/// dark pages.
const COLUMNS: [(&str, &str, &str); 7] = [
    ("polygon-soup", "#7f7f84", "#a3a3a8"),
    ("indexed-face-set", "#d98e04", "#f0b13c"),
    ("face-vertex", "#3f9fd4", "#6cc1f0"),
    ("winged-edge", "#0a8f66", "#2fc796"),
    ("half-edge", "#1f6fb0", "#5ba4e6"),
    ("corner-table", "#c8511b", "#f08553"),
    ("relation-tables", "#b0618f", "#dd93bd"),
];
/// Of columns that are none of ours, in turn.
const OTHERS: [(&str, &str); 3] = [
    ("#6a5acd", "#a094f0"),
    ("#8c8a1e", "#c9c655"),
    ("#555a60", "#b9bec4"),
];
/// Of tables within a structure, in turn.
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

/// The colour of a column.
pub(crate) fn of_column(name: &str) -> &'static str {
    let ours = COLUMNS.iter().find(|(column, ..)| *column == name);
    let other = || {
        let turn = name.bytes().map(usize::from).sum::<usize>() % OTHERS.len();
        OTHERS[turn].0
    };
    ours.map_or_else(other, |(_, light, _)| light)
}

/// The colour of the so-manieth kind of table.
pub(crate) fn of_table(number: usize) -> &'static str {
    TABLES[number % TABLES.len()].0
}

/// The rules that turn a figure dark.
pub(crate) fn dark_rules() -> String {
    let page = [
        (INK, "#e4e4e2"),
        (PAPER, "#17181a"),
        (GRID, "#3a3b3e"),
        (WHISKER, "#d0d0ce"),
    ];
    let columns = COLUMNS.iter().map(|&(_, light, dark)| (light, dark));
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
    fn no_two_colours_of_one_figure_are_the_same() {
        let mut all: Vec<&str> = COLUMNS.iter().map(|(_, light, _)| *light).collect();
        all.extend(OTHERS.iter().map(|(light, _)| *light));
        all.extend([INK, PAPER, GRID, WHISKER]);
        all.extend(TABLES.iter().map(|(light, _)| *light));
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        assert!(all.iter().all(|hex| hex.len() == 7 && hex.starts_with('#')));
        assert_ne!(of_column("half-edge"), of_column("lox"));
    }
}
