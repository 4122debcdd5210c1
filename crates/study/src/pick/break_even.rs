//! From how many operations on a structure pays for being built.

use crate::pick::answer::{BreakEven, Ranked};
use crate::pick::entrant::Entrant;
use crate::statistics::Median;

/// What a program has when it begins: positions and index lists.
const BASE: &str = "indexed-face-set";

/// For each entrant, beside an indexed face set that need not be built: after n operations the time
/// saved is that of building, n = build / (t_base − t). Differences are formed within rounds, and the
/// interval of n is that of the median difference. `operations` is what one use comes to.
pub(crate) fn break_even(
    entrants: &[&Entrant<'_>],
    ranking: &[Ranked],
    operations: f64,
) -> Vec<BreakEven> {
    let Some(base) = entrants.iter().find(|e| e.mixer.name() == BASE) else {
        return Vec::new();
    };
    let row = |ranked: &Ranked| {
        let entrant = entrants.iter().find(|e| e.mixer.name() == ranked.backend)?;
        let saved = entrant.samples.iter().filter_map(|(round, time)| {
            let base = base.samples.iter().find(|(r, _)| r == round)?;
            Some(base.1.ns() - time.ns())
        });
        let saved = Median::of(saved)?;
        let build = if ranked.backend == BASE {
            0.0
        } else {
            ranked.first_build_ns()
        };
        let after = |ns: f64| (ns > 0.0).then(|| build / ns);
        let pays = after(saved.value);
        Some(BreakEven {
            backend: ranked.backend.clone(),
            build_ns: ranked.first_build_ns(),
            saves_ns_per_operation: saved.value,
            operations: pays,
            ci_low: saved.interval.and_then(|[_, high]| after(high)),
            ci_high: saved.interval.and_then(|[low, _]| after(low)),
            uses: pays.map(|pays| pays / operations),
        })
    };
    { ranking.iter().filter(|ranked| ranked.backend != BASE) }
        .filter_map(row)
        .collect()
}
