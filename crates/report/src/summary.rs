//! The first screen: the answer in at most three sentences, and a table of the structures by kind of
//! work.

use crate::figure::Table;
use crate::figures::break_even;
use sixfold_results::launches::FEWEST_LAUNCHES;
use sixfold_results::numbers::{counted, figure, grouped, list, shown_ratio, times};
use sixfold_results::ranking::FEWEST_OF_A_WINNER;
use sixfold_results::{
    BackendReport, OrdersReport, Overall, Pool, Purpose, Report, ResultRow, Results, Standing,
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
    /// What the mean is over, such as `17 operations`, or the unit.
    pub over: String,
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
    /// Length of the bar, from 0 for the best to 1 for 10 times the best and more, on a logarithmic scale.
    pub share: f64,
    /// Whether the figure is the best, or shares the first place.
    pub rank: Rank,
}

/// The rank of a figure in its column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// The only best one.
    Best,
    /// One of several that are equal, or between which nothing is decided.
    Shared,
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
            share: bar_length(value / best),
            rank,
        }
    }
}

/// Returns the length of the bar of a cost that is `ratio` times the least: from 0 for the least to 1 for 10
/// times the least and more, on a logarithmic scale.
pub(crate) fn bar_length(ratio: f64) -> f64 {
    ratio.log10().clamp(0.0, 1.0)
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
        "queries",
        "Mean time of all queries and read-only passes, divided by the shortest",
    ),
    (
        Purpose::Edit,
        "edits",
        "Mean time of all edits, divided by the shortest",
    ),
    (
        Purpose::Subdivide,
        "subdivision",
        "Time of a subdivision step by the fastest method, divided by the shortest",
    ),
];

/// A backend whose queries take longer than this factor is no choice, however small it is.
const MOST_USABLE: f64 = 10.0;
/// The smallest factor for which a single operation would change the answer.
const LEAST_GAIN: f64 = 1.2;

