//! From request to response, both JSON: for pages, and for programs in other languages.

mod kept;
mod refinement;
mod response;
mod source;
mod welding;

use std::fmt::{self, Display};

use serde::Deserialize;
use serde_json::json;
use sixfold::io::parse_creases;
use sixfold::repair::{Fault, diagnose, repair_for};
use sixfold::subdivision::Scheme;
use sixfold::{Facts, PolygonMesh, Relation, StructureInfo, UnknownName, structure_infos};
use sixfold_core::{EditByName, EditTextError};

use crate::built_mesh::Geometry;
use crate::error::{ExplainError, Refused};
use crate::records::{Records, row_name};
use crate::structure::Structure;
use kept::{EditedMesh, Kept};
use refinement::{levels, stencil};
use response::{Answer, Content, Found, Response, Verdict};
use source::{MeshSource, SHOWN, Sourced};
use welding::welded;

/// Maximum number of places that a response lists for each kind of fault.
const MOST_PLACES: usize = 1_000;

/// Maximum number of rows of a table, if the request does not name the rows.
const MOST_ROWS: u32 = 200;

/// Maximum number of rows that a request names.
const MOST_NAMES: usize = 2_000;

/// The error of a request that changes the kept mesh.
const TOO_LATE: &str = "`triangulate` and `creases` come with a mesh, and the last mesh keeps its own: leave them out, \
                        or send the mesh again";

/// The error of a request about the last mesh, if the engine has none.
const NO_LAST: &str = "there is no last mesh: send the mesh with the first request";

/// Maximum number of queries of a sweep.
const MOST_QUERIES: u32 = 10_000_000;

/// What a request about a mesh says if it has edits.
const AFTER_EDITS: &str = "this is asked of a mesh without edits: ask for the geometry after the edits, and \
                           send it as polygons";

/// An error of a request: its message is the response.
type Error = Box<dyn std::error::Error>;

