//! One function from request to response, both JSON: for pages, and for programs in other languages.

mod refinement;
mod response;
mod source;

use std::fmt::Display;

use serde::Deserialize;
use serde_json::json;
use sixfold::io::parse_creases;
use sixfold::repair::{Fault, diagnose, repair_for};
use sixfold::subdivision::Scheme;
use sixfold::{Creases, Facts, PolygonMesh, Relation, StructureInfo, UnknownName, structure_infos};

use crate::built_mesh::{BuiltMesh, Geometry};
use crate::edit_command::EditCommand;
use crate::error::{ExplainError, Refused};
use crate::structure::Structure;
use refinement::{levels, stencil};
use response::{Answer, Content, Found, Response, Verdict};
use source::{MeshSource, Sourced};

/// Maximum number of places that a response lists for each kind of fault.
const MOST_PLACES: usize = 1_000;

/// Maximum number of rows of a table, if the request does not name the rows.
const MOST_ROWS: u32 = 200;

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
    /// Cuts every polygon into a fan of triangles first.
    #[serde(default)]
    triangulate: bool,
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
    },
    Trace(Query),
    Edit(String),
    Walk {
        walk: String,
        #[serde(default)]
        expect: Option<Query>,
    },
    Geometry,
    Facts,
    Verdicts,
    Repair,
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

/// Answers a request. Both are JSON.
///
/// A request names the mesh, the structures, and what is asked. The response depends on nothing else:
/// nothing is stored between requests, and to undo an edit, a request leaves it out.
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
/// | `mesh` | `{"shape": {"name": "torus", "parameters": {"m": 8}}}`, a shape of `sixfold generate`; `{"file": {"name": "a.obj", "text": "…"}}`, or `"base64"` for a binary file; `{"polygons": {"positions": [[0, 0, 0], …], "faces": [[0, 1, 2], …]}}`, in which `null` is a number without an element |
/// | `triangulate` | `true` cuts every polygon into a fan of triangles |
/// | `creases` | sharp edges and corners, as the text of a crease file ([`parse_creases`]); they are added to those of the mesh file |
/// | `edits` | edits before what is asked, as text ([`EditCommand`](crate::EditCommand)) |
/// | `structures` | names; all six if missing |
/// | `ask` | one of the following |
///
/// | `ask` | each answer, or the response |
/// |---|---|
/// | `{"tables": {"rows": [0, 20]}}` | for each structure the [`Records`](crate::Records) from the first to the last of these rows; without `rows`, the first 200 |
/// | `{"trace": {"relation": "vertex_faces", "element": "v3"}}` | a [`Trace`](crate::Trace) |
/// | `{"edit": "flip_edge v0-v1"}` | an [`EditTrace`](crate::EditTrace) |
/// | `{"walk": {"walk": "…", "expect": {"relation": …, "element": …}}}` | a [`Walk`](crate::Walk) |
/// | `"geometry"` | for each structure the [`Geometry`] after the edits |
/// | `"facts"` | `{"facts": …}`: [`Facts`] of the mesh |
/// | `"verdicts"` | `{"verdicts": …, "faults": …}`: which structures hold the mesh, and all kinds of faults with the number of places and the first 1,000 |
/// | `"repair"` | for each structure the steps, and the repaired mesh |
/// | `{"subdivide": {"scheme": "loop", "levels": 2}}` | `{"levels": …}`: the mesh before the first step, and after each step |
/// | `{"stencil": {"scheme": "loop", "level": 1, "point": 8}}` | `{"parents": …}`: the points of the level before with their weights, without those below 10⁻⁷ |
///
/// Points have the numbers of `sixfold subdivide --backend face-vertex --method gather`.
///
/// # Response
///
/// `{"answers": […], "refused": […]}` if structures answer. A structure that cannot hold the mesh, does
/// not have the element, or refuses one of `edits`, is in `refused` with its reason. `{"error": "…"}`
/// for a request that is wrong. `notes` lists what reading the mesh left out or changed.
///
/// Facts, verdicts, repairs and subdivision are those of the mesh without edits: send the geometry after
/// the edits as polygons. A mesh has at most 400,000 corners, also after a subdivision step; there are at
/// most 16 levels, and weights in meshes of at most 20,000 vertices.
pub fn respond(request: &str) -> String {
    let read = serde_json::from_str(request);
    let read = read.map_err(|error| Error::from(format!("the request: {error}")));
    let answered = read.and_then(|request: Request| request.answer());
    let response = answered.unwrap_or_else(|error| Response {
        content: Content::Error {
            error: error.to_string(),
        },
        notes: Vec::new(),
    });
    let written = serde_json::to_string(&response);
    written.unwrap_or_else(|error| json!({ "error": error.to_string() }).to_string())
}

