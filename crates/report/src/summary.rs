//! The first screen: the answer in one sentence for each kind of work, and a table of the structures by kind of
//! work.

use crate::figure::Table;
use crate::figures::break_even;
use crate::matrix::{ends_of_ratios, is_known, likely_first};
use sixfold_results::launches::FEWEST_LAUNCHES;
use sixfold_results::numbers::{counted, figure, grouped, list, shown_ratio, times};
use sixfold_results::ranking::FEWEST_OF_A_WINNER;
use sixfold_results::{
    BackendReport, OrdersReport, Overall, Pool, Purpose, Report, ResultRow, Results, Standing,
    leaders, next_best, next_row,
};

/// A table with a row for each backend and a column for each kind of work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// The columns.
    pub columns: Vec<SummaryColumn>,
    /// The rows.
    pub rows: Vec<SummaryRow>,
    /// What the ends of the ratios are, such as `its 95 % interval`.
    pub ends: String,
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
    /// The figure in another unit, such as `18.0 B per triangle`.
    pub detail: Option<String>,
    /// How the figure is drawn.
    pub drawing: Drawing,
    /// Whether the figure is the best, or shares the first place.
    pub rank: Rank,
}

/// How a figure of a [`Summary`] is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drawing {
    /// A dot for a ratio, and a line for its interval, on a logarithmic scale.
    Dot {
        /// The ratio to the best.
        ratio: f64,
        /// The ends of the interval of the ratio.
        interval: Option<[f64; 2]>,
    },
    /// A bar from 0: the share of the largest.
    Bar(f64),
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
    fn ratio(ratio: f64, interval: Option<[f64; 2]>, rank: Rank, text: String) -> Self {
        Self {
            text,
            detail: None,
            drawing: Drawing::Dot { ratio, interval },
            rank,
        }
    }
}

