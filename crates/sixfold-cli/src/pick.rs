//! `sixfold pick`: finds the backend that fits a mesh and a workload.

use std::path::Path;
use std::process::ExitCode;

use comfy_table::{Cell, CellAlignment};
use sixfold_study::{Answer, BreakEven, Question, Ranked, Specimen};

use crate::arguments::Pick;
use crate::failure::Failure;
use crate::load;
use crate::measured::{ended, tell_of_debug_build, typed};
use crate::output::{Output, check_places, is_stdout};
use crate::progress::{Bar, interrupt_flag};
use crate::tables::table;
use crate::text::{Text, complain, hanging, tame};
use crate::workloads::workload;
use sixfold_study::numbers::{counted, duration, figure, grouped};

/// The exit code if no backend qualifies.
const NONE: u8 = 1;

/// Measures and shows the answer. Text is printed first, so that it is not lost if a file fails.
pub(crate) fn run(arguments: &Pick) -> Result<ExitCode, Failure> {
    for mesh in &arguments.meshes {
        check_places(Some(mesh), &[("--json", arguments.json.as_ref())])?;
    }
    let workload = workload(&arguments.workload)?;
    // Before the draft of the output is opened, so that Ctrl-C cannot leave a draft behind.
    let stop = interrupt_flag(arguments.heap);
    let json = Output::open_if(arguments.json.as_ref())?;
    let specimens = specimens(arguments)?;
    let question = Question {
        workload,
        backends: arguments.backends.clone(),
        needs: arguments.needs.clone(),
        max_memory: arguments.max_memory,
        budget: arguments.budget,
        seed: arguments.seed,
        heap: arguments.heap,
    };
    tell_of_debug_build();
    let bar = Bar::new();
    let answer = sixfold_study::pick(&specimens, &question, &stop, &mut |done, what| {
        bar.at(done, what)
    });
    bar.clear();
    let mut answer = answer.map_err(Failure::usage)?;
    answer.environment.command = Some(typed());

    let mut text = Text::shown(!arguments.json.as_deref().is_some_and(is_stdout));
    print(&answer, &specimens, &mut text);
    let mut done = text.finish();
    if let Some(output) = json {
        done = done.and(output.finish(|writer| answer.write_json(writer)));
    }
    let code = ended(done, answer.mismatches.len(), answer.interrupted)?;
    if answer.ranking.is_empty() && !answer.interrupted {
        complain(
            "error: no backend qualifies: relax --needs, --max-memory or --backends, or repair the mesh (see `sixfold inspect`)",
        );
        return Ok(ExitCode::from(NONE));
    }
    Ok(code)
}

fn specimens(arguments: &Pick) -> Result<Vec<Specimen>, Failure> {
    if arguments.meshes.is_empty() {
        return Ok(vec![load::built_in()]);
    }
    let read = |path: &std::path::PathBuf| -> Result<Specimen, Failure> {
        load::for_study(Path::new(path), false, arguments.triangulate)
    };
    arguments.meshes.iter().map(read).collect()
}

fn print(answer: &Answer, specimens: &[Specimen], text: &mut Text) {
    for specimen in specimens {
        let vertices = counted(specimen.polygons.vertex_count(), "vertex", "vertices");
        let faces = counted(specimen.polygons.face_count(), "face", "faces");
        text.say(&hanging(
            "Mesh:     ",
            &format!("{}: {vertices}, {faces}", specimen.name),
        ));
    }
    let summary = format!("{}. {}", answer.workload.name, answer.workload.summary);
    text.say(&hanging("Workload: ", &tame(summary.trim())));
    let operations = counted(
        answer.operations.round() as usize,
        "operation",
        "operations",
    );
    let mix: Vec<String> = { answer.workload.mix.iter() }
        .map(|part| format!("{} {}", part.weight, part.action))
        .collect();
    let rebuilt = match answer.workload.rebuilds {
        0 => String::new(),
        times => format!(", rebuilt {}", counted(times as usize, "time", "times")),
    };
    let mix = mix.join(", ");
    text.say(&hanging(
        "Mix:      ",
        &format!("{mix}; {}; {operations}{rebuilt}", answer.workload.access),
    ));
    text.say("");
    if !answer.ranking.is_empty() {
        text.say(&ranking(answer));
        text.say("");
    }
    for words in &answer.words {
        text.say(&hanging("- ", words));
    }
    for out in &answer.excluded {
        text.say(&hanging(
            "- ",
            &format!("{} is excluded: {}.", out.backend, out.reason),
        ));
    }
    for warning in &answer.warnings {
        text.say(&hanging("! ", warning));
    }
}

/// Returns the table of backends, best first: times, memory, and after how many operations each
/// pays off.
fn ranking(answer: &Answer) -> String {
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    let header = [
        "",
        "operation",
        "/ best",
        "95 %",
        "1st build",
        "again",
        "B/vertex",
        "pays after",
    ];
    let mut rows = table(header.iter().map(|name| right((*name).into())).collect());
    let mut notes = [false; 3];
    for ranked in &answer.ranking {
        let mark = match (ranked.estimated, ranked.sampled) {
            (true, _) => "?",
            (_, true) => "~",
            _ => "",
        };
        notes[0] |= ranked.sampled && !ranked.estimated;
        notes[1] |= ranked.estimated;
        notes[2] |= ranked.tied_with_best && answer.ranking.len() > 1;
        let tied = if ranked.tied_with_best { " =" } else { "" };
        let interval = ranked.ci_low.zip(ranked.ci_high);
        let interval = interval.map_or("–".into(), |(low, high)| {
            format!("{} to {}", ratio(low), ratio(high))
        });
        rows.add_row(vec![
            Cell::new(&ranked.backend),
            right(format!("{}{mark}", duration(ranked.ns_per_operation))),
            right(ratio(ranked.ratio_to_best) + tied),
            right(interval),
            right(ranked.first_build_ns.map_or("–".into(), duration)),
            right(duration(ranked.build_ns)),
            right(format!("{:.1}", ranked.bytes_per_vertex)),
            right(pays(answer, ranked)),
        ]);
    }
    let mut text = rows.trim_fmt();
    let legend = [
        "~ measured on a sample of the elements, because each query scans all faces",
        "? estimated, because a full run would exceed the budget",
        "= tied with the best: not measurably different from it",
    ];
    for (line, _) in legend.into_iter().zip(notes).filter(|(_, note)| *note) {
        text += "\n";
        text += line;
    }
    let tables = answer
        .ranking
        .iter()
        .find_map(|ranked| ranked.over.as_deref());
    if let Some(over) = tables {
        text += &format!(
            "\nrelation-tables: flat tables of only the relations in the mix, made from {over}"
        );
    }
    text + "\n1st build: on fresh pages; again: on freed pages that are used again\n\
            pays after: operations until the first build has paid off, compared with keeping the\n\
            indexed face set"
}

/// Formats a ratio as `1.04`, `12.3` or `1,230`.
fn ratio(ratio: f64) -> String {
    match ratio < 1.0 {
        true => format!("{ratio:.2}"),
        false => figure(ratio),
    }
}

fn pays(answer: &Answer, ranked: &Ranked) -> String {
    let row = |row: &&BreakEven| row.backend == ranked.backend;
    match answer.break_even.iter().find(row) {
        None => "–".into(),
        Some(BreakEven {
            operations: None, ..
        }) => "never".into(),
        Some(BreakEven {
            operations: Some(operations),
            ..
        }) if *operations < 1e15 => grouped(operations.ceil() as usize),
        Some(_) => "never".into(),
    }
}