/// What the page or program asks. It names everything that the answer depends on.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a request")]
struct Request {
    mesh: MeshSource,
    /// Cuts every polygon into triangles first.
    #[serde(default)]
    triangulate: Option<bool>,
    /// Sharp edges and corners, as a crease file.
    #[serde(default)]
    creases: Option<String>,
    /// The edits before what is asked, in their order.
    #[serde(default)]
    edits: Vec<String>,
    /// The structures; all if missing.
    #[serde(default)]
    structures: Option<Vec<String>>,
    ask: Ask,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Ask {
    Tables {
        /// The first and the last row.
        #[serde(default)]
        rows: Option<[u32; 2]>,
        /// The names of the rows.
        #[serde(default)]
        names: Option<Vec<String>>,
    },
    Trace(Query),
    Edit(String),
    Walk {
        walk: String,
        #[serde(default)]
        expect: Option<Query>,
    },
    Geometry,
    Sweep {
        relation: Relation,
        queries: u32,
    },
    Memory,
    Facts,
    Verdicts,
    Repair,
    Weld {
        tolerance: f64,
    },
    Subdivide {
        scheme: String,
        levels: u32,
    },
    Stencil {
        scheme: String,
        level: u32,
        point: u32,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Query {
    relation: Relation,
    element: String,
}

/// Answers a request, without a mesh from an earlier one. Both are JSON.
///
/// A request names the mesh, the structures, and what is asked. The response depends on nothing else: to
/// undo an edit, a request leaves it out. An [`Engine`] gives the same responses, and saves the time to
/// read and build a mesh again.
///
/// ```
/// use sixfold_explain::respond;
///
/// let response = respond(
///     r#"{"mesh": {"shape": {"name": "cube"}}, "structures": ["half-edge"],
///         "ask": {"trace": {"relation": "vertex_vertices", "element": "v3"}}}"#,
/// );
/// assert!(response.starts_with(r#"{"answers":[{"backend":"half-edge","#), "{response}");
/// assert!(response.contains(r#""reads":4,"#), "{response}");
///
/// let response = respond(r#"{"mesh": {"shape": {"name": "cub"}}, "ask": "facts"}"#);
/// assert!(response.starts_with(r#"{"error":"no shape is called `cub`"#), "{response}");
/// ```
///
/// # Request
///
/// | field | value |
/// |---|---|
/// | `mesh` | `{"shape": {"name": "torus", "parameters": {"m": 8}}}`, a shape of `sixfold generate`; `{"file": {"name": "a.obj", "text": "…"}}`, or `"base64"` for a binary file; `{"polygons": {"positions": [[0, 0, 0], …], "faces": [[0, 1, 2], …]}}`, in which `null` is a number without an element; `"last"`, the mesh that the [`Engine`] keeps |
/// | `triangulate` | `true` cuts every polygon into triangles; not with the mesh `"last"` |
/// | `creases` | sharp edges and corners, as the text of a crease file ([`parse_creases`]); they are added to those of the mesh file; not with the mesh `"last"` |
/// | `edits` | edits before what is asked, as text ([`EditByName`](crate::EditByName)) |
/// | `structures` | names; all six if missing |
/// | `ask` | one of the following |
///
/// | `ask` | each answer, or the response |
/// |---|---|
/// | `{"tables": {"rows": [0, 20]}}` | for each structure the [`Records`](crate::Records) from the first to the last of these rows; without `rows`, the first 200. `moved` has the rows in them that an edit moved ([`BuiltMesh::moved_rows`](crate::BuiltMesh::moved_rows)) |
/// | `{"tables": {"names": ["h5", "v3"]}}` | for each structure those [`Records`](crate::Records) that have one of these names, in the order of the rows; at most 2,000 names, of which a structure ignores those that it does not have |
/// | `{"trace": {"relation": "vertex_faces", "element": "v3"}}` | a [`Trace`](crate::Trace) |
/// | `{"edit": "flip_edge v0-v1"}` | an [`EditTrace`](crate::EditTrace) with at most 2,000 entries in each list |
/// | `{"walk": {"walk": "…", "expect": {"relation": …, "element": …}}}` | a [`Walk`](crate::Walk) |
/// | `"geometry"` | for each structure the [`Geometry`] after the edits |
/// | `{"sweep": {"relation": "vertex_faces", "queries": 1000}}` | for each structure the number of `results` of so many queries, from one element to the next and from the first again after the last; for pages that measure the time. At most 10,000,000 queries |
/// | `"memory"` | for each structure the [`Memory`](crate::Memory): the bytes of the mesh, each table with its rows and the bytes of a row, and the formula |
/// | `"facts"` | `{"facts": …}`: [`Facts`] of the mesh |
/// | `"verdicts"` | `{"verdicts": …, "faults": …}`: which structures hold the mesh, and all kinds of faults with the number of places and the first 1,000 |
/// | `"repair"` | for each structure the steps, and the repaired mesh. A step has its `counts`, and in `left` a sentence for each place that it could not repair |
/// | `{"weld": {"tolerance": 0.01}}` | `{"weld": {"corners": 24, "vertices": 8, "map": [0, 1, …], …}}`: the corners of all faces as a polygon soup stores them, one after the other, and the vertices that they become if corners within a distance are merged; 0 merges equal positions. `map` has the vertex of each of the first 2,000 corners; vertices have numbers in the order of their first corners. `faces_changed` counts the faces that then have fewer corners or are lost, and `largest_shift` is the largest distance of a corner from its vertex |
/// | `{"subdivide": {"scheme": "loop", "levels": 2}}` | `{"levels": …}`: the mesh before the first step, and after each step |
/// | `{"stencil": {"scheme": "loop", "level": 1, "point": 8}}` | `{"parents": …}`: the points of the level before with their weights, without those below 10⁻⁷ |
///
/// Points have the numbers of `sixfold subdivide --backend face-vertex --method gather`.
///
/// # Response
///
/// `{"answers": […], "refused": […]}` if structures answer. A structure that cannot hold the mesh, does
/// not have the element, or refuses one of `edits`, is in `refused` with its reason. `holding_triangles` lists
/// those of the refusing structures that hold the mesh if its polygons are cut into triangles (`triangulate`);
/// the field is missing if there are none. `{"error": "…"}` for a request that is wrong. `notes` lists what
/// reading the mesh left out or changed.
///
/// Memory, facts, verdicts, repairs, welding and subdivision are those of the mesh without edits: send the
/// geometry after the edits as polygons. A mesh has at most 400,000 corners, also after a subdivision step; there are at
/// most 16 levels, and weights in meshes of at most 20,000 vertices.
pub fn respond(request: &str) -> String {
    Engine::new().respond(request)
}

/// Answers requests about a mesh, one after the other, and keeps this mesh and its structures.
///
/// The last mesh is that of the latest request that brought one and whose response is not an `error`, after
/// its `triangulate` and `creases`. A later request can name it: `"mesh": "last"`. The response is the same
/// as that of [`respond`] for the whole mesh, also its `notes`, but the mesh is not read again.
///
/// The engine also keeps each structure that was built from the last mesh, with the edits that it has run:
/// those of `edits`, and the edit of the question `edit` if the structure accepted it. If the `edits` of a
/// request begin with these, only the others are run. Otherwise the structure is built again. So a page that
/// adds an edit at the end of its list pays only for this edit, and undoing an edit costs a new structure
/// and the edits before it.
///
/// ```
/// use sixfold_explain::Engine;
///
/// let mut engine = Engine::new();
/// let missing = engine.respond(r#"{"mesh": "last", "ask": "facts"}"#);
/// assert!(missing.starts_with(r#"{"error":"there is no last mesh"#), "{missing}");
///
/// engine.respond(r#"{"mesh": {"shape": {"name": "octahedron"}}, "ask": {"edit": "poke_face f0"}}"#);
/// // The structures have run this edit already.
/// let trace = engine.respond(
///     r#"{"mesh": "last", "edits": ["poke_face f0"],
///         "ask": {"trace": {"relation": "vertex_edges", "element": "v6"}}}"#,
/// );
/// assert!(trace.starts_with(r#"{"answers":[{"#), "{trace}");
/// ```
///
/// # Complexity
///
/// For a mesh of n corners whose structures have run `edits`, tables, traces and walks cost the rows that they
/// read or show; the soup and the indexed face set read all rows in many traces. The other questions are O(n)
/// or more, also `edit`, which compares all rows.
#[derive(Default)]
pub struct Engine {
    kept: Option<Kept>,
}

impl Engine {
    /// Returns an engine without a mesh.
    pub const fn new() -> Self {
        Self { kept: None }
    }

    /// Answers a request; [`respond`] describes requests and responses.
    pub fn respond(&mut self, request: &str) -> String {
        let read = serde_json::from_str(request);
        let read = read.map_err(|error| Error::from(format!("the request: {error}")));
        let answered = read.and_then(|request: Request| self.answer(&request));
        let response = answered.unwrap_or_else(|error| Response {
            content: Content::Error {
                error: error.to_string(),
            },
            notes: Vec::new(),
        });
        let written = serde_json::to_string(&response);
        written.unwrap_or_else(|error| json!({ "error": error.to_string() }).to_string())
    }

    fn answer(&mut self, request: &Request) -> Result<Response, Error> {
        let Some(sourced) = request.mesh()? else {
            return request.answer(self.kept.as_mut().ok_or(NO_LAST)?);
        };
        // The new mesh needs the memory of the old structures.
        if let Some(old) = &mut self.kept {
            old.free_structures();
        }
        let mut kept = Kept::new(sourced);
        let response = request.answer(&mut kept)?;
        self.kept = Some(kept);
        Ok(response)
    }
}

impl fmt::Debug for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Engine").finish_non_exhaustive()
    }
}

impl Request {
    /// Reads the mesh of the request; `None` if it is the one that the engine keeps.
    fn mesh(&self) -> Result<Option<Sourced>, Error> {
        let Some(mut sourced) = self.mesh.read()? else {
            if self.triangulate.is_some() || self.creases.is_some() {
                return Err(TOO_LATE.into());
            }
            return Ok(None);
        };
        if self.triangulate == Some(true) {
            let cut = sourced.polygons.triangulated()?;
            sourced.polygons = cut.polygons;
            let crossing = cut
                .crossing
                .iter()
                .take(SHOWN)
                .map(|face| format!("face {face} crosses itself, so its triangles overlap"));
            sourced.notes.extend(crossing);
        }
        if let Some(text) = &self.creases {
            let listed = parse_creases("creases", text.as_bytes(), &sourced.polygons)?;
            sourced.creases = sourced.creases.updated_with(&listed);
        }
        Ok(Some(sourced))
    }

