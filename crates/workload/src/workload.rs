//! What a program does to a mesh, as data: which operations, how often, in which order of elements.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserializer, Error as _};
use serde::{Deserialize, Serialize, Serializer};
use serde_with::{DeserializeFromStr, SerializeDisplay};
use sixfold::{Counts, Edit, Relation};

use crate::operation::{Kind, Operation};
use crate::unknown::unknown;

/// What a program does to a mesh.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Workload {
    /// What users call it: `smoothing`.
    pub name: String,
    /// Who does this, in a sentence.
    pub summary: String,
    /// In which order elements are visited.
    pub access: Access,
    /// How many operations one use of a mesh comes to.
    pub operations: Amount,
    /// How often the structure is built anew in the course of them, besides the first time.
    pub rebuilds: u64,
    /// The operations, each with its weight; at least one weight is more than 0.
    pub mix: Vec<Part>,
}

/// One operation of a mix.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Part {
    /// What is done.
    pub action: Action,
    /// How often, beside the weights of the others.
    pub weight: Amount,
}

/// Something that a program does to a mesh.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, DeserializeFromStr, SerializeDisplay,
)]
pub enum Action {
    /// One element asked one relation.
    Relation(Relation),
    /// The position of a vertex read.
    Position,
    /// The positions of the neighbours of a vertex read.
    NeighbourPositions,
    /// The positions of the corners of a face read.
    CornerPositions,
    /// The positions of the two ends of an edge read.
    EndPositions,
    /// The position of a vertex written.
    SetPosition,
    /// An edit at one place, with all checks.
    Edit(Edit),
    /// A pass over the whole mesh.
    Pass(Operation),
    /// One step of subdivision, by the fastest method of the structure: Loop's scheme on triangles,
    /// Catmull–Clark elsewhere.
    Subdivide,
}

/// In which order elements are visited.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Access {
    /// In the order of the structure, round and round.
    Sequential,
    /// In no order: each element of the mesh once, then again.
    Random,
    /// Patch by patch: the faces around a random one, breadth first, with their vertices and edges.
    Patches,
}

/// How many: a number, or so many for each element of a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// So many.
    Number(f64),
    /// So many for each element of the mesh.
    Per(f64, Kind),
}

impl Amount {
    /// How many that is on a mesh with such counts.
    pub fn on(self, counts: &Counts) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Per(number, Kind::Vertex) => number * counts.vertices as f64,
            Self::Per(number, Kind::Edge) => number * counts.edges as f64,
            Self::Per(number, Kind::Face) => number * counts.faces as f64,
        }
    }

    /// The number, whatever it is for.
    pub const fn number(self) -> f64 {
        match self {
            Self::Number(number) | Self::Per(number, _) => number,
        }
    }
}

impl fmt::Display for Amount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Per(number, kind) => write!(f, "{number} per {}", kind.name()),
        }
    }
}

impl Serialize for Amount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(number) => serializer.serialize_f64(*number),
            Self::Per(..) => serializer.collect_str(self),
        }
    }
}

impl<'de> Deserialize<'de> for Amount {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(f64),
            Text(String),
        }

        match Written::deserialize(deserializer)? {
            Written::Number(number) => Ok(Self::Number(number)),
            Written::Text(text) => text.parse().map_err(D::Error::custom),
        }
    }
}

/// A text that is no amount.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` is no amount: write a number, or as in `2 per face` (vertex, edge, face)")]
pub struct NoAmount {
    /// The text.
    pub text: String,
}

impl FromStr for Amount {
    type Err = NoAmount;

    fn from_str(text: &str) -> Result<Self, NoAmount> {
        let wrong = || NoAmount { text: text.into() };
        let number = |text: &str| text.trim().replace('_', "").parse().map_err(|_| wrong());
        let Some((amount, per)) = text.split_once(" per ") else {
            return Ok(Self::Number(number(text)?));
        };
        let kind = Kind::ALL.into_iter().find(|kind| kind.name() == per.trim());
        Ok(Self::Per(number(amount)?, kind.ok_or_else(wrong)?))
    }
}

impl Access {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Sequential, Self::Random, Self::Patches];

    /// What users call it: `patches`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sequential => "sequential",
            Self::Random => "random",
            Self::Patches => "patches",
        }
    }
}

impl fmt::Display for Access {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The edits that a mix may have: each at a place of its own.
const EDITS: [Edit; 10] = [
    Edit::AddFace,
    Edit::RemoveFace,
    Edit::SplitEdge,
    Edit::BisectEdge,
    Edit::PokeFace,
    Edit::SplitFace,
    Edit::DissolveEdge,
    Edit::FlipEdge,
    Edit::CollapseEdge,
    Edit::SplitVertex,
];

impl Action {
    /// All of them, in the order in which they are listed.
    pub fn all() -> Vec<Self> {
        let relations = Relation::ALL.into_iter().map(Self::Relation);
        let positions = [
            Self::Position,
            Self::NeighbourPositions,
            Self::CornerPositions,
            Self::EndPositions,
            Self::SetPosition,
        ];
        let is_pass = |o: &Operation| !matches!(o, Operation::Build | Operation::Relation(_));
        let passes = Operation::ALL.into_iter().filter(is_pass).map(Self::Pass);
        relations
            .chain(positions)
            .chain(EDITS.into_iter().map(Self::Edit))
            .chain(passes)
            .chain([Self::Subdivide])
            .collect()
    }

