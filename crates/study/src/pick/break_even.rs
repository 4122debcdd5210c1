//! The number of operations after which building a structure has paid off.

use crate::pick::backend::PickBackend;
use crate::pick::report::{BreakEven, Ranked};
use crate::statistics::Median;

/// The structure that a program has from the start.
const BASE: &str = "indexed-face-set";

/// Returns the break-even of each backend, compared with an existing indexed face set. The
/// break-even is at n = build / (t_base − t) operations, when the saved time equals the building
/// time. Time differences are formed within rounds. The interval of n follows from the interval of
/// the median difference. `operations` is the number of operations in one use.
pub(crate) fn break_even(
    backends: &[&PickBackend<'_>],
    ranking: &[Ranked],
    operations: f64,
) -> Vec<BreakEven> {
    let Some(base) = backends.iter().find(|b| b.mixer.name() == BASE) else {
        return Vec::new();
    };
    let row = |ranked: &Ranked| {
        let backend = backends.iter().find(|b| b.mixer.name() == ranked.backend)?;
        let saved = backend.samples.iter().filter_map(|(round, time)| {
            let base = base.samples.iter().find(|(r, _)| r == round)?;
            Some(base.1.ns() - time.ns())
        });
        let saved = Median::from_samples(saved)?;
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
    ranking
        .iter()
        .filter(|ranked| ranked.backend != BASE)
        .filter_map(row)
        .collect()
}
