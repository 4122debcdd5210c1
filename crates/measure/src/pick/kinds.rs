//! The backends on which a program has the same result.

use sixfold_results::{OnMesh, PickReport, Ranked};

use crate::engine::agreement::is_same_result;
use crate::job::Outcome;

/// Groups the backends whose results of a program agree: the same number of elements, and the same checksum up to
/// rounding. The largest group is first; of groups of one size, the one with the faster backend. Backends without a result
/// are left out.
pub fn kinds(ranking: &[Ranked]) -> Vec<Vec<&Ranked>> {
    let mut kinds: Vec<Vec<&Ranked>> = Vec::new();
    for ranked in ranking.iter().filter(|ranked| ranked.result.is_some()) {
        match kinds.iter_mut().find(|kind| agree(kind[0], ranked)) {
            Some(kind) => kind.push(ranked),
            None => kinds.push(vec![ranked]),
        }
    }
    kinds.sort_by_key(|kind| std::cmp::Reverse(kind.len()));
    kinds
}

fn agree(a: &Ranked, b: &Ranked) -> bool {
    let outcome =
        |ranked: &Ranked| Some(Outcome::new(ranked.result?, ranked.elements.unwrap_or(0)));
    outcome(a)
        .zip(outcome(b))
        .is_some_and(|(a, b)| is_same_result(&a, &b))
}

/// Returns the first mesh on which a program has different results, and the groups of [`kinds`] there.
pub fn different_results(report: &PickReport) -> Option<(OnMesh<'_>, Vec<Vec<&Ranked>>)> {
    let on_meshes = report.on_meshes().into_iter();
    let mut kinds = on_meshes.map(|on_mesh| (on_mesh, kinds(on_mesh.ranking)));
    kinds.find(|(_, kinds)| kinds.len() > 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pick::choice::tests::ranked;

    #[test]
    fn results_that_agree_are_one_kind_and_the_largest_is_first() {
        let row = |name: &str, result: f64, elements: u64| Ranked {
            result: Some(result),
            elements: Some(elements),
            ..ranked(name, 1.0, false, 1, [1.0; 2])
        };
        let rows = [
            row("a", 1.0, 5),
            row("b", 2.0, 5),
            row("c", 3.0, 5),
            row("d", 2.0 + 1e-5, 5),
            row("e", 2.0, 6),
            row("f", 3.0, 5),
            Ranked {
                result: None,
                ..ranked("g", 1.0, false, 1, [1.0; 2])
            },
        ];
        let found = kinds(&rows);
        let names = found
            .iter()
            .map(|kind| kind.iter().map(|r| &*r.backend).collect());
        let names: Vec<String> = names.collect();
        assert_eq!(names, ["bd", "cf", "a", "e"]);
    }
}