    /// What users call it: `vertex_faces`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Relation(relation) => relation.name(),
            Self::Position => "position",
            Self::NeighbourPositions => "neighbour_positions",
            Self::CornerPositions => "corner_positions",
            Self::EndPositions => "end_positions",
            Self::SetPosition => "set_position",
            Self::Edit(edit) => edit.name(),
            Self::Pass(operation) => operation.name(),
            Self::Subdivide => "subdivide",
        }
    }

    /// The kind of element that it is done to; `None` for passes, and for edits, which have places.
    pub const fn kind(self) -> Option<Kind> {
        match self {
            Self::Relation(relation) => Some(Kind::asked(relation)),
            Self::Position | Self::NeighbourPositions | Self::SetPosition => Some(Kind::Vertex),
            Self::CornerPositions => Some(Kind::Face),
            Self::EndPositions => Some(Kind::Edge),
            Self::Edit(_) | Self::Pass(_) | Self::Subdivide => None,
        }
    }

    /// The relations that it asks, if it only asks.
    pub fn relations(self) -> Vec<Relation> {
        match self {
            Self::Relation(relation) => vec![relation],
            Self::NeighbourPositions => vec![Relation::VertexVertices],
            Self::CornerPositions => vec![Relation::FaceVertices],
            Self::EndPositions => vec![Relation::EdgeVertices],
            Self::Pass(operation) => {
                let asked = Kind::ALL.map(|kind| operation.relations(kind));
                asked.concat()
            }
            Self::Position | Self::SetPosition | Self::Edit(_) | Self::Subdivide => Vec::new(),
        }
    }

    /// Whether it goes through the whole mesh.
    pub const fn is_a_pass(self) -> bool {
        matches!(self, Self::Pass(_) | Self::Subdivide)
    }

    /// Whether it changes what is connected with what, in the mesh or in a copy of it.
    pub const fn changes_connectivity(self) -> bool {
        match self {
            Self::Edit(_) | Self::Subdivide => true,
            Self::Pass(operation) => operation.makes_a_mesh(),
            _ => false,
        }
    }

    /// Whether it needs a mesh that can be edited.
    pub const fn edits(self) -> bool {
        matches!(
            self,
            Self::Edit(_) | Self::SetPosition | Self::Pass(Operation::Editing(_))
        )
    }
}

/// A name of nothing that a workload may do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", unknown("operation", .name, &Action::all().iter().map(|a| a.name()).collect::<Vec<_>>()))]
pub struct UnknownAction {
    /// The name.
    pub name: String,
}

impl FromStr for Action {
    type Err = UnknownAction;

    fn from_str(name: &str) -> Result<Self, UnknownAction> {
        let mut all = Self::all().into_iter();
        all.find(|action| action.name() == name)
            .ok_or_else(|| UnknownAction { name: name.into() })
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Workload {
    /// How many operations one use of a mesh with such counts comes to; at least 1.
    pub fn operations_on(&self, counts: &Counts) -> f64 {
        self.operations.on(counts).max(1.0)
    }

    /// What part of all operations each member of the mix is, on a mesh with such counts; they add up
    /// to 1. All equal where the mesh has none of the elements that the weights count.
    pub fn shares(&self, counts: &Counts) -> Vec<f64> {
        let weights: Vec<f64> = { self.mix.iter() }.map(|p| p.weight.on(counts)).collect();
        let sum: f64 = weights.iter().sum();
        match sum > 0.0 {
            true => weights.iter().map(|weight| weight / sum).collect(),
            false => vec![1.0 / weights.len() as f64; weights.len()],
        }
    }

    /// How many times the structure is built anew for each operation.
    pub fn rebuilds_per_operation(&self, counts: &Counts) -> f64 {
        self.rebuilds as f64 / self.operations_on(counts)
    }

    /// Whether it leaves alone what is connected with what.
    pub fn is_read_only(&self) -> bool {
        !self
            .mix
            .iter()
            .any(|part| part.action.changes_connectivity())
    }

    /// The relations that its operations ask, each once.
    pub fn relations(&self) -> Vec<Relation> {
        let asked = self.mix.iter().flat_map(|part| part.action.relations());
        let mut asked: Vec<Relation> = asked.collect();
        asked.sort_unstable();
        asked.dedup();
        asked
    }
}
