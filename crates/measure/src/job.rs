//! Jobs that a backend (such as a mesh data structure) runs and times, and the results of jobs.

use sixfold::{QueryCost, Relation};

use crate::operation::Operation;
use crate::series::Series;
use sixfold_results::Time;

/// The work that one run of a job does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Task {
    /// Runs an operation on the whole mesh.
    Operation(Operation),
    /// Runs one turn of a mix. A turn is a fixed number of operations, divided among the kinds of
    /// operations by weight. If the mix has edits, one run does several turns on a restored copy of
    /// the mesh.
    Mix,
    /// Runs one operation of one part of the mix. A part is a kind of operation. The field is the
    /// index of the part in the mix.
    Part(usize),
    /// Runs a program of a user once.
    Program,
}

impl Task {
    /// Returns the operation; `None` for a mix, a part of a mix, or a program.
    pub const fn operation(self) -> Option<Operation> {
        match self {
            Self::Operation(operation) => Some(operation),
            Self::Mix | Self::Part(_) | Self::Program => None,
        }
    }

    /// Returns true if a run makes another mesh, by subdivision or by edits.
    pub fn creates_mesh(self) -> bool {
        self.operation().is_some_and(Operation::creates_mesh)
    }

    /// Returns true if a run enlarges tables that the next run reuses.
    pub fn grows_tables(self) -> bool {
        self.operation().is_some_and(Operation::grows_tables)
    }

    /// Returns true if the timed part of a run allocates memory.
    pub fn allocates(self) -> bool {
        self.operation().is_some_and(Operation::allocates)
    }
}

/// A job to run: a task on all elements of a mesh, or on a sample of the elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Job {
    /// The work of one run.
    pub task: Task,
    /// The sample of the elements on which the task runs; `None` to run the task on all elements.
    /// Only [`Task::Operation`] can run on a sample.
    pub sample: Option<ElementSample>,
    /// The number of the first run, counted from 0. The count includes untimed runs. Each run of a
    /// mix visits the elements that follow the elements of the previous run. For an operation, all
    /// runs are equal, so this field has no effect.
    pub first: u64,
}

impl Job {
    /// Makes a job that runs `task` on all elements.
    pub fn new(task: Task) -> Self {
        Self {
            task,
            sample: None,
            first: 0,
        }
    }
}

impl From<Operation> for Job {
    fn from(operation: Operation) -> Self {
        Self::new(Task::Operation(operation))
    }
}

/// A sample of the elements. If the queries at elements of one kind scan the mesh, only the first
/// elements of this kind in a random order are visited. Subdivisions and edit passes run on a
/// separate mesh of about `size` faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElementSample {
    /// One value for each kind of element (vertex, edge, face). The value is true if only a sample
    /// of this kind is visited, and false if all elements of this kind are visited.
    pub scanned: [bool; 3],
    /// The number of elements in the sample of each kind. If the mesh has fewer elements, all
    /// elements are visited.
    pub size: usize,
}

/// The time and the result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedRun {
    /// The time of one run of the whole task. If the task ran on a sample of the elements, the time
    /// is an estimate for all elements.
    pub time: Time,
    /// The result of the task; `None` if the result was not requested.
    pub outcome: Option<Outcome>,
    /// The reason why this structure cannot run the task on this mesh; `None` if the task was run.
    /// If there is a reason, the field `time` has no meaning.
    pub refusal: Option<String>,
}

impl TimedRun {
    /// Makes the record of a run that the backend completed.
    pub fn done(time: Time, outcome: Option<Outcome>) -> Self {
        Self {
            time,
            outcome,
            refusal: None,
        }
    }

    /// Makes the record of a run that the backend refused.
    pub fn refused(reason: String, series: &Series<'_>) -> Self {
        Self {
            time: Time::zero_like(series.clock.now()),
            outcome: None,
            refusal: Some(reason),
        }
    }
}

/// The result of a task.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// A number computed from all results. The order in which queries list neighbours does not
    /// change the number. For a mix or a part of a mix, the checksum is the number of elements that
    /// the queries yield.
    pub checksum: f64,
    /// The number of elements that one run visits. For a mix, the field is the number of operations
    /// in one run. If an operation ran on a sample, the number is scaled to all elements, except
    /// for subdivisions and edit passes.
    pub elements: u64,
    /// A hash of the edits that the backend refuses in one run of an edit pass; 0 if it refuses no
    /// edit, and for other tasks.
    pub refused: u64,
}

impl Outcome {
    /// Makes the result of a program: a number computed from all results, and the number of elements
    /// that the program visits.
    pub const fn new(checksum: f64, elements: u64) -> Self {
        Self {
            checksum,
            elements,
            refused: 0,
        }
    }
}

/// A backend that is ready to be timed: a structure built from a mesh, relation tables, or an
/// external program. Tests can also implement this trait.
pub trait TimedBackend {
    /// Returns the name that users write for the backend.
    fn name(&self) -> &str;
    /// Returns true if the backend is an external program. An external program runs only operations
    /// on whole meshes. The results of other backends are not compared with the results of an
    /// external program.
    fn is_external(&self) -> bool {
        false
    }
    /// Returns why the backend can run nothing any more: an external program that failed. `None` if it can.
    fn failure(&self) -> Option<&str> {
        None
    }
    /// Returns whether the backend can run an operation on a sample of the elements.
    fn can_sample(&self) -> bool {
        true
    }
    /// Returns for each of the nine relations which part of the mesh a query of the relation
    /// visits.
    fn costs(&self) -> [QueryCost; 9];
    /// Returns the number of input vertices that were merged with other vertices.
    fn merged_vertices(&self) -> usize;
    /// Returns the relations of which the backend consists; empty for a structure.
    fn tabulated(&self) -> Vec<Relation> {
        Vec::new()
    }
    /// Returns the bytes of the tables of the backend.
    fn bytes(&self) -> usize;
    /// Builds the backend again from the same polygons at other memory addresses. The times of some
    /// operations depend slightly on the addresses and pages of the tables. The default
    /// implementation does nothing, for backends that are not built from polygons.
    fn rebuild(&mut self) {}
    /// Runs `job` and returns the time of one run. `series` gives the number of runs and the state
    /// of the caches at the start. If the job runs on a sample of the elements, `series` may
    /// contain only one run.
    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun;
}
