//! A workload: the operations of a program on a mesh, their weights, and the order of the elements.

use std::fmt;
use std::str::FromStr;

use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use sixfold::{Edit, Relation};
use sixfold_core::Counts;

use sixfold_measure::{ElementKind, Operation};
use sixfold_results::{OwnData, WorkloadPart, WorkloadReport};

/// The operations that a program performs on a mesh.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Workload {
    /// The name that users write for the workload, such as `smoothing`.
    pub name: String,
    /// One sentence that describes the program.
    pub summary: String,
    /// The order in which the workload visits the elements.
    pub access: Access,
    /// The number of operations that the program performs on one mesh.
    pub operations: Amount,
    /// The number of times that the program rebuilds the structure while it uses one mesh. The
    /// first build does not count.
    pub rebuilds: u64,
    /// The time of the program's own work for each operation, in nanoseconds; 0 or more. It is added to the
    /// time of every backend.
    #[serde(default)]
    pub own_ns: f64,
    /// The program's own data that each visit of an element reads and writes.
    #[serde(default, skip_serializing_if = "OwnData::is_empty")]
    pub own_data: OwnData,
    /// The operations with their weights. At least one weight is greater than 0.
    pub mix: Vec<Part>,
}

/// One operation of a mix, with its weight.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Part {
    /// The operation.
    pub action: Action,
    /// How often the operation runs, relative to the other operations of the mix.
    pub weight: Amount,
}

/// An operation of a program on a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Action {
    /// Queries one relation of one element, such as the faces at a vertex.
    Relation(Relation),
    /// Reads the position of a vertex.
    Position,
    /// Reads the positions of the neighbours of one vertex.
    NeighbourPositions,
    /// Reads the positions of the vertices of a face.
    CornerPositions,
    /// Reads the positions of the two ends of an edge.
    EndPositions,
    /// Writes the position of a vertex.
    SetPosition,
    /// Does one edit of the given kind.
    Edit(Edit),
    /// Runs a pass over the whole mesh.
    Pass(Operation),
    /// Runs one subdivision step by the fastest method that the structure supports. The scheme is
    /// Loop for triangle meshes and Catmull–Clark for other meshes. If the mix has edits, the step
    /// refines the compact form of the structure, because the editable form cannot split its tables.
    Subdivide,
}

sixfold_core::named! {
    /// The order in which a workload visits the elements.
    pub enum Access: "access pattern" {
        /// The order in which the structure stores the elements, repeated if necessary.
        Sequential = "sequential",
        /// A random order of all elements. The same order is repeated if necessary.
        Random = "random",
        /// Patch by patch. A patch contains the faces around a random face, and the vertices and
        /// edges of these faces.
        Patches = "patches",
        /// A front that grows: breadth first from face to face, as in region growing and in the
        /// computation of distances. The vertices and edges follow in the order in which the front
        /// reaches them.
        Front = "front",
        /// Face by face: the faces in their order in the mesh file, the vertices and edges in the
        /// order in which the faces name them. A vertex is visited once for each of its faces.
        ByFace = "by_face",
        /// Edge by edge: the edges in the order in which the faces name them first, the ends of
        /// each edge, and the faces of each edge. A vertex is visited once for each of its edges.
        ByEdge = "by_edge",
    }
}

/// A fixed number, or a number for each vertex, edge or face of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// A fixed number.
    Number(f64),
    /// A number for each element of one kind, such as 2 for each face.
    Per(f64, ElementKind),
}

impl Amount {
    /// Returns the amount for a mesh with the given numbers of vertices, edges and faces.
    pub fn value_on(self, counts: &Counts) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Per(number, ElementKind::Vertex) => number * counts.vertices as f64,
            Self::Per(number, ElementKind::Edge) => number * counts.edges as f64,
            Self::Per(number, ElementKind::Face) => number * counts.faces as f64,
        }
    }

    /// Returns the number in the amount, such as 2 for “2 per face”.
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
        let parsed = NumberOrText::deserialize(deserializer)?.amount();
        parsed.map_err(de::Error::custom)
    }
}

/// The form of an amount in a file.
pub(crate) enum NumberOrText {
    Number(f64),
    Text(String),
}

impl<'de> Deserialize<'de> for NumberOrText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Value;

        impl Visitor<'_> for Value {
            type Value = NumberOrText;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number such as `20`, or a text such as `\"2 per face\"`")
            }

            fn visit_i64<E: de::Error>(self, number: i64) -> Result<NumberOrText, E> {
                Ok(NumberOrText::Number(number as f64))
            }

            fn visit_u64<E: de::Error>(self, number: u64) -> Result<NumberOrText, E> {
                Ok(NumberOrText::Number(number as f64))
            }

            fn visit_f64<E: de::Error>(self, number: f64) -> Result<NumberOrText, E> {
                Ok(NumberOrText::Number(number))
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<NumberOrText, E> {
                Ok(NumberOrText::Text(text.into()))
            }
        }

        deserializer.deserialize_any(Value)
    }
}

impl NumberOrText {
    /// Parses the text, if it is one.
    pub(crate) fn amount(&self) -> Result<Amount, ParseAmountError> {
        match self {
            Self::Number(number) => Ok(Amount::Number(*number)),
            Self::Text(text) => text.parse(),
        }
    }
}

