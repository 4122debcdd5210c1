//! `sixfold why`: explains the time of queries by the memory that they read.

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use sixfold_results::{Policy, WhyRow};
use sixfold_study::{Effort, Settings, StudyError, StudyMesh, Timing, WhySettings};

use crate::arguments::Why;
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::load;
use crate::measure::{Session, warn_of_debug_build, with_command};
use crate::progress::Bar;
use crate::text::TextOutput;
use crate::why_text::{legend, memory_text, rows_text};

pub(crate) fn run(arguments: &Why) -> Result<ExitCode, Failure> {
    let mesh = arguments.mesh.as_deref();
    let mut session = Session::open(mesh, &arguments.files, Policy::Kept)?;
    let study_mesh = load::mesh_or_built_in(mesh, arguments.read, false, arguments.triangulate)?;
    let study_mesh = session.drawn(study_mesh);
    let effort = (!arguments.counts_only).then(|| arguments.effort.effort());
    if effort.is_some() {
        warn_of_debug_build();
    }
    let settings = WhySettings {
        backends: arguments.backends.clone(),
        relations: arguments.relations.clone(),
        ..WhySettings::default()
    };
    let chosen = Settings {
        backends: arguments.backends.clone(),
        ..Settings::default()
    };
    print_before_measuring(&study_mesh, &chosen, &mut session.text);
    let why = measure(&study_mesh, settings, effort, &session.stop, &Bar::new())?;
    print(&why, !arguments.relations.is_empty(), &mut session.text);
    session.finish(with_command(why, arguments.triangulate).into(), false)
}

/// Counts reads. If there is an `effort`, also measures times.
pub(crate) fn measure(
    study_mesh: &StudyMesh,
    mut settings: WhySettings,
    effort: Option<Effort>,
    stop: &AtomicBool,
    bar: &Bar,
) -> Result<sixfold_results::Why, Failure> {
    settings.timing = effort.map(|effort| Timing { effort });
    let why = sixfold_study::why(study_mesh, &settings, stop, &mut |at| bar.show(at));
    bar.clear();
    why.map_err(|error| match error {
        StudyError::NoneHolds { .. } => Failure::unsupported(error),
        error => Failure::usage(error),
    })
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