/// What the first screen says about the times.
struct Work<'s> {
    overall: Vec<Overall>,
    /// Whether there are enough samples to name the fastest.
    is_decided: &'s dyn Fn(Purpose) -> bool,
    /// What the means of a purpose are over.
    over: &'s dyn Fn(&[Overall]) -> String,
}

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
        let work = Work {
            overall: study.overall(),
            is_decided: &|purpose| study.is_decided(purpose),
            over: &|rows| match rows[0].purpose {
                // The first build, on fresh pages, takes longer.
                Purpose::Build => "repeated builds".into(),
                _ => study.mean_over(rows).replace("geometric mean", "mean"),
            },
        };
        Self::new(&backends, &work, &memory, orders)
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
        let work = Work {
            overall: all.overall.clone(),
            is_decided: &|purpose| {
                purpose
                    .rows(&all.overall)
                    .iter()
                    .any(|row| row.undecided < row.meshes)
            },
            over: &|rows| format!("mean over {}", counted(rows[0].meshes, "mesh", "meshes")),
        };
        Some(Self::new(&backends, &work, &memory, None))
    }

    fn new(
        backends: &[(&str, Option<&str>)],
        work: &Work<'_>,
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
            let rows = purpose.rows(&work.overall);
            let over = match rows.is_empty() {
                true => String::new(),
                false => (work.over)(rows),
            };
            let decided = (work.is_decided)(purpose);
            summary.column([name, about, &over], |backend| {
                work_figure(rows, decided, backend)
            });
            if purpose == Purpose::Build {
                let about = "Bytes held for each vertex, with spare capacity";
                let column = ["memory", about, "bytes per vertex"];
                summary.column(column, |backend| memory_figure(memory, backend));
            }
        }
        let about = "The longest time of an operation in its worst order of the elements, divided by the time in its \
                     best order";
        summary.column(["worst order", about, "longest / shortest"], |backend| {
            order_figure(orders?, backend)
        });
        summary
    }

    /// Returns the figures as a table. ● marks the best of a column, and ◐ those that share the first place.
    pub(crate) fn table(&self) -> Table {
        let names = self.columns.iter().map(|column| column.name.as_str());
        let mut table = Table::new(["structure"].into_iter().chain(names));
        for row in &self.rows {
            let cell = |figure: &Option<SummaryFigure>| match figure {
                Some(figure) if figure.rank == Rank::Best => format!("● {}", figure.text),
                Some(figure) if figure.rank == Rank::Shared => format!("◐ {}", figure.text),
                Some(figure) => figure.text.clone(),
                None => "–".into(),
            };
            let cells = row.figures.iter().map(cell);
            table.row([row.backend.clone()].into_iter().chain(cells).collect());
        }
        table
    }

    /// Adds a column, unless it is empty.
    fn column(
        &mut self,
        [name, about, over]: [&str; 3],
        figure: impl Fn(&str) -> Option<SummaryFigure>,
    ) {
        let figures: Vec<_> = self.rows.iter().map(|row| figure(&row.backend)).collect();
        if figures.iter().all(Option::is_none) {
            return;
        }
        self.columns.push(SummaryColumn {
            name: name.to_owned(),
            about: about.to_owned(),
            over: over.to_owned(),
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

/// `rows` are the means of one purpose, the fastest first.
fn work_figure(rows: &[Overall], decided: bool, backend: &str) -> Option<SummaryFigure> {
    let row = rows.iter().find(|row| row.backend == backend)?;
    let best = leaders(rows);
    let rank = match best.iter().any(|leader| leader.backend == backend) {
        _ if row.bound => Rank::Bound,
        _ if !decided => Rank::Other,
        true if best.len() == 1 => Rank::Best,
        true => Rank::Shared,
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
        true => Rank::Shared,
        false => Rank::Other,
    };
    Some(SummaryFigure::new(
        own,
        least,
        rank,
        format!("{} B", figure(own)),
    ))
}

/// Returns the largest effect of the order on `backend`, as the quotient of two shown times, with its
/// operation.
fn order_effect<'r>(orders: &'r OrdersReport, backend: &str) -> Option<(f64, &'r str)> {
    let effects = orders.comparisons.iter().filter_map(|comparison| {
        let rows = orders.rows(&comparison.operation);
        let rows = rows.filter(|row| row.backend == backend && row.ratio_to_best.is_some());
        let times: Vec<f64> = rows.filter_map(|row| row.ns_per_element).collect();
        let least = times.iter().copied().reduce(f64::min)?;
        let most = times.iter().copied().reduce(f64::max)?;
        Some((shown_ratio(most, least), comparison.operation.as_str()))
    });
    effects.max_by(|a, b| a.0.total_cmp(&b.0))
}

fn order_figure(orders: &OrdersReport, backend: &str) -> Option<SummaryFigure> {
    let (own, _) = order_effect(orders, backend)?;
    // No ranks: a structure that scans all faces hardly depends on the order, but is slow in all.
    Some(SummaryFigure::new(own, 1.0, Rank::Other, times(own)))
}

/// Returns the fastest backends of each kind of work of a study, and the next one. If the samples are too
/// few for one of them, the sentence says so, and which budget gives enough.
pub(crate) fn fastest_of_study(study: &Report) -> Option<String> {
    let overall = study.overall();
    let parts = fastest(&overall, &|row| row.backend.clone())?;
    let unsure = overall.iter().any(|row| !study.is_decided(row.purpose));
    Some(match (unsure, enough(study)) {
        (false, _) => format!("Fastest: {parts}."),
        (true, None) => format!("Fastest (provisional, too few samples): {parts}."),
        (true, Some(budget)) => {
            format!("Fastest (provisional, too few samples; {budget}): {parts}.")
        }
    })
}

/// Returns what gives about enough samples for a winner; `None` if this is unknown.
fn enough(study: &Report) -> Option<String> {
    let open = study.results.iter();
    let open = open.filter(|row| row.median_ns.is_some() && row.standing.is_none());
    let open = open.filter(|row| !row.has_enough_samples());
    let settings = &study.run.settings;
    let known = |row: &ResultRow| match settings.launches {
        Some(_) => row.launch_ns.iter().flatten().count(),
        None => row.samples,
    };
    let fewest = open.map(known).min()?.max(1);
    match (settings.rounds, settings.launches) {
        (Some(_), Some(_)) => None,
        (Some(_), None) => Some(format!("--rounds {FEWEST_OF_A_WINNER} gives enough")),
        (None, launches) => {
            let needed = launches.map_or(FEWEST_OF_A_WINNER, |_| FEWEST_LAUNCHES);
            // Half as much again, because the first runs also find out how long the others take.
            let factor = 1.5 * needed as f64 / fewest as f64;
            Some(format!("{} times the --budget gives enough", factor.ceil()))
        }
    }
}

/// Returns the fastest backends of each kind of work over several meshes, with the number of meshes on which
/// they are the fastest, and the next one.
pub(crate) fn fastest_of_many(overall: &[Overall]) -> Option<String> {
    let parts = fastest(overall, &wins);
    let unsure = overall.iter().map(|row| row.undecided).max().unwrap_or(0);
    let unsure = match unsure {
        0 => String::new(),
        _ => format!(
            " (provisional, {} without enough samples)",
            counted(unsure, "mesh", "meshes")
        ),
    };
    Some(format!("Fastest on average{unsure}: {}.", parts?))
}

/// Returns a backend with the number of decided meshes on which it is the fastest: `half-edge (7 of 9, shared on 1)`.
pub(crate) fn wins(row: &Overall) -> String {
    if row.undecided == row.meshes {
        return format!("{} (too few samples)", row.backend);
    }
    let tied = match row.tied {
        0 => String::new(),
        tied => format!(", shared on {}", grouped(tied)),
    };
    format!(
        "{} ({} of {}{tied})",
        row.backend,
        grouped(row.best),
        grouped(row.meshes - row.undecided)
    )
}

/// Returns the fastest backends of each kind of work, as `name` names them, and the next one.
fn fastest(overall: &[Overall], name: &dyn Fn(&Overall) -> String) -> Option<String> {
    const ORDER: [Purpose; 4] = [
        Purpose::Query,
        Purpose::Edit,
        Purpose::Subdivide,
        Purpose::Build,
    ];
    let parts = ORDER.iter().filter_map(|purpose| {
        let rows = purpose.rows(overall);
        let best = leaders(rows);
        if rows.len() < 2 || best.is_empty() {
            return None;
        }
        let names = match best.len() == rows.len() {
            true => "no clear difference".to_owned(),
            false => best.iter().map(name).collect::<Vec<_>>().join(" or "),
        };
        let others = &rows[best.len()..];
        let next = others
            .first()
            .map(|next| match next.bound && others.len() > 1 {
                true => format!(", the others {}", next.times(&rows[0])),
                false => format!(", next {} {}", next.backend, next.times(&rows[0])),
            });
        Some(format!(
            "{} {names}{}",
            purpose.of_choice(),
            next.unwrap_or_default()
        ))
    });
    let parts: Vec<String> = parts.collect();
    (!parts.is_empty()).then(|| parts.join("; "))
}

/// Returns what would change the answer: tight memory, few repetitions, a single operation, another order.
pub(crate) fn turning_points(study: &Report, results: &Results) -> Option<String> {
    let overall = study.overall();
    let queries = Purpose::Query.rows(&overall);
    let leader = leaders(queries).first()?;
    let orders = orders_of(study, results);
    let order = orders.and_then(|orders| order_effect(orders, &leader.backend));
    let points = [
        less_memory(study, queries, leader),
        few_queries(study),
        one_operation(study, leader),
        order.map(|(factor, operation)| {
            format!(
                "another order of the elements ({} takes up to {} in its worst order, in {operation})",
                leader.backend,
                times(factor)
            )
        }),
    ];
    let points: Vec<String> = points.into_iter().flatten().collect();
    (!points.is_empty()).then(|| format!("What would change it: {}.", list(points)))
}

/// Names the smallest backend and what it costs, if it is clearly smaller than `leader`.
fn less_memory(study: &Report, queries: &[Overall], leader: &Overall) -> Option<String> {
    let bytes = |name: &str| {
        let mut backends = study.backends.iter().filter(|backend| backend.name == name);
        backends.next()?.bytes_per_vertex
    };
    let own = bytes(&leader.backend)?;
    let smaller = queries
        .iter()
        .filter_map(|row| Some((row, bytes(&row.backend)?)));
    // A backend that scans all faces is no choice for queries, so it must not be much slower.
    let usable = smaller.filter(|(row, bytes)| {
        !row.bound && 1.05 * bytes < own && row.ratio_to_best < MOST_USABLE * leader.ratio_to_best
    });
    let (smallest, least) = usable.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(format!(
        "little memory ({}: {} bytes per vertex instead of {}, {} in queries)",
        smallest.backend,
        figure(least),
        figure(own),
        smallest.times(leader)
    ))
}

/// Names the backend that is much faster than `leader` in one query, for the query with the largest
/// difference.
fn one_operation(study: &Report, leader: &Overall) -> Option<String> {
    let own = study
        .results
        .iter()
        .filter(|row| row.backend == leader.backend);
    let own = own.filter(|row| study.run.purpose_of(&row.operation) == Some(Purpose::Query));
    let slower = own.filter(|row| row.standing == Some(Standing::Slower));
    let slower = slower.filter_map(|row| Some((row, study.shown_ratio(row)?)));
    let (row, ratio) = slower.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let best = study
        .rows(&row.operation)
        .find(|row| row.ratio_to_best == Some(1.0))?;
    (ratio >= LEAST_GAIN).then(|| {
        format!(
            "a single operation ({} in {}: {} takes {})",
            best.backend,
            row.operation,
            leader.backend,
            times(ratio)
        )
    })
}

/// Says up to how many visited elements other backends than the last one have the shortest total time, with
/// the first build.
fn few_queries(study: &Report) -> Option<String> {
    let (name, steps) = break_even::sequence(study)?;
    let steps: Vec<String> = steps
        .iter()
        .map(|(name, most)| format!("{name} up to {most}"))
        .collect();
    (!steps.is_empty()).then(|| {
        format!(
            "few queries (with the time to build, the shortest total has {}, then {name})",
            list(steps)
        )
    })
}
