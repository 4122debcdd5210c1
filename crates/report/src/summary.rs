//! The first screen: the answer in at most three sentences, and a table of the structures by kind of
//! work.

use crate::figure::Table;
use crate::figures::INPUT_BACKEND;
use sixfold_study::numbers::{counted, figure, list, times};
use sixfold_study::{
    BackendReport, Operation, OrdersReport, Overall, Pool, Purpose, Report, Results, Standing,
    leaders,
};

/// A table with a row for each backend and a column for each kind of work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// The columns.
    pub columns: Vec<SummaryColumn>,
    /// The rows.
    pub rows: Vec<SummaryRow>,
}

/// A column of a [`Summary`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SummaryColumn {
    /// The kind of work, or `memory`.
    pub name: String,
    /// What the figures of the column are.
    pub about: String,
}

/// A row of a [`Summary`]: one backend.
#[derive(Clone, Debug, PartialEq)]
pub struct SummaryRow {
    /// The name of the backend.
    pub backend: String,
    /// One figure for each column; `None` if there is no figure.
    pub figures: Vec<Option<SummaryFigure>>,
    /// Why the backend has no figures: the reason why it cannot hold the mesh.
    pub refusal: Option<String>,
}

/// A figure of a [`Summary`].
#[derive(Clone, Debug, PartialEq)]
pub struct SummaryFigure {
    /// The figure as text, such as `1.31 ×`.
    pub text: String,
    /// The best figure of the column divided by this figure: 1 for the best, near 0 for the worst.
    pub share: f64,
    /// Whether the figure is the best, or tied with it.
    pub rank: Rank,
}

/// The rank of a figure in its column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// The only best one.
    Best,
    /// One of several without a clear difference.
    Tied,
    /// Not the best.
    Other,
    /// A lower bound, which is not ranked.
    Bound,
}

impl SummaryFigure {
    /// Returns a figure of which small values are good.
    fn new(value: f64, best: f64, rank: Rank, text: String) -> Self {
        Self {
            text,
            share: (best / value).clamp(0.0, 1.0),
            rank,
        }
    }
}

/// The kinds of work, with the word for each column.
const WORK: [(Purpose, &str, &str); 4] = [
    (
        Purpose::Build,
        "build",
        "Time to build the structure from an indexed face set, divided by the shortest",
    ),
    (
        Purpose::Query,
        "navigate",
        "Mean time of all queries and read-only passes, divided by the shortest",
    ),
    (
        Purpose::Edit,
        "edit",
        "Mean time of all edits, divided by the shortest",
    ),
    (
        Purpose::Subdivide,
        "subdivide",
        "Time of a subdivision step by the fastest method, divided by the shortest",
    ),
];

/// What the first screen says about the memory of each backend.
struct Memory {
    backend: String,
    bytes_per_vertex: f64,
}

impl Summary {
    pub(crate) fn of_study(study: &Report, results: &Results) -> Self {
        let bytes = |backend: &BackendReport| {
            Some(Memory {
                backend: backend.name.clone(),
                bytes_per_vertex: backend.bytes_per_vertex?,
            })
        };
        let memory: Vec<Memory> = study.backends.iter().filter_map(bytes).collect();
        let orders = orders_of(study, results);
        let backends: Vec<(&str, Option<&str>)> = study
            .backends
            .iter()
            .map(|backend| (backend.name.as_str(), backend.reason.as_deref()))
            .collect();
        let sure = |purpose| is_sure(study, purpose);
        Self::new(&backends, &study.overall(), &sure, &memory, orders)
    }

    pub(crate) fn of_pool(pool: &Pool, studies: &[&Report]) -> Option<Self> {
        let all = pool.groups.first()?;
        let backends: Vec<(&str, Option<&str>)> = pool
            .compared
            .iter()
            .map(|name| (name.as_str(), None))
            .collect();
        // The mean over the meshes that all can hold.
        let studies = studies
            .iter()
            .filter(|study| all.meshes.contains(&study.mesh.name));
        let studies: Vec<&Report> = studies.copied().collect();
        let bytes = |name: &String| {
            let each = studies.iter().filter_map(|study| {
                let mut backends = study
                    .backends
                    .iter()
                    .filter(|backend| backend.name == *name);
                backends.next()?.bytes_per_vertex
            });
            let each: Vec<f64> = each.collect();
            (each.len() == studies.len() && !each.is_empty()).then(|| Memory {
                backend: name.clone(),
                bytes_per_vertex: each.iter().sum::<f64>() / each.len() as f64,
            })
        };
        let memory: Vec<Memory> = pool.compared.iter().filter_map(bytes).collect();
        Some(Self::new(&backends, &all.overall, &|_| true, &memory, None))
    }

