//! Arguments of `sixfold repair`.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, FromArgMatches};
use sixfold::repair::{
    Components, Facing, FillHoles, HoleFilling, OppositeFaces, Step, Tolerance, Weld, WeldMethod,
};

use super::{MeshInOut, ReadFiles, backend};

const EXAMPLES: &str = "Examples:
  sixfold repair scan.obj --for half-edge -o repaired.obj     all that this structure needs
  sixfold repair cad.obj --weld -o welded.obj                 merge vertices at equal positions
  sixfold repair cad.obj --weld 0.01% --for corner-table -o triangles.obj
  sixfold repair part.obj --cut --fill-holes=20 --json report.json -o filled.obj

Steps run in the order of their options on the command line; --for is the last one. Each changes only
what it must: a mesh without faults stays as it is.

STL does not keep cuts: readers join vertices at equal positions. Write PLY or OBJ.

Exit codes: 0 success; 1 the result has no faces, or the STL file that was written does not keep the
repair of --for; 2 wrong usage or unusable input; 3 the mesh cannot be repaired in this way; 4 interrupted, nothing written.";

/// Repair a mesh: weld, orient, cut, fill holes.
///
/// Prints what each step did, and what it could not repair. The input file is never changed.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Repair {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    #[command(flatten)]
    pub(crate) steps: ChosenSteps,
    /// Write the report as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

/// The chosen steps, in the order of their options.
#[derive(Clone, Debug)]
pub(crate) struct ChosenSteps {
    pub(crate) steps: Vec<Step>,
    /// The structure of `--for`, which comes last.
    pub(crate) structure: Option<String>,
}

// The options of the steps.
#[derive(Debug, Args)]
struct StepOptions {
    /// Merge vertices within a distance: a length, such as 0.01, or a part of the diagonal of the
    /// box, such as 0.01% [without a distance: 0]
    #[arg(long, value_name = "DISTANCE", num_args = 0..=1, require_equals = true, default_missing_value = "0", value_parser = tolerance)]
    weld: Option<Tolerance>,
    /// How --weld finds vertices: grid or kd-tree
    #[arg(long, value_name = "NAME", default_value = "grid")]
    weld_method: WeldMethod,
    /// Remove faces that repeat another face
    #[arg(long)]
    duplicates: bool,
    /// Remove pairs of faces with the same vertices in opposite order, too
    #[arg(long)]
    opposite: bool,
    /// Remove faces without area
    #[arg(long)]
    flat: bool,
    /// Remove components with fewer faces than this
    #[arg(long, value_name = "FACES")]
    components: Option<usize>,
    /// Cut polygons into triangles
    #[arg(long)]
    triangulate: bool,
    /// Flip faces until they agree: majority (like most faces) or outward
    #[arg(long, value_name = "RULE")]
    orient: Option<Facing>,
    /// Cut non-manifold edges and vertices
    #[arg(long)]
    cut: bool,
    /// Fill holes, or only those with at most EDGES edges
    #[arg(long, value_name = "EDGES", num_args = 0..=1, require_equals = true, default_missing_value = ALL_HOLES, value_parser = hole_limit)]
    fill_holes: Option<HoleLimit>,
    /// Triangles in holes: smallest (area) or ears
    #[arg(long, value_name = "NAME", default_value = "smallest")]
    hole_method: HoleFilling,
    /// Remove vertices without a face
    #[arg(long)]
    isolated: bool,
    /// Repair what this structure refuses
    #[arg(long = "for", value_name = "NAME", value_parser = backend)]
    structure: Option<String>,
}

