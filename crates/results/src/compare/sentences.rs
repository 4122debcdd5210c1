//! Describes the changes between two documents in sentences.

use super::{Changes, Measurement, Verdict};
use crate::numbers::{counted, times};
use crate::statistics::median;

impl Changes {
    /// Returns sentences that describe the changes.
    pub(super) fn describe(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        if self.rows.is_empty() {
            return vec![match self.bytes.len() {
                0 => "The files have the same counts of bytes.".into(),
                different => format!(
                    "{} between the two files.",
                    counted(
                        different,
                        "count of bytes differs",
                        "counts of bytes differ"
                    )
                ),
            }];
        }
        let verdicts: Vec<Verdict> = self.rows.iter().map(|row| row.verdict).collect();
        sentences.push(format!(
            "Of {}, {}.",
            counted(verdicts.len(), "measurement", "measurements"),
            verdict_counts(&verdicts, "in the second file"),
        ));
        sentences.extend(self.what_would_tell());
        if let Some(overall) = self.overall.filter(|o| o.max(o.recip()) > self.noise) {
            let machines = self.environment.iter().any(|s| s.what == "processor");
            let hint = match (self.slower_as_a_whole(), self.relative, machines) {
                (_, true, _) => "Each ratio is compared with this median.",
                (_, false, true) => {
                    "The machines differ: with --relative, this median does not count as slower."
                }
                (Some(_), ..) => {
                    "This is more than a machine changes from study to study: the whole program is slower."
                }
                (None, ..) => {
                    "The machine or the whole program may be the reason. To tell, measure both in turns, and pool \
                     the measurements of each with `sixfold merge --repeat`."
                }
            };
            sentences.push(format!(
                "Overall, the second file has {overall:.2} × the times of the first (median of all ratios). {hint}"
            ));
        }
        for winner in &self.winners {
            sentences.push(format!(
                "{}: the fastest backend was {} and is now {}.",
                winner.operation, winner.before, winner.after
            ));
        }
        let others: Vec<String> = self
            .rows
            .iter()
            .filter(|row| row.other_checksum)
            .map(|row| {
                let Measurement {
                    operation, backend, ..
                } = &row.measurement;
                format!("{operation} on {backend}")
            })
            .collect();
        if !others.is_empty() {
            sentences.push(format!(
                "The checksums of these results differ, so the two measurements did different \
                 work: {}.",
                others.join(", ")
            ));
        }
        sentences
    }
}

impl Changes {
    /// Says what would decide the measurements that cannot be told.
    fn what_would_tell(&self) -> Option<String> {
        let open = || {
            let rows = self.rows.iter();
            rows.filter(|row| row.verdict == Verdict::CannotTell)
        };
        open().next()?;
        let once = open().filter(|row| row.detectable.is_none()).count();
        if once > 0 {
            return Some(format!(
                "{} measured in one launch, which does not show how much a time varies from process to process: \
                 measure both with --launches 3 or more, or a --budget of 6s or more.",
                counted(once, "of them was", "of them were")
            ));
        }
        let typical = median(open().filter_map(|row| row.detectable).collect())?;
        Some(format!(
            "In half of those that cannot be told, only a change by {} or more could be told from chance: use fewer \
             --operations, a longer --budget, or a quieter machine.",
            times(typical)
        ))
    }
}

/// Counts verdicts in words. `place` says where times are faster.
pub(crate) fn verdict_counts(verdicts: &[Verdict], place: &str) -> String {
    let count = |verdict| verdicts.iter().filter(|other| **other == verdict).count();
    let [faster, slower, same, open] = [
        Verdict::Faster,
        Verdict::Slower,
        Verdict::Same,
        Verdict::CannotTell,
    ]
    .map(count);
    format!(
        "{faster} {} faster {place}, {slower} {} slower, {same} {} equal, and {open} cannot be told",
        is_or_are(faster),
        is_or_are(slower),
        is_or_are(same),
    )
}

pub(crate) fn is_or_are(count: usize) -> &'static str {
    match count {
        1 => "is",
        _ => "are",
    }
}
