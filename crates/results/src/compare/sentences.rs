//! Describes the changes between two documents in sentences.

use super::{Changes, Measurement, Verdict};
use crate::numbers::counted;

impl Changes {
    /// Returns sentences that describe the changes.
    pub(super) fn describe(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        let (slower, faster) = (self.count(Verdict::Slower), self.count(Verdict::Faster));
        let same = self.count(Verdict::Same);
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
        sentences.push(format!(
            "Of {}, {faster} {} faster in the second file, {slower} {} slower, and {same} \
             {} equal within the noise.",
            counted(self.rows.len(), "measurement", "measurements"),
            is_or_are(faster),
            is_or_are(slower),
            is_or_are(same)
        ));
        if let Some(overall) = self.overall {
            let factor = overall.max(overall.recip());
            let machines = self.environment.iter().any(|s| s.what == "processor");
            if factor > self.drift {
                let hint = match (self.relative, machines) {
                    (true, _) => ". Each ratio is divided by this median before it is judged",
                    (false, true) => {
                        ". The machines differ: to divide each ratio by this median, \
                                      use --relative"
                    }
                    (false, false) => {
                        ". If a machine was busy or hot, use --relative to divide each ratio by \
                         this median"
                    }
                };
                sentences.push(format!(
                    "Overall, the second file has {overall:.2} × the times of the first (median of \
                     all ratios){hint}."
                ));
            }
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

fn is_or_are(count: usize) -> &'static str {
    match count {
        1 => "is",
        _ => "are",
    }
}