    /// Answers the request about a mesh.
    fn answer(&self, kept: &mut Kept) -> Result<Response, Error> {
        let edits = self.edits.iter().enumerate().map(|(i, edit)| {
            edit.parse()
                .map_err(|error: EditTextError| format!("edits, number {}: {error}", i + 1))
        });
        let mut subject = Subject {
            structures: self.chosen(Structure::all(), Structure::name)?,
            infos: self.chosen(structure_infos(), |info| info.name)?,
            edits: edits.collect::<Result<_, _>>()?,
            kept,
        };
        let content = match &self.ask {
            Ask::Tables { rows, names } => subject.tables(*rows, names.as_deref())?,
            Ask::Trace(query) => subject.trace(query.parsed()?),
            Ask::Edit(edit) => subject.edit(&edit.parse()?),
            Ask::Walk { walk, expect } => {
                subject.walk(walk, expect.as_ref().map(Query::parsed).transpose()?)
            }
            Ask::Geometry => subject.geometry(),
            _ if !self.edits.is_empty() => return Err(AFTER_EDITS.into()),
            Ask::Sweep { relation, queries } => subject.sweep(*relation, *queries)?,
            Ask::Memory => subject.memory(),
            Ask::Weld { tolerance } => Content::Weld {
                weld: welded(subject.polygons(), *tolerance)?,
            },
            Ask::Facts => Content::Facts {
                facts: Facts::from_polygons(subject.polygons()),
            },
            Ask::Verdicts => subject.verdicts(),
            Ask::Repair => subject.repair(),
            Ask::Subdivide { scheme, levels } => subject.subdivide(scheme.parse()?, *levels)?,
            Ask::Stencil {
                scheme,
                level,
                point,
            } => subject.stencil(scheme.parse()?, *level, *point)?,
        };
        let notes = subject.kept.sourced.notes.clone();
        Ok(Response { content, notes })
    }

