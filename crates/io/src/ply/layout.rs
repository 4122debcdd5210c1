//! What the elements of a PLY file are for, and the parts of their records.

use super::Scalar;
use super::header::{Element, Property, PropertyKind};
use crate::faults::PlyHeaderFault;
use crate::notice::{IgnoredKind, Notices};
use crate::place::Place;

/// What an element is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Vertices; the numbers of the properties x, y and z.
    Vertices([usize; 3]),
    /// Faces.
    Faces,
    /// Strips of triangles.
    Strips,
    /// Anything else.
    Other,
}

/// A part of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// A coordinate with this number.
    Coordinate(usize, Scalar),
    /// The indices of a face or a strip.
    Indices { length: Scalar, item: Scalar },
    /// A value that is ignored.
    IgnoredNumber(Scalar),
    /// A list that is ignored.
    IgnoredList { length: Scalar, item: Scalar },
}

impl Element {
    /// Returns the parts of a record.
    pub(super) fn steps(&self, role: Role) -> Vec<Step> {
        let indices = match role {
            Role::Faces | Role::Strips => index_list(self),
            _ => None,
        };
        let step = |(number, property): (usize, &Property)| match property.kind {
            PropertyKind::Number(scalar) => {
                let coordinates = match role {
                    Role::Vertices(coordinates) => coordinates,
                    _ => return Step::IgnoredNumber(scalar),
                };
                match coordinates.iter().position(|&other| other == number) {
                    Some(coordinate) => Step::Coordinate(coordinate, scalar),
                    None => Step::IgnoredNumber(scalar),
                }
            }
            PropertyKind::List { length, item } if indices == Some(number) => {
                Step::Indices { length, item }
            }
            PropertyKind::List { length, item } => Step::IgnoredList { length, item },
        };
        self.properties.iter().enumerate().map(step).collect()
    }
}

impl Step {
    /// Returns the smallest number of bytes of this part in a binary file.
    pub(super) const fn min_size(self) -> usize {
        match self {
            Self::Coordinate(_, scalar) | Self::IgnoredNumber(scalar) => scalar.size(),
            Self::Indices { length, .. } | Self::IgnoredList { length, .. } => length.size(),
        }
    }
}

/// Returns what the element is for; if a property is missing, the line and the fault.
pub(super) fn role(element: &Element) -> Result<Role, (u32, PlyHeaderFault)> {
    let fault = |fault| (element.line, fault);
    match element.name.as_str() {
        "vertex" => {
            let number = |coordinate: &'static str| {
                let mut properties = element.properties.iter();
                let is_number = |kind| matches!(kind, PropertyKind::Number(_));
                properties
                    .position(|other| other.name == coordinate && is_number(other.kind))
                    .ok_or(fault(PlyHeaderFault::NoCoordinate { coordinate }))
            };
            Ok(Role::Vertices([number("x")?, number("y")?, number("z")?]))
        }
        "face" | "tristrips" if index_list(element).is_none() => {
            // Without faces the list need not be declared.
            if element.count == 0 {
                return Ok(Role::Other);
            }
            let element = element.name.clone();
            Err(fault(PlyHeaderFault::NoIndices { element }))
        }
        "face" => Ok(Role::Faces),
        "tristrips" => Ok(Role::Strips),
        _ => Ok(Role::Other),
    }
}

/// Returns the number of the property with the vertices of a face.
fn index_list(element: &Element) -> Option<usize> {
    let is_list = |property: &Property| matches!(property.kind, PropertyKind::List { .. });
    let is_named = |property: &Property| {
        is_list(property) && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
    };
    element.properties.iter().position(is_named)
}

/// Counts what is ignored in an element.
pub(super) fn note_ignored(notices: &mut Notices, element: &Element, role: &Role) {
    let line = Place::Line(element.line);
    if *role == Role::Other {
        let count = element.count;
        return notices.add_named(IgnoredKind::Elements, count, line, &element.name);
    }
    let used = match *role {
        Role::Vertices(coordinates) => coordinates.to_vec(),
        _ => index_list(element).into_iter().collect(),
    };
    for (number, property) in element.properties.iter().enumerate() {
        if used.contains(&number) || element.count == 0 {
            continue;
        }
        let line = Place::Line(property.line);
        // Of several properties that form one value, the first is counted.
        let (kind, count) = match property.name.as_str() {
            "nx" => (IgnoredKind::Normals, element.count),
            "ny" | "nz" => continue,
            "red" | "r" | "diffuse_red" => (IgnoredKind::Colours, element.count),
            "green" | "g" | "blue" | "b" | "alpha" | "a" => continue,
            "diffuse_green" | "diffuse_blue" | "diffuse_alpha" => continue,
            "s" | "u" | "texture_u" | "texcoord" => {
                (IgnoredKind::TextureCoordinates, element.count)
            }
            "t" | "v" | "texture_v" => continue,
            name => {
                notices.add_named(IgnoredKind::Properties, 1, line, name);
                continue;
            }
        };
        notices.add_many(kind, count, line);
    }
}
