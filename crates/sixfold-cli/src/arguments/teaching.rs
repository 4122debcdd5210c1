//! Arguments of the commands that show how structures work.

use std::ffi::OsString;
use std::ops::Range;
use std::path::PathBuf;

use clap::Args;

use super::{ReadFiles, backend};

const TABLES_EXAMPLES: &str = "Examples:
  sixfold tables                                        a cube in a half-edge mesh
  sixfold tables cube.obj --backend half-edge
  sixfold tables cube.obj --all                         all structures
  sixfold tables bunny.obj --rows 100..110              eleven rows of a large mesh
  sixfold tables cube.obj --backend corner-table --markdown -    for slides

A row of a table is named by a letter and a number: v vertex, e edge, h half-edge, f face, c corner,
p place in a list. The fields have the names of textbooks. A field with a † is not stored: it follows
from the number of the row, or from other fields.

Exit codes: 0 success; 2 wrong usage or unusable input; 3 the structure cannot hold the mesh.";

/// Show the tables of a data structure, row by row.
///
/// The rows are read from the structure itself. Without a mesh, the command shows a cube.
#[derive(Debug, Args)]
#[command(after_help = TABLES_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Tables {
    /// The mesh (- for standard input); without it, a cube
    #[arg(value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) explained: Explained,
    /// Show only these rows of each table, the last one included
    #[arg(long, value_name = "FROM..TO", value_parser = rows)]
    pub(crate) rows: Option<Range<usize>>,
    /// Write the tables as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Write one line for each field as CSV (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Write the tables as Markdown (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) markdown: Option<PathBuf>,
}

/// The structures to explain, and how the mesh is read.
#[derive(Debug, Args)]
pub(crate) struct Explained {
    /// Show these data structures, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend, default_value = "half-edge")]
    pub(crate) backend: Vec<String>,
    /// Show all data structures, side by side where the terminal is wide enough
    #[arg(long, conflicts_with = "backend")]
    pub(crate) all: bool,
    /// First cut every polygon into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

const TRACE_EXAMPLES: &str = "Examples:
  sixfold trace vertex_vertices v3                      a cube in a half-edge mesh
  sixfold trace cube.obj face_faces f0 --all            all structures
  sixfold trace cube.obj edge_faces v0-v1 --backend winged-edge,half-edge
  sixfold trace cube.obj vertex_edges v3 --interactive  step by keys
  sixfold trace --triangulate --edit \"flip_edge v0-v2\"  the rows before and after an edit
  sixfold trace torus.obj --edit \"collapse_edge v0-v1 v0\" --edit compact --all
  sixfold trace VV v0 --triangulate --edit \"flip_edge v0-v2\"  a query after an edit
  sixfold trace --walk \"h = leaving(v3); repeat { yield target(h); h = next(twin(h)) }\"
                --expect \"vertex_vertices v3\"          a walk of your own

An element is named by the numbers that `sixfold inspect` shows: those of the mesh file, from 0,
without the faces that are left out. v3 is a vertex, v0-v1 is the edge between two vertices, f2 is a
face. The relations (also VV, VE and so on) are vertex_vertices,
vertex_edges, vertex_faces, edge_vertices, edge_edges, edge_faces, face_vertices, face_edges and
face_faces. `sixfold tables` shows the rows that a query reads.

Edits: set_position v0 0.5,1,0; add_vertex 0.5,1,0; add_face v0 v1 v2; remove_face f0;
remove_vertex v0; remove_isolated_vertices; split_edge v0-v1; bisect_edge v0-v1; poke_face f0;
split_face f0 v0 v2; dissolve_edge v0-v1; flip_edge v0-v1; collapse_edge v0-v1 v0 (v0 stays);
split_vertex v0 v1 v2 (left and right, none at a boundary); compact. A position x,y,z can follow
each edit that makes or moves a vertex; without it, the middle is taken. New elements get the next
numbers, and an element keeps its name when compact moves it to another row. Rows change if a field
differs, or if the row is made, deleted or moved to another table.

A walk has statements of these forms, with ; between them: h = VALUE; yield VALUE; repeat { … };
if VALUE = VALUE { … } else { … } (also !=). A value is a name such as h, a row such as v3, none, or
a field of a value, such as next(h): a column of `sixfold tables`, with _ for spaces and hyphens, a
table with one column such as leaving, or a short word such as target. A loop ends when the variable
of its last assignment has its first value again, or is none. A loop has no loop inside. Several
fields of the row that was read last are one read.

Exit codes: 0 success, also if an edit is refused; 1 a walk has no answer, or other results than
--expect; 2 wrong usage or unusable input; 3 the structure cannot hold the mesh.";

/// Step through a query or an edit: what it reads and writes, and why.
///
/// The queries and edits are those that programs run. Each read of a query is shown with the reason for
/// which its row is read, and with the line of the algorithm that it belongs to. An edit is shown with
/// the rows before and after it. Without a mesh, the command uses a cube.
#[derive(Debug, Args)]
#[command(after_help = TRACE_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Trace {
    /// The mesh (- for standard input; without it, a cube), the relation, and the element
    #[arg(value_name = "[MESH] RELATION ELEMENT", num_args = 0..=3)]
    pub(crate) query: Vec<OsString>,
    /// Run this edit first; without a query or a walk, show what it does
    #[arg(long, value_name = "EDIT")]
    pub(crate) edit: Vec<String>,
    /// Run this walk in the words of the structure instead of a query
    #[arg(long, value_name = "WALK", conflicts_with = "interactive")]
    pub(crate) walk: Option<String>,
    /// Compare the results of the walk with a relation, such as "vertex_vertices v3"
    #[arg(long, value_name = "RELATION ELEMENT", requires = "walk")]
    pub(crate) expect: Option<String>,
    #[command(flatten)]
    pub(crate) explained: Explained,
    /// Step through the query by keys
    #[arg(short, long, conflicts_with = "json")]
    pub(crate) interactive: bool,
    /// Write the traces as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

const EXPLORE_EXAMPLES: &str = "Examples:
  sixfold explore                           a small mesh
  sixfold explore bunny.obj                 your own mesh
  sixfold explore --lesson flip
  sixfold explore cube.obj -o cube.html --no-open    a page to keep or to publish

The page needs no server and no network. It shows six data structures side by side: it steps through
queries, with the rows that are read and their cost; it edits, subdivides, checks and repairs the mesh;
it runs walks that you write; it has all lessons, and a quiz. Meshes can be dropped on the page. The
page runs Sixfold as WebAssembly, in any browser of 2023 or later.

Exit codes: 0 success; 2 wrong usage or unusable input.";

/// Open a page that shows the structures at work, in the browser.
///
/// Writes one HTML file, prints its path, and opens it in the browser. A mesh has at most 400,000 corners.
#[derive(Debug, Args)]
#[command(after_help = EXPLORE_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Explore {
    /// The mesh; without it, an octahedron
    #[arg(value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,
    /// Write the page to FILE [default: a file in the folder for temporary files]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Do not open the browser
    #[arg(long)]
    pub(crate) no_open: bool,
    /// Open this lesson
    #[arg(long, value_name = "NAME")]
    pub(crate) lesson: Option<String>,
}