/// The error for a text that is not an amount.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is not an amount: write a number such as `20`, or a number per vertex, edge or face \
     such as `2 per face`"
)]
pub struct ParseAmountError {
    /// The text that is not an amount.
    pub text: String,
}

impl FromStr for Amount {
    type Err = ParseAmountError;

    fn from_str(text: &str) -> Result<Self, ParseAmountError> {
        let wrong = || ParseAmountError { text: text.into() };
        let number = |text: &str| text.trim().replace('_', "").parse().map_err(|_| wrong());
        let Some((amount, per)) = text.split_once(" per ") else {
            return Ok(Self::Number(number(text)?));
        };
        Ok(Self::Per(
            number(amount)?,
            per.parse().map_err(|_| wrong())?,
        ))
    }
}

/// The edits that a mix may contain.
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
    /// Returns all actions, in the order in which lists show them.
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

    /// Returns the name that users write for the action, such as `vertex_faces`.
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

    /// Returns the kind of element that the action visits. Returns `None` for passes and edits.
    pub const fn kind(self) -> Option<ElementKind> {
        match self {
            Self::Relation(relation) => Some(ElementKind::queried_by(relation)),
            Self::Position | Self::NeighbourPositions | Self::SetPosition => {
                Some(ElementKind::Vertex)
            }
            Self::CornerPositions => Some(ElementKind::Face),
            Self::EndPositions => Some(ElementKind::Edge),
            Self::Edit(_) | Self::Pass(_) | Self::Subdivide => None,
        }
    }

    /// Returns the relations that the action queries. The list is empty for [`Self::Edit`] and
    /// [`Self::Subdivide`].
    pub fn relations(self) -> Vec<Relation> {
        match self {
            Self::Relation(relation) => vec![relation],
            Self::NeighbourPositions => vec![Relation::VertexVertices],
            Self::CornerPositions => vec![Relation::FaceVertices],
            Self::EndPositions => vec![Relation::EdgeVertices],
            Self::Pass(operation) => {
                let queried = ElementKind::ALL.map(|kind| operation.relations(kind));
                queried.concat()
            }
            Self::Position | Self::SetPosition | Self::Edit(_) | Self::Subdivide => Vec::new(),
        }
    }

    /// Returns true if the action visits the whole mesh.
    pub const fn is_pass(self) -> bool {
        matches!(self, Self::Pass(_) | Self::Subdivide)
    }

    /// Returns true if the action changes the connectivity of the mesh or of a copy of the mesh.
    pub const fn changes_connectivity(self) -> bool {
        match self {
            Self::Edit(_) | Self::Subdivide => true,
            Self::Pass(operation) => operation.creates_mesh(),
            _ => false,
        }
    }

    /// Returns true if the action needs an editable mesh.
    pub const fn needs_editable_mesh(self) -> bool {
        matches!(
            self,
            Self::Edit(_) | Self::SetPosition | Self::Pass(Operation::EditPass(_))
        )
    }
}

sixfold_core::named!(impl Action: "operation" in Action::all());

impl Workload {
    /// Returns what results say about the workload.
    pub fn report(&self) -> WorkloadReport {
        let amount = |amount: Amount| match amount {
            Amount::Number(number) => sixfold_results::Amount::Number(number),
            per => sixfold_results::Amount::PerElement(per.to_string()),
        };
        let mix = self.mix.iter().map(|part| WorkloadPart {
            action: part.action.to_string(),
            weight: amount(part.weight),
        });
        WorkloadReport {
            name: self.name.clone(),
            summary: self.summary.clone(),
            access: self.access.to_string(),
            operations: amount(self.operations),
            rebuilds: self.rebuilds,
            own_ns: self.own_ns,
            own_data: self.own_data,
            mix: mix.collect(),
        }
    }

    /// Returns the number of operations on one mesh with the given element counts; at least 1.
    pub fn operations_on(&self, counts: &Counts) -> f64 {
        self.operations.value_on(counts).max(1.0)
    }

    /// Returns one share for each operation of the mix: the share of this operation in all
    /// operations, on a mesh with the given element counts. The shares add up to 1. If all weights
    /// are 0 for this mesh, all shares are equal.
    pub fn shares(&self, counts: &Counts) -> Vec<f64> {
        let weights: Vec<f64> = self.mix.iter().map(|p| p.weight.value_on(counts)).collect();
        let sum: f64 = weights.iter().sum();
        match sum > 0.0 {
            true => weights.iter().map(|weight| weight / sum).collect(),
            false => vec![1.0 / weights.len() as f64; weights.len()],
        }
    }

    /// Returns the number of rebuilds divided by the number of operations.
    pub fn rebuilds_per_operation(&self, counts: &Counts) -> f64 {
        self.rebuilds as f64 / self.operations_on(counts)
    }

    /// Returns true if no operation of the workload changes the connectivity of the mesh.
    pub fn is_read_only(&self) -> bool {
        !self
            .mix
            .iter()
            .any(|part| part.action.changes_connectivity())
    }

    /// Returns the relations that the operations query, without duplicates.
    pub fn relations(&self) -> Vec<Relation> {
        let queried = self.mix.iter().flat_map(|part| part.action.relations());
        let mut queried: Vec<Relation> = queried.collect();
        queried.sort_unstable();
        queried.dedup();
        queried
    }
}