    /// Returns the structures that the request names.
    fn chosen<T>(
        &self,
        all: Vec<T>,
        name: impl Fn(&T) -> &'static str,
    ) -> Result<Vec<T>, UnknownName> {
        let Some(wanted) = &self.structures else {
            return Ok(all);
        };
        for wanted in wanted {
            if !all.iter().any(|one| name(one) == wanted) {
                let known = all.iter().map(name);
                return Err(UnknownName::new("structure", wanted, known));
            }
        }
        let is_wanted = |one: &T| wanted.iter().any(|wanted| wanted == name(one));
        Ok(all.into_iter().filter(is_wanted).collect())
    }
}

impl Query {
    fn parsed(&self) -> Result<crate::Query, ExplainError> {
        Ok((self.relation, self.element.parse()?))
    }
}

/// What a request asks about.
struct Subject<'k> {
    kept: &'k mut Kept,
    edits: Vec<EditByName>,
    structures: Vec<Structure>,
    infos: Vec<StructureInfo>,
}

/// Collects the answers of the structures, and the reasons of those that have none.
fn each<E: Display>(
    structures: &[Structure],
    mut answer: impl FnMut(&Structure) -> Result<Answer, E>,
) -> Content {
    let (mut answers, mut refused) = (Vec::new(), Vec::new());
    for structure in structures {
        match answer(structure) {
            Ok(answer) => answers.push(answer),
            Err(error) => refused.push(Refused {
                structure: structure.name(),
                reason: error.to_string(),
            }),
        }
    }
    Content::Structures {
        answers,
        refused,
        holding_triangles: Vec::new(),
    }
}

fn tables(structure: &Structure, edited: &EditedMesh, records: Vec<Records>) -> Answer {
    Answer::Tables {
        backend: structure.name(),
        moved: edited.mesh().moved_rows_in(&records),
        records,
    }
}