const LESSONS_EXAMPLES: &str = "Examples:
  sixfold lessons                           the list
  sixfold lessons around-a-vertex           one lesson, with questions
  sixfold lessons flip --no-wait            all at once
  sixfold lessons half-edge                 a chapter about one structure
  sixfold lessons --export course           the whole course as a site, with the explorer
  sixfold lessons --markdown guide          the whole guide as Markdown, with pictures
  sixfold lessons --check *.json --csv class.csv
      grade the answers of a class

Exit codes: 0 success; 1 not all answers could be graded; 2 wrong usage.";

/// Learn how the structures work: short lessons with questions.
///
/// Each lesson shows meshes and commands, asks questions, checks your answer, and shows its own. A chapter
/// describes one structure: records, invariants, and the costs of queries and edits. Without a name, the
/// command lists the lessons and the chapters. The page of `sixfold explore` runs the same lessons, and saves
/// the answers of a student as a file.
#[derive(Debug, Args)]
#[command(after_help = LESSONS_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Lessons {
    /// The lesson or the chapter
    #[arg(value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// Print everything without waiting for an answer
    #[arg(long)]
    pub(crate) no_wait: bool,
    /// Write all lessons and chapters as a site of static files, with the explorer in each lesson
    #[arg(long, value_name = "DIR", conflicts_with = "name")]
    pub(crate) export: Option<PathBuf>,
    /// Write all lessons and chapters as Markdown pages with the output of their commands, and pictures
    #[arg(long, value_name = "DIR", conflicts_with = "name")]
    pub(crate) markdown: Option<PathBuf>,
    /// Write all lessons as JSON, with the output of their commands, for the explorer (- for standard output)
    #[arg(long, value_name = "FILE", conflicts_with = "name")]
    pub(crate) json: Option<PathBuf>,
    /// Grade files of answers that students exported from the page of `sixfold explore`
    #[arg(long, value_name = "ANSWERS", num_args = 1.., conflicts_with_all = ["name", "export", "markdown", "json"])]
    pub(crate) check: Vec<PathBuf>,
    /// With --check: write each answer as a row of CSV (- for standard output)
    #[arg(long, value_name = "FILE", requires = "check")]
    pub(crate) csv: Option<PathBuf>,
}

/// Parses `3..7`: the rows 3 to 7.
fn rows(text: &str) -> Result<Range<usize>, String> {
    let ends = text.split_once("..").and_then(|(from, to)| {
        let ends = [from, to].map(|end| end.trim().parse::<usize>().ok());
        ends[0].zip(ends[1])
    });
    match ends {
        Some((from, to)) if from <= to => Ok(from..to.saturating_add(1)),
        Some((from, to)) => Err(format!(
            "row {from} comes after row {to}: write {to}..{from}"
        )),
        None => Err("write the first and the last row, such as 100..110".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_row_is_included() {
        assert_eq!(rows("3..7"), Ok(3..8));
        assert_eq!(rows("0 .. 0"), Ok(0..1));
        let reversed = rows("7..3").expect_err("reversed");
        assert_eq!(reversed, "row 7 comes after row 3: write 3..7");
        for text in ["", "3", "..", "3..", "-1..4", "a..b", "3...5"] {
            assert!(rows(text).is_err(), "{text}");
        }
        let last = rows(&format!("0..{}", usize::MAX)).expect("a range");
        assert_eq!(last.end, usize::MAX);
    }
}
