//! `sixfold why`: explains the time of queries by the memory that they read.

use std::process::ExitCode;

use sixfold::Relation;
use sixfold_results::{Policy, WhyRow};
use sixfold_study::{Progress, Settings, StudyError, StudyMesh, Timing, WhySettings};

use crate::arguments::Why;
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::launches::{self, Launching, Work, chosen};
use crate::load;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::progress::Bar;
use crate::text::TextOutput;
use crate::why_text::{legend, memory_text, rows_text};

/// The seed of the random order of the measurements.
const SEED: u64 = 1;
/// The approximate time in seconds in which a launch measures the speed of memory.
const MEMORY_S: f64 = 1.6;

pub(crate) fn run(arguments: &Why) -> Result<ExitCode, Failure> {
    let mesh = arguments.mesh.as_deref();
    let mut session = Session::open(mesh, &arguments.files, Policy::Kept)?;
    let study_mesh = load::mesh_or_built_in(mesh, arguments.read, false, arguments.triangulate)?;
    let study_mesh = session.drawn(study_mesh);
    let timing = (!arguments.counts_only).then(|| Timing {
        effort: arguments.effort.effort(),
        seed: launches::seed(SEED),
        confidence: arguments.launching.confidence,
    });
    if timing.is_some() {
        warn_of_debug_build();
    }
    let settings = WhySettings {
        backends: arguments.backends.clone(),
        relations: arguments.relations.clone(),
        timing,
        ..WhySettings::default()
    };
    let chosen = Settings {
        backends: arguments.backends.clone(),
        ..Settings::default()
    };
    print_before_measuring(&study_mesh, &chosen, &mut session.text);
    let launching = Launching {
        wanted: arguments.launching.launches,
        paths: mesh.into_iter().collect(),
        part: None,
        stop: &session.stop,
        pool: sixfold_study::pool_launches,
    };
    let why = measure(&study_mesh, &settings, &launching, &Bar::new())?;
    print(&why, !arguments.relations.is_empty(), &mut session.text);
    session.finish(with_command(why, arguments.triangulate).into(), false)
}

/// Counts reads, and measures times if the settings say how: in this process, or in several launches, which count the
/// same.
pub(crate) fn measure(
    study_mesh: &StudyMesh,
    settings: &WhySettings,
    launching: &Launching<'_>,
    bar: &Bar,
) -> Result<sixfold_results::Why, Failure> {
    let here = || {
        let mut show = |at: Progress<'_>| bar.show(at);
        let why = sixfold_study::why(study_mesh, settings, launching.stop, &mut show);
        why.map_err(|error| match error {
            StudyError::NoneHolds { .. } => Failure::unsupported(error),
            error => Failure::usage(error),
        })
    };
    let why = match settings.timing {
        None => here(),
        Some(Timing { effort, .. }) => {
            let relations = chosen(&settings.relations, Relation::ALL.len());
            let faces = study_mesh.polygons.face_count();
            let work = Work {
                // To count the reads of a relation takes about as long as to build the structures.
                faces: (1 + relations) * faces,
                spare_s: MEMORY_S,
                ..Work::new(faces, relations, &settings.backends)
            };
            let plan = launching.plan(effort, work)?;
            let meshes = Some(vec![study_mesh.report()]);
            plan.measure(meshes, &|done, what| bar.set(done, what), here)
        }
    };
    bar.clear();
    why
}

/// Prints the answer, then the tables and their legend. There is a table for each relation; if there is
/// only one backend, one table has all relations. If `detailed` is set, each relation has two tables.
fn print(why: &sixfold_results::Why, detailed: bool, text: &mut TextOutput) {
    text.print_line("");
    text.print_list("- ", &why.sentences);
    text.print_list("! ", &why.warnings);
    if let Some(buffers) = &why.memory {
        text.print_line("");
        text.print_line(&memory_text(buffers));
    }
    let is_one_backend = why
        .rows
        .iter()
        .all(|row| row.backend == why.rows[0].backend);
    let is_one_table = |a: &WhyRow, b: &WhyRow| {
        a.reads.relation == b.reads.relation || (is_one_backend && !detailed)
    };
    for rows in why.rows.chunk_by(is_one_table) {
        text.print_line("");
        text.print_line(&rows_text(rows, why.memory.is_some(), detailed));
    }
    text.print_line("");
    text.print_line(&legend(why, detailed));
}