impl StepOptions {
    /// Returns each step, with the names of the arguments that choose it.
    fn steps(&self) -> Vec<(&'static [&'static str], Step)> {
        let weld = self.weld.map(|tolerance| {
            let method = self.weld_method;
            Step::Weld(Weld { tolerance, method })
        });
        let opposite = match self.opposite {
            true => OppositeFaces::Remove,
            false => OppositeFaces::Keep,
        };
        let duplicates = self.duplicates || self.opposite;
        let orient = self.orient.map(|facing| Step::Orient {
            facing,
            which: Components::All,
        });
        let holes = self.fill_holes.map(|HoleLimit(max_edges)| {
            Step::FillHoles(FillHoles {
                max_edges,
                method: self.hole_method,
            })
        });
        let components = self
            .components
            .map(|min_faces| Step::RemoveSmallComponents { min_faces });
        let steps: [(&[&str], Option<Step>); 9] = [
            (&["weld"], weld),
            (
                &["duplicates", "opposite"],
                duplicates.then_some(Step::RemoveDuplicateFaces(opposite)),
            ),
            (&["flat"], self.flat.then_some(Step::RemoveFlatFaces)),
            (&["components"], components),
            (
                &["triangulate"],
                self.triangulate.then_some(Step::Triangulate),
            ),
            (&["orient"], orient),
            (&["cut"], self.cut.then_some(Step::Cut)),
            (&["fill_holes"], holes),
            (
                &["isolated"],
                self.isolated.then_some(Step::RemoveIsolatedVertices),
            ),
        ];
        let chosen = steps.into_iter();
        chosen
            .filter_map(|(names, step)| Some((names, step?)))
            .collect()
    }
}