/// The kinds of work, with the word for each column.
const WORK: [(Purpose, &str, &str); 4] = [
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
    (
        Purpose::Build,
        "build",
        "Time to build the structure from an indexed face set, divided by the shortest",
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
    /// What the ends of the ratios are.
    ends: String,
}

/// What the first screen says about the memory of each backend.
struct Memory {
    backend: String,
    bytes_per_vertex: f64,
    bytes_per_face: f64,
    /// `triangle` if all faces are triangles, otherwise `face`.
    face: &'static str,
}

impl Memory {
    /// Returns the mean over `studies`; `None` if `backend` has no size in one of them.
    fn of(backend: &str, studies: &[&Report]) -> Option<Self> {
        let each = studies.iter().map(|study| {
            let bytes = study.backend(backend)?.bytes_per_vertex?;
            let facts = &study.mesh.facts;
            let faces = facts.faces.max(1) as f64;
            Some([bytes, bytes * facts.vertices as f64 / faces])
        });
        let each: Option<Vec<[f64; 2]>> = each.collect();
        let each = each.filter(|each| !each.is_empty())?;
        let mean = |unit: usize| each.iter().map(|one| one[unit]).sum::<f64>() / each.len() as f64;
        let is_triangles = |study: &&Report| {
            let degrees = study.mesh.facts.face_degree.as_ref();
            degrees.is_some_and(|degrees| degrees.max == 3)
        };
        Some(Self {
            backend: backend.to_owned(),
            bytes_per_vertex: mean(0),
            bytes_per_face: mean(1),
            face: match studies.iter().all(is_triangles) {
                true => "triangle",
                false => "face",
            },
        })
    }
}

impl Summary {
    pub(crate) fn of_study(study: &Report, results: &Results) -> Self {
        let of = |backend: &BackendReport| Memory::of(&backend.name, &[study]);
        let memory: Vec<Memory> = study.backends.iter().filter_map(of).collect();
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
                Purpose::Query => work_of_mean(study, rows, "queries and passes"),
                _ => work_of_mean(study, rows, "edits"),
            },
            ends: ends_of_ratios(1, study.run.settings.confidence),
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
        let confidence = studies.first()?.run.settings.confidence;
        let of = |name: &String| Memory::of(name, &studies);
        let memory: Vec<Memory> = pool.compared.iter().filter_map(of).collect();
        let work = Work {
            overall: all.overall.clone(),
            is_decided: &|purpose| {
                purpose
                    .rows(&all.overall)
                    .iter()
                    .any(|row| row.undecided < row.meshes)
            },
            over: &|rows| format!("mean over {}", counted(rows[0].meshes, "mesh", "meshes")),
            ends: ends_of_ratios(all.meshes.len(), confidence),
        };
        Some(Self::new(&backends, &work, &memory, None))
    }

    fn new(
        backends: &[(&str, Option<&str>)],
        work: &Work<'_>,
        memory: &[Memory],
        orders: Option<&OrdersReport>,
    ) -> Self {
        let mut backends = backends.to_vec();
        likely_first(&mut backends, &work.overall, |(name, _)| name);
        let mut summary = Self {
            columns: Vec::new(),
            ends: work.ends.clone(),
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
            if purpose == Purpose::Query {
                let about = "Bytes of all tables, with spare capacity, divided by the number of vertices; below, by the number of faces";
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

/// Returns what a mean is over, such as `mean of 17 queries and passes`.
fn work_of_mean(study: &Report, rows: &[Overall], work: &str) -> String {
    let text = study.mean_over(rows).replace("geometric mean", "mean");
    text.replace("operations", work)
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
    let ratio = row.ratio_to_best / rows[0].ratio_to_best;
    let interval = row.ends();
    let interval = interval.filter(|ends| row.meshes > 1 || is_known(ends));
    let text = row.times(&rows[0]);
    Some(SummaryFigure::ratio(ratio, interval, rank, text))
}

fn memory_figure(memory: &[Memory], backend: &str) -> Option<SummaryFigure> {
    let held = memory.iter().find(|memory| memory.backend == backend)?;
    let own = held.bytes_per_vertex;
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
    let most = memory.iter().map(|memory| memory.bytes_per_vertex);
    let most = most.fold(own, f64::max);
    let detail = format!("{} B per {}", figure(held.bytes_per_face), held.face);
    Some(SummaryFigure {
        text: format!("{} B", figure(own)),
        detail: Some(detail),
        drawing: Drawing::Bar(own / most.max(f64::MIN_POSITIVE)),
        rank,
    })
}

/// The largest effect of the order on a backend.
struct OrderEffect<'r> {
    /// The longest time divided by the shortest, as the quotient of two shown times.
    ratio: f64,
    interval: Option<[f64; 2]>,
    operation: &'r str,
}

fn order_effect<'r>(orders: &'r OrdersReport, backend: &str) -> Option<OrderEffect<'r>> {
    let effects = orders.comparisons.iter().filter_map(|comparison| {
        let rows = orders.rows(&comparison.operation);
        let rows = rows.filter(|row| row.backend == backend && row.ratio_to_best.is_some());
        let times: Vec<f64> = rows.filter_map(|row| row.ns_per_element).collect();
        let least = times.iter().copied().reduce(f64::min)?;
        let most = times.iter().copied().reduce(f64::max)?;
        let mut factors = comparison.orders.iter();
        let factor = factors
            .find(|effect| effect.backend == backend)?
            .worst_to_best;
        Some(OrderEffect {
            ratio: shown_ratio(most, least),
            interval: factor.ci_low.zip(factor.ci_high).map(Into::into),
            operation: &comparison.operation,
        })
    });
    effects.max_by(|a, b| a.ratio.total_cmp(&b.ratio))
}

fn order_figure(orders: &OrdersReport, backend: &str) -> Option<SummaryFigure> {
    let OrderEffect {
        ratio, interval, ..
    } = order_effect(orders, backend)?;
    // No ranks: a structure that scans all faces hardly depends on the order, but is slow in all.
    let text = times(ratio);
    Some(SummaryFigure::ratio(ratio, interval, Rank::Other, text))
}

/// Returns a sentence for each kind of work of a study: the fastest backends, and the next one with the interval of its
/// ratio.
pub(crate) fn fastest_of_study(study: &Report) -> Vec<String> {
    let overall = study.overall();
    let is_provisional = |purpose| !study.is_decided(purpose);
    let name = |row: &Overall| row.backend.clone();
    fastest(&overall, &name, &is_provisional)
}

/// Says how sure the answer of a study is, and which budget gives enough samples if there are too few.
pub(crate) fn how_sure(study: &Report) -> Option<String> {
    let sure = study.how_sure()?;
    let overall = study.overall();
    let unsure = overall.iter().any(|row| !study.is_decided(row.purpose));
    match enough(study).filter(|_| unsure) {
        Some(budget) => Some(format!("{} {budget}.", sure)),
        None => Some(sure),
    }
}

/// Returns what gives about enough samples for a winner; `None` if this is unknown.
fn enough(study: &Report) -> Option<String> {
    let open = study.results.iter().filter(|row| row.is_provisional());
    let settings = &study.run.settings;
    let known = |row: &ResultRow| match settings.launches {
        Some(_) => row.launch_ns.iter().flatten().count(),
        None => row.samples,
    };
    let fewest = open.map(known).min()?.max(1);
    match (settings.rounds, settings.launches) {
        (Some(_), Some(_)) => None,
        (Some(_), None) => Some(format!("Enough samples need --rounds {FEWEST_OF_A_WINNER}")),
        (None, launches) => {
            let needed = launches.map_or(FEWEST_OF_A_WINNER, |_| FEWEST_LAUNCHES);
            // Half as much again, because the first runs also find out how long the others take.
            let factor = 1.5 * needed as f64 / fewest as f64;
            Some(format!(
                "Enough samples need {} times the --budget",
                factor.ceil()
            ))
        }
    }
}

/// Returns a sentence for each kind of work over several meshes: the fastest backends, with the number of meshes on which
/// they are the fastest, and the next one.
pub(crate) fn fastest_of_many(overall: &[Overall]) -> Vec<String> {
    let is_provisional = |purpose: Purpose| {
        let rows = purpose.rows(overall);
        rows.iter().any(|row| row.undecided > 0)
    };
    let name = |row: &Overall| match row.undecided == row.meshes {
        true => row.backend.clone(),
        false => wins(row).replacen(" (", " (fastest on ", 1),
    };
    fastest(overall, &name, &is_provisional)
}

/// Returns a backend with the number of meshes on which it is the fastest: `half-edge (7 of 9, shared on 1)`.
pub(crate) fn wins(row: &Overall) -> String {
    if row.undecided == row.meshes {
        return format!("{} (too few samples)", row.backend);
    }
    let others = [(row.tied, "shared on"), (row.undecided, "undecided on")];
    let others = others.into_iter().filter(|(count, _)| *count > 0);
    let others: String = others
        .map(|(count, what)| format!(", {what} {}", grouped(count)))
        .collect();
    format!(
        "{} ({} of {}{others})",
        row.backend,
        grouped(row.best),
        grouped(row.meshes)
    )
}

/// Returns a sentence for each kind of work: the fastest backends, as `name` names them, and the next one.
fn fastest(
    overall: &[Overall],
    name: &dyn Fn(&Overall) -> String,
    is_provisional: &dyn Fn(Purpose) -> bool,
) -> Vec<String> {
    const ORDER: [Purpose; 4] = [
        Purpose::Query,
        Purpose::Edit,
        Purpose::Subdivide,
        Purpose::Build,
    ];
    let sentences = ORDER.into_iter().filter_map(|purpose| {
        let rows = purpose.rows(overall);
        let best = leaders(rows);
        if rows.len() < 2 || best.is_empty() {
            return None;
        }
        let names = match best.len() == rows.len() && rows[0].meshes == 1 {
            true => "no clear difference".to_owned(),
            false => best
                .iter()
                .map(|row| name(row))
                .collect::<Vec<_>>()
                .join(" or "),
        };
        let provisional = match is_provisional(purpose) {
            true => " (provisional, too few samples)",
            false => "",
        };
        let next = next_best(rows).zip(next_row(rows));
        let next = next.map_or(String::new(), |((next, ratio), row)| {
            let interval = row.ends();
            let interval = interval.filter(|ends| row.meshes > 1 || is_known(ends));
            let interval = interval.map(|ends| ends.map(figure));
            let interval = interval.filter(|[low, high]| low != high);
            let of_which = match (row.meshes, row.ci_low) {
                (1, _) => "",
                (_, Some(_)) => " on other such meshes",
                (_, None) => " on the meshes",
            };
            let interval = interval.map_or(String::new(), |[low, high]| {
                format!(" ({low} to {high}{of_which})")
            });
            format!("; {next} {ratio}{interval}")
        });
        Some(format!("{}{provisional}: {names}{next}.", purpose.title()))
    });
    sentences.collect()
}

/// Returns what follows the table of the first screen: what would change the answer, and the backend that a study does
/// not measure.
pub(crate) fn conditions(study: &Report, results: &Results) -> Vec<String> {
    let points = turning_points(study, results);
    points.into_iter().chain([TABLES.to_owned()]).collect()
}

const TABLES: &str = "Not in a study: flat tables of only the relations that a program queries are often faster than every \
                      structure. `sixfold pick` measures them with your workload.";

/// Returns what would change the answer: tight memory, few repetitions, a single operation, another order.
pub(crate) fn turning_points(study: &Report, results: &Results) -> Option<String> {
    let overall = study.overall();
    let queries = Purpose::Query.rows(&overall);
    let leader = queries.first().filter(|row| !row.bound)?;
    let orders = orders_of(study, results);
    let order = orders.and_then(|orders| order_effect(orders, &leader.backend));
    let points = [
        less_memory(study, queries, leader),
        few_queries(study),
        one_operation(study, leader),
        order.map(|order| {
            format!(
                "another order of the elements ({} takes up to {} in its worst order, in {})",
                leader.backend,
                times(order.ratio),
                order.operation
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
            "few queries (with the time of a first build, the shortest total has {}, then {name})",
            list(steps)
        )
    })
}