impl Subject<'_> {
    fn polygons(&self) -> &PolygonMesh {
        &self.kept.sourced.polygons
    }

    /// Collects the answers of the structures after the edits.
    fn each_built(
        &mut self,
        answer: impl Fn(&Structure, &mut EditedMesh) -> Result<Answer, ExplainError>,
    ) -> Content {
        let mut content = each(&self.structures, |structure| {
            self.kept
                .with_built(structure, &self.edits, |mesh| answer(structure, mesh))
        });
        if let Content::Structures {
            refused,
            holding_triangles,
            ..
        } = &mut content
        {
            let names = refused.iter().map(|refused| refused.structure);
            let names = names.filter(|name| self.kept.holds_only_triangles(name));
            *holding_triangles = names.collect();
        }
        content
    }

    fn tables(
        &mut self,
        rows: Option<[u32; 2]>,
        names: Option<&[String]>,
    ) -> Result<Content, Error> {
        let [first, last] = match (rows, names) {
            (Some(_), Some(_)) => return Err("tables have either rows or names".into()),
            (None, Some(names)) => return self.named_rows(names),
            (rows, None) => rows.unwrap_or([0, MOST_ROWS - 1]),
        };
        if first > last {
            return Err(
                format!("row {first} comes after row {last}: ask for [{last}, {first}]").into(),
            );
        }
        let rows = first as usize..(last as usize).saturating_add(1);
        Ok(self.each_built(|structure, edited| {
            Ok(tables(
                structure,
                edited,
                edited.mesh().records(rows.clone()),
            ))
        }))
    }

    fn named_rows(&mut self, names: &[String]) -> Result<Content, Error> {
        if names.len() > MOST_NAMES {
            let count = names.len();
            return Err(format!("a request has at most {MOST_NAMES} names, not {count}").into());
        }
        if let Some(name) = names.iter().find(|name| row_name(name).is_none()) {
            return Err(format!("`{name}` names no row: write h5").into());
        }
        Ok(self.each_built(|structure, edited| {
            let names = names.iter().map(String::as_str);
            Ok(tables(
                structure,
                edited,
                edited.mesh().named_records(names),
            ))
        }))
    }

    fn trace(&mut self, (relation, element): crate::Query) -> Content {
        self.each_built(|_, edited| {
            let trace = edited.mesh().trace(relation, element);
            trace.map(Answer::Trace)
        })
    }

    fn walk(&mut self, walk: &str, expected: Option<crate::Query>) -> Content {
        self.each_built(|_, edited| {
            let walk = edited.mesh().walk(walk, expected);
            walk.map(Answer::Walk)
        })
    }

    fn edit(&mut self, edit: &EditByName) -> Content {
        self.each_built(|_, edited| edited.edit(edit).map(Answer::Edit))
    }

    fn geometry(&mut self) -> Content {
        self.each_built(|structure, edited| {
            Ok(Answer::Geometry {
                backend: structure.name(),
                geometry: edited.mesh().geometry(),
            })
        })
    }

    /// Returns the bytes of the tables of each structure.
    fn memory(&mut self) -> Content {
        self.each_built(|_, edited| Ok(Answer::Memory(edited.mesh().memory())))
    }

    /// Returns which structures hold the mesh, and all faults of the mesh.
    fn verdicts(&self) -> Content {
        let diagnosis = diagnose(self.polygons(), MOST_PLACES);
        let verdict = |info: &StructureInfo| {
            let refusal = info.capabilities.check(self.polygons()).err();
            let faults = diagnosis.refusals(&info.capabilities);
            let structure = self.structures.iter().find(|one| one.name() == info.name);
            Verdict {
                backend: info.name,
                holds: refusal.is_none(),
                reason: refusal
                    .zip(structure)
                    .map(|(refusal, structure)| structure.refusal(refusal).to_string()),
                faults: faults.map(|fault| fault.kind).collect(),
            }
        };
        let fault = |fault: &Fault| Found {
            kind: fault.kind,
            title: fault.kind.titles()[usize::from(fault.count != 1)],
            count: fault.count,
            places: fault.places.clone(),
            repairs: diagnosis.repairs(fault.kind),
        };
        Content::Verdicts {
            verdicts: self.infos.iter().map(verdict).collect(),
            faults: diagnosis.faults.iter().map(fault).collect(),
        }
    }

    /// Returns the repairs that each structure needs, and the mesh that it then holds.
    fn repair(&self) -> Content {
        each(&self.structures, |structure| {
            let backend = structure.name();
            let info = self.infos.iter().find(|info| info.name == backend);
            let info = info.expect("the same structures");
            repair_for(self.polygons(), &info.capabilities).map(|repaired| Answer::Repair {
                backend,
                geometry: Geometry::from_polygons(&repaired.polygons),
                steps: repaired.steps.iter().map(Into::into).collect(),
            })
        })
    }

    fn sweep(&mut self, relation: Relation, queries: u32) -> Result<Content, Error> {
        if queries > MOST_QUERIES {
            return Err(
                format!("a sweep has at most {MOST_QUERIES} queries, not {queries}").into(),
            );
        }
        let Self {
            structures, kept, ..
        } = self;
        Ok(each(structures, |structure| {
            let results = kept.sweep(structure, relation, queries as usize)?;
            Ok::<_, ExplainError>(Answer::Sweep {
                backend: structure.name(),
                results,
            })
        }))
    }

    fn subdivide(&self, scheme: Scheme, count: u32) -> Result<Content, Error> {
        let levels = levels(scheme, self.polygons(), &self.kept.sourced.creases, count)?;
        let levels = levels
            .iter()
            .map(|step| Geometry::from_polygons(&step.polygons));
        Ok(Content::Levels {
            levels: levels.collect(),
        })
    }

    fn stencil(&self, scheme: Scheme, level: u32, point: u32) -> Result<Content, Error> {
        let parents = stencil(
            scheme,
            self.polygons(),
            &self.kept.sourced.creases,
            level,
            point,
        )?;
        Ok(Content::Stencil { parents })
    }
}