impl Request {
    fn answer(&self) -> Result<Response, Error> {
        let Sourced {
            mut polygons,
            mut creases,
            notes,
        } = self.mesh.read()?;
        if self.triangulate {
            polygons = polygons.fan_triangulated()?;
        }
        if let Some(text) = &self.creases {
            let listed = parse_creases("creases", text.as_bytes(), &polygons)?;
            creases = creases.updated_with(&listed);
        }
        let edits = self.edits.iter().enumerate().map(|(i, edit)| {
            edit.parse()
                .map_err(|error: ExplainError| format!("edits, number {}: {error}", i + 1))
        });
        let subject = Subject {
            structures: self.chosen(Structure::all(), Structure::name)?,
            infos: self.chosen(structure_infos(), |info| info.name)?,
            edits: edits.collect::<Result<_, _>>()?,
            polygons,
            creases,
        };
        let content = match &self.ask {
            Ask::Tables { rows } => subject.tables(rows.unwrap_or([0, MOST_ROWS - 1]))?,
            Ask::Trace(query) => subject.trace(query.parsed()?),
            Ask::Edit(edit) => subject.edit(&edit.parse()?),
            Ask::Walk { walk, expect } => {
                subject.walk(walk, expect.as_ref().map(Query::parsed).transpose()?)
            }
            Ask::Geometry => subject.geometry(),
            _ if !self.edits.is_empty() => return Err(AFTER_EDITS.into()),
            Ask::Facts => Content::Facts {
                facts: Facts::from_polygons(&subject.polygons),
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
struct Subject {
    polygons: PolygonMesh,
    creases: Creases,
    edits: Vec<EditCommand>,
    structures: Vec<Structure>,
    infos: Vec<StructureInfo>,
}

impl Subject {
    /// Collects the answers of the structures, and the reasons of those that have none.
    fn each<E: Display>(&self, answer: impl Fn(&Structure) -> Result<Answer, E>) -> Content {
        let (mut answers, mut refused) = (Vec::new(), Vec::new());
        for structure in &self.structures {
            match answer(structure) {
                Ok(answer) => answers.push(answer),
                Err(error) => refused.push(Refused {
                    structure: structure.name(),
                    reason: error.to_string(),
                }),
            }
        }
        Content::Structures { answers, refused }
    }

    /// Builds a structure, and runs the edits.
    fn build(&self, structure: &Structure) -> Result<BuiltMesh, ExplainError> {
        structure.build_after(&self.polygons, &self.edits)
    }

    fn tables(&self, [first, last]: [u32; 2]) -> Result<Content, Error> {
        if first > last {
            return Err(
                format!("row {first} comes after row {last}: ask for [{last}, {first}]").into(),
            );
        }
        let rows = first as usize..last as usize + 1;
        Ok(self.each(|structure| {
            Ok::<_, ExplainError>(Answer::Tables {
                backend: structure.name(),
                records: self.build(structure)?.records(rows.clone()),
            })
        }))
    }

    fn trace(&self, (relation, element): crate::Query) -> Content {
        self.each(|structure| {
            let trace = self.build(structure)?.trace(relation, element);
            trace.map(Answer::Trace)
        })
    }

    fn walk(&self, walk: &str, expected: Option<crate::Query>) -> Content {
        self.each(|structure| {
            let walk = self.build(structure)?.walk(walk, expected);
            walk.map(Answer::Walk)
        })
    }

    fn edit(&self, edit: &EditCommand) -> Content {
        self.each(|structure| {
            let mut mesh = self.build(structure)?;
            mesh.edit(edit).map(Answer::Edit)
        })
    }

    fn geometry(&self) -> Content {
        self.each(|structure| {
            Ok::<_, ExplainError>(Answer::Geometry {
                backend: structure.name(),
                geometry: self.build(structure)?.geometry(),
            })
        })
    }

    /// Returns which structures hold the mesh, and all faults of the mesh.
    fn verdicts(&self) -> Content {
        let diagnosis = diagnose(&self.polygons, MOST_PLACES);
        let verdict = |info: &StructureInfo| {
            let refusal = info.capabilities.check(&self.polygons).err();
            let faults = diagnosis.refusals(&info.capabilities);
            Verdict {
                backend: info.name,
                holds: refusal.is_none(),
                reason: refusal.map(|refusal| refusal.to_string()),
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
        self.each(|structure| {
            let backend = structure.name();
            let info = self.infos.iter().find(|info| info.name == backend);
            let info = info.expect("the same structures");
            repair_for(&self.polygons, &info.capabilities).map(|repaired| Answer::Repair {
                backend,
                geometry: Geometry::from_polygons(&repaired.polygons),
                steps: repaired.steps,
            })
        })
    }

    fn subdivide(&self, scheme: Scheme, count: u32) -> Result<Content, Error> {
        let levels = levels(scheme, &self.polygons, &self.creases, count)?;
        let levels = levels
            .iter()
            .map(|step| Geometry::from_polygons(&step.polygons));
        Ok(Content::Levels {
            levels: levels.collect(),
        })
    }

    fn stencil(&self, scheme: Scheme, level: u32, point: u32) -> Result<Content, Error> {
        let parents = stencil(scheme, &self.polygons, &self.creases, level, point)?;
        Ok(Content::Stencil { parents })
    }
}