    fn new(
        backends: &[(&str, Option<&str>)],
        overall: &[Overall],
        sure: &dyn Fn(Purpose) -> bool,
        memory: &[Memory],
        orders: Option<&OrdersReport>,
    ) -> Self {
        let mut summary = Self {
            columns: Vec::new(),
            rows: backends
                .iter()
                .map(|(backend, refusal)| SummaryRow {
                    backend: (*backend).to_owned(),
                    figures: Vec::new(),
                    refusal: refusal.map(str::to_owned),
                })
                .collect(),
        };
        for (purpose, name, about) in WORK {
            let rows: Vec<Overall> = overall
                .iter()
                .filter(|row| row.purpose == purpose)
                .cloned()
                .collect();
            summary.column(name, about, |backend| {
                work_figure(&rows, sure(purpose), backend)
            });
            if purpose == Purpose::Build {
                let about = "Bytes held for each vertex, with spare capacity";
                summary.column("memory", about, |backend| memory_figure(memory, backend));
            }
        }
        let about = "The longest time of an operation in its worst order of the elements, divided by the time in its \
                     best order";
        summary.column("worst order", about, |backend| {
            order_figure(orders?, backend)
        });
        summary
    }

    /// Returns the figures as a table. ● marks the best of a column, and ◐ those tied with it.
    pub(crate) fn table(&self) -> Table {
        let names = self.columns.iter().map(|column| column.name.as_str());
        let mut table = Table::new(["structure"].into_iter().chain(names));
        for row in &self.rows {
            let cell = |figure: &Option<SummaryFigure>| match figure {
                Some(figure) if figure.rank == Rank::Best => format!("● {}", figure.text),
                Some(figure) if figure.rank == Rank::Tied => format!("◐ {}", figure.text),
                Some(figure) => figure.text.clone(),
                None => "–".into(),
            };
            let cells = row.figures.iter().map(cell);
            table.row([row.backend.clone()].into_iter().chain(cells).collect());
        }
        table
    }

    /// Adds a column, unless it is empty.
    fn column(&mut self, name: &str, about: &str, figure: impl Fn(&str) -> Option<SummaryFigure>) {
        let figures: Vec<_> = self.rows.iter().map(|row| figure(&row.backend)).collect();
        if figures.iter().all(Option::is_none) {
            return;
        }
        self.columns.push(SummaryColumn {
            name: name.to_owned(),
            about: about.to_owned(),
        });
        for (row, figure) in self.rows.iter_mut().zip(figures) {
            row.figures.push(figure);
        }
    }
}

/// Returns the lab that reordered the mesh of `study`.
fn orders_of<'r>(study: &Report, results: &'r Results) -> Option<&'r OrdersReport> {
    results
        .orders()
        .find(|orders| orders.mesh.sha256 == study.mesh.sha256)
}

/// Returns whether an operation of a purpose has enough samples for a standing.
fn is_sure(study: &Report, purpose: Purpose) -> bool {
    let rows = study.results.iter();
    let mut rows = rows.filter(|row| Purpose::of(row.operation) == purpose);
    rows.any(|row| {
        row.standing
            .is_some_and(|standing| standing != Standing::Slower)
    })
}

/// `rows` are the means of one purpose, the fastest first.
fn work_figure(rows: &[Overall], sure: bool, backend: &str) -> Option<SummaryFigure> {
    let row = rows.iter().find(|row| row.backend == backend)?;
    let best = leaders(rows);
    let rank = match best.iter().any(|leader| leader.backend == backend) {
        _ if row.bound => Rank::Bound,
        _ if !sure => Rank::Other,
        true if best.len() == 1 => Rank::Best,
        true => Rank::Tied,
        false => Rank::Other,
    };
    let text = row.times(&rows[0]);
    Some(SummaryFigure::new(
        row.ratio_to_best,
        rows[0].ratio_to_best,
        rank,
        text,
    ))
}

fn memory_figure(memory: &[Memory], backend: &str) -> Option<SummaryFigure> {
    let own = memory
        .iter()
        .find(|memory| memory.backend == backend)?
        .bytes_per_vertex;
    let least = memory
        .iter()
        .map(|memory| memory.bytes_per_vertex)
        .fold(f64::INFINITY, f64::min);
    let equal = memory
        .iter()
        .filter(|memory| memory.bytes_per_vertex == least)
        .count();
    let rank = match own == least {
        true if equal == 1 => Rank::Best,
        true => Rank::Tied,
        false => Rank::Other,
    };
    Some(SummaryFigure::new(
        own,
        least,
        rank,
        format!("{} B", figure(own)),
    ))
}