impl FromArgMatches for ChosenSteps {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let options = StepOptions::from_arg_matches(matches)?;
        // The place of the first of these arguments on the command line.
        let place = |names: &[&str]| {
            let given = names
                .iter()
                .filter(|name| matches.value_source(name) == Some(ValueSource::CommandLine));
            given.filter_map(|name| matches.index_of(name)).min()
        };
        let mut steps = options.steps();
        steps.sort_by_key(|(names, _)| place(names));
        let last = steps
            .last()
            .and_then(|(names, _)| Some((place(names)?, names[0])));
        if let (Some(place), Some((after, name))) = (place(&["structure"]), last)
            && after > place
        {
            let name = name.replace('_', "-");
            return Err(clap::Error::raw(
                ErrorKind::ArgumentConflict,
                format!("--for is the last step: write it after --{name}"),
            ));
        }
        Ok(Self {
            steps: steps.into_iter().map(|(_, step)| step).collect(),
            structure: options.structure,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for ChosenSteps {
    fn augment_args(command: clap::Command) -> clap::Command {
        StepOptions::augment_args(command)
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        StepOptions::augment_args_for_update(command)
    }
}

/// Returns the options that choose these steps; the inverse of [`Repair::steps`] for steps with the
/// settings of [`FaultKind::repairs`](sixfold::repair::FaultKind::repairs).
pub(crate) fn repair_options(steps: &[Step]) -> String {
    let option = |step: &Step| {
        let option = match step {
            Step::Weld(Weld {
                tolerance: Tolerance::Absolute(distance),
                ..
            }) => return format!("--weld={distance}"),
            Step::Weld(_) => "--weld",
            Step::RemoveDuplicateFaces(OppositeFaces::Keep) => "--duplicates",
            Step::RemoveDuplicateFaces(OppositeFaces::Remove) => "--opposite",
            Step::RemoveFlatFaces => "--flat",
            Step::Triangulate => "--triangulate",
            Step::Orient { facing, .. } => match facing {
                Facing::Majority => "--orient majority",
                Facing::Outward => "--orient outward",
            },
            Step::Cut => "--cut",
            Step::FillHoles(_) => "--fill-holes",
            Step::RemoveIsolatedVertices => "--isolated",
            _ => unreachable!("no kind of fault needs the step {step}"),
        };
        option.to_owned()
    };
    steps.iter().map(option).collect::<Vec<_>>().join(" ")
}

/// Joins the optional values of `--weld` and `--fill-holes` to their options, if the next word is such
/// a value: `--weld 0.01` becomes `--weld=0.01`, but `--weld mesh.obj` stays. Only for `sixfold repair`.
pub(crate) fn joined_values(words: Vec<OsString>) -> Vec<OsString> {
    if words.get(1).is_none_or(|word| word != "repair") {
        return words;
    }
    let mut joined: Vec<OsString> = Vec::with_capacity(words.len());
    for word in words {
        let text = word.to_str().unwrap_or("");
        let takes = match joined.last().and_then(|last| last.to_str()) {
            Some("--weld") => tolerance(text).is_ok(),
            Some("--fill-holes") => text.parse::<usize>().is_ok(),
            _ => false,
        };
        match joined.last_mut() {
            Some(last) if takes => {
                last.push("=");
                last.push(word);
            }
            _ => joined.push(word),
        }
    }
    joined
}

/// The value of `--fill-holes` without a value. It has one, so that the option has a place among the
/// others.
const ALL_HOLES: &str = "all";

/// The most edges of a hole that is filled, if there is a limit.
#[derive(Clone, Copy, Debug)]
struct HoleLimit(Option<usize>);

fn hole_limit(text: &str) -> Result<HoleLimit, String> {
    match text.trim() {
        ALL_HOLES => Ok(HoleLimit(None)),
        edges => match edges.parse() {
            Ok(edges) => Ok(HoleLimit(Some(edges))),
            Err(_) => Err("write a number of edges, such as 20".to_owned()),
        },
    }
}

/// Parses a distance, or a part of the diagonal in percent.
fn tolerance(text: &str) -> Result<Tolerance, String> {
    let (number, is_relative) = match text.trim().strip_suffix('%') {
        Some(number) => (number, true),
        None => (text.trim(), false),
    };
    match number.parse::<f64>() {
        Ok(0.0) => Ok(Tolerance::Exact),
        Ok(value) if is_relative => Ok(Tolerance::Relative(value / 100.0)),
        Ok(value) => Ok(Tolerance::Absolute(value)),
        Err(_) => Err("write a distance, such as 0.01, or a percentage of the diagonal of the bounding box, such as 0.01%".into()),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use sixfold::repair::FaultKind;

    use super::*;
    use crate::arguments::{Arguments, Command};

    #[test]
    fn options_choose_the_steps_that_repair_a_fault() {
        for kind in FaultKind::ALL {
            let steps = kind.repairs();
            let line = format!("sixfold repair a.obj {} -o b.obj", repair_options(&steps));
            let arguments = Arguments::try_parse_from(line.split_whitespace());
            match arguments.expect("valid options").command {
                Some(Command::Repair(repair)) => assert_eq!(repair.steps.steps, steps, "{line}"),
                other => panic!("{other:?}"),
            }
        }
    }

    fn parsed(line: &str) -> Result<ChosenSteps, clap::Error> {
        let line = format!("sixfold repair a.obj {line} -o b.obj");
        let arguments = Arguments::try_parse_from(line.split_whitespace())?;
        match arguments.command {
            Some(Command::Repair(repair)) => Ok(repair.steps),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn values_of_options_may_be_separate_words() {
        let joined = |line: &str| {
            let words = line.split(' ').map(OsString::from).collect();
            let words = joined_values(words).into_iter();
            words
                .map(|word| word.into_string().expect("text"))
                .collect::<Vec<_>>()
                .join(" ")
        };
        for (line, expected) in [
            (
                "sixfold repair --weld 0.01 a",
                "sixfold repair --weld=0.01 a",
            ),
            ("sixfold repair --weld 1% a", "sixfold repair --weld=1% a"),
            (
                "sixfold repair --weld a.obj -o b",
                "sixfold repair --weld a.obj -o b",
            ),
            (
                "sixfold repair --fill-holes 20 --weld",
                "sixfold repair --fill-holes=20 --weld",
            ),
            (
                "sixfold repair --fill-holes 2.5",
                "sixfold repair --fill-holes 2.5",
            ),
            ("sixfold study --weld 3", "sixfold study --weld 3"),
        ] {
            assert_eq!(joined(line), expected);
        }
    }

    #[test]
    fn steps_run_in_the_order_of_their_options() {
        let titles = |line: &str| {
            let chosen = parsed(line).expect("valid options");
            let titles = chosen.steps.iter().map(Step::title);
            titles.collect::<Vec<_>>().join(", ")
        };
        assert_eq!(titles("--cut --weld"), "cut into manifolds, weld vertices");
        assert_eq!(
            titles("--weld=0.1 --cut"),
            "weld vertices, cut into manifolds"
        );
        assert_eq!(
            titles("--isolated --opposite --fill-holes=3 --duplicates --orient outward"),
            "remove isolated vertices, remove duplicate faces, fill holes, orient faces"
        );
        assert_eq!(
            titles("--flat --for half-edge"),
            "remove faces without area"
        );
        let error = parsed("--for half-edge --fill-holes").expect_err("--for is not the last");
        let message = "--for is the last step: write it after --fill-holes";
        assert!(error.to_string().contains(message), "{error}");
    }
}