/// Returns the largest effect of the order on `backend`, with its operation.
fn order_effect<'r>(orders: &'r OrdersReport, backend: &str) -> Option<(f64, &'r str)> {
    let effects = orders.comparisons.iter().filter_map(|comparison| {
        let mut effects = comparison.orders.iter();
        let effect = effects.find(|effect| effect.backend == backend)?;
        Some((effect.worst_to_best.ratio, comparison.operation.name()))
    });
    effects.max_by(|a, b| a.0.total_cmp(&b.0))
}

fn order_figure(orders: &OrdersReport, backend: &str) -> Option<SummaryFigure> {
    let (own, _) = order_effect(orders, backend)?;
    // No ranks: a structure that scans all faces hardly depends on the order, but is slow in all.
    Some(SummaryFigure::new(own, 1.0, Rank::Other, times(own)))
}

/// Returns the fastest backends of each kind of work of a study, and the next one. The sentence says if the
/// samples are too few for one of them.
pub(crate) fn fastest_of_study(study: &Report) -> Option<String> {
    let overall = study.overall();
    let unsure = overall.iter().any(|row| !is_sure(study, row.purpose));
    let sentence = fastest(&overall)?;
    Some(match unsure {
        true => sentence.replacen("Fastest: ", "Fastest (provisional, too few samples): ", 1),
        false => sentence,
    })
}

/// Returns the fastest backends of each kind of work, and the next one.
pub(crate) fn fastest(overall: &[Overall]) -> Option<String> {
    const ORDER: [Purpose; 4] = [
        Purpose::Query,
        Purpose::Edit,
        Purpose::Subdivide,
        Purpose::Build,
    ];
    let parts = ORDER.iter().filter_map(|purpose| {
        let rows: Vec<Overall> = overall
            .iter()
            .filter(|row| row.purpose == *purpose)
            .cloned()
            .collect();
        let best = leaders(&rows);
        if rows.len() < 2 || best.is_empty() {
            return None;
        }
        let names: Vec<&str> = best.iter().map(|row| row.backend.as_str()).collect();
        let names = match names.len() == rows.len() {
            true => "no clear difference".to_owned(),
            false => names.join(" or "),
        };
        let others = &rows[best.len()..];
        let next = others
            .first()
            .map(|next| match next.bound && others.len() > 1 {
                true => format!(" (the others: {})", next.times(&rows[0])),
                false => format!(" (next: {}, {})", next.backend, next.times(&rows[0])),
            });
        Some(format!(
            "{} {names}{}",
            purpose.of_choice(),
            next.unwrap_or_default()
        ))
    });
    let parts: Vec<String> = parts.collect();
    (!parts.is_empty()).then(|| format!("Fastest: {}.", parts.join("; ")))
}

/// Returns what would change the answer: tight memory, few repetitions, another order.
pub(crate) fn turning_points(study: &Report, results: &Results) -> Option<String> {
    let overall = study.overall();
    let queries: Vec<Overall> = overall
        .into_iter()
        .filter(|row| row.purpose == Purpose::Query)
        .collect();
    let leader = leaders(&queries).first()?.backend.clone();
    let bytes = |name: &str| {
        let mut backends = study.backends.iter().filter(|backend| backend.name == name);
        backends.next()?.bytes_per_vertex
    };
    let mut points = Vec::new();
    let least = study
        .backends
        .iter()
        .filter_map(|backend| Some((backend.name.as_str(), backend.bytes_per_vertex?)));
    let least = least.min_by(|a, b| a.1.total_cmp(&b.1));
    if let (Some((smallest, least)), Some(own)) = (least, bytes(&leader))
        && own > 1.05 * least
    {
        points.push(format!(
            "little memory ({smallest} holds a vertex in {} bytes, {leader} in {})",
            figure(least),
            figure(own)
        ));
    }
    if let Some(runs) = pays_after(study, &leader) {
        points.push(format!(
            "few queries (building {leader} pays after {runs} of them all)"
        ));
    }
    let orders = orders_of(study, results);
    if let Some((factor, operation)) = orders.and_then(|orders| order_effect(orders, &leader)) {
        points.push(format!(
            "another order of the elements (up to {} on {leader}, in {operation})",
            times(factor)
        ));
    }
    (!points.is_empty()).then(|| format!("What would change it: {}.", list(points)))
}

/// Returns after how many passes over all queries `backend`, with its first build, has saved time
/// against the indexed face set.
fn pays_after(study: &Report, backend: &str) -> Option<String> {
    let row = |operation, name: &str| study.rows(operation).find(|row| row.backend == name);
    let run = row(Operation::AllQueries, backend)?.median_ns?;
    let given = row(Operation::AllQueries, INPUT_BACKEND)?.median_ns?;
    let build = row(Operation::Build, backend)?;
    let build = build.first_ns.or(build.median_ns)?;
    let count = (build / (given - run)).ceil().max(1.0);
    (given > run && count < 1e9).then(|| counted(count as usize, "pass", "passes"))
}
