//! The faults in files of single formats.

use sixfold_core::CreaseError;

use crate::tags::Tag;

/// A fault in a glTF file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message shows the meaning of each field")]
pub enum GltfFault {
    /// The JSON text is invalid, or a member has another type than glTF says.
    #[error("the JSON text is not glTF ({message}): export the file again")]
    Json { message: String },
    /// The version is not 2.
    #[error("the file has glTF version {version:?}: export it as version 2.0")]
    Version { version: String },
    /// A chunk of a binary file has an unknown kind, or the first one is not JSON.
    #[error("the first chunk of the file is not JSON: export the file again")]
    NoJson,
    /// An index names an item that does not exist.
    #[error("it names {kind} {number}, but the file has {count} of them: export the file again")]
    NoItem {
        kind: &'static str,
        number: usize,
        count: usize,
    },
    /// The scene that was chosen, or the default scene of the file, does not exist.
    #[error("no such scene: the file has {count}, and the first is scene 0")]
    NoScene { count: usize },
    /// The mode of a primitive does not exist.
    #[error(
        "a primitive has mode {mode}, but modes are numbers from 0 to 6: export the file again"
    )]
    Mode { mode: u32 },
    /// An accessor has the wrong type for its use.
    #[error("it has type {found:?}, but {expected}: export the file again")]
    Type {
        found: String,
        expected: &'static str,
    },
    /// The elements of an accessor are not inside its buffer.
    #[error("its data ends at byte {end} of {length}: copy the file again, or export it again")]
    OutOfBuffer { end: String, length: u64 },
    /// The replaced elements of a sparse accessor are not in ascending order.
    #[error("its sparse index {index} is not above the one before and below {count}: export again")]
    SparseIndex { index: u64, count: u64 },
    /// A buffer is shorter than it should be.
    #[error("it has {found} bytes, expected {expected}: copy the file again, with its .bin files")]
    ShortBuffer { found: u64, expected: u64 },
    /// A buffer is in a place that is not read.
    #[error("its data is at {uri:?}: only files in the folder of the file, or below it, are read")]
    Uri { uri: String },
    /// A buffer is in another file, but the mesh does not come from a file.
    #[error("its data is in the file {uri:?}: name the glTF file instead of passing its content")]
    NeedsFolder { uri: String },
    /// A file with the data of a buffer cannot be read.
    #[error("its data cannot be read from {path} ({cause}): keep the .bin files beside the file")]
    BufferFile { path: String, cause: std::io::Error },
    /// The text of an embedded buffer is invalid.
    #[error("its embedded data is not base64 text: export the file again")]
    Base64,
    /// A morph target does not have as many positions as the mesh.
    #[error(
        "it has {found} positions, but the positions that it moves are {expected}: export again"
    )]
    TargetCount { found: u64, expected: u64 },
    /// A node is reached twice.
    #[error("it has several parents, or is its own ancestor: export the file again")]
    NodeRepeated,
    /// The nodes repeat their meshes so often that the result is much larger than the file.
    #[error(
        "the scene has more than {limit} vertices, corners and primitives, many times the size of the file: split it, or join its copies"
    )]
    TooLarge { limit: u64 },
}

/// A fault in the header of a PLY file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message shows the meaning of each field")]
pub enum PlyHeaderFault {
    /// There is no `format` line before the first element.
    #[error(
        "the header has no `format` line before its elements: add `format ascii 1.0` if the data is text"
    )]
    NoFormat,
    /// The form is not one of the three that exist.
    #[error(
        "{text:?} is not a form of PLY: use ascii, binary_little_endian or binary_big_endian, and version 1.0"
    )]
    UnknownForm { text: String },
    /// An `element` line is not a name and a number.
    #[error("{text:?} is not an element: write `element`, a name and a count")]
    Element { text: String },
    /// A `property` line is not a type and a name.
    #[error("{text:?} is not a property: write `property float x` or `property list uchar int x`")]
    Property { text: String },
    /// The type of a property does not exist.
    #[error(
        "{text:?} is not a type of numbers: use int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32 or float64"
    )]
    Type { text: String },
    /// A `property` line precedes all elements.
    #[error("the property {name:?} precedes all elements: move it below its element")]
    PropertyWithoutElement { name: String },
    /// Two elements or two properties have one name.
    #[error("{name:?} is declared twice: remove one of the declarations")]
    Repeated { name: String },
    /// The numbers of a list property are counted by a type with fractions.
    #[error("the length of list {name:?} has a type with fractions: use an integer type")]
    ListLength { name: String },
    /// There is no `vertex` element.
    #[error("the header declares no vertices: add `element vertex` and a count")]
    NoVertices,
    /// The vertices have no coordinate with this name.
    #[error("vertices have no number {coordinate:?}: declare `property float {coordinate}`")]
    NoCoordinate { coordinate: &'static str },
    /// The faces have no list of vertices.
    #[error(
        "the element {element:?} has no list of vertices: declare `property list uchar int vertex_indices`"
    )]
    NoIndices { element: String },
}

/// A fault in a `t crease` or `t corner` tag.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message shows the meaning of each field")]
pub enum TagFault {
    /// The tag does not start with three counts such as `2/1/0`.
    #[error("tag {tag} has invalid counts {text:?}: write the tag like `t {tag} {}`", tag.example())]
    Counts { tag: Tag, text: String },
    /// The number of values does not match the counts.
    #[error(
        "the counts of tag {tag} require {required} values, found {found}: correct the counts or the values"
    )]
    Length {
        tag: Tag,
        required: usize,
        found: usize,
    },
    /// The counts are not possible for this kind of tag.
    #[error("counts {counts} do not fit tag {tag}: write the tag like `t {tag} {}`; {}", tag.example(), tag.rule())]
    Shape { tag: Tag, counts: String },
    /// A value is not a vertex number.
    #[error("{text:?} in tag {tag} is not a vertex number: use whole numbers that count from 0")]
    Vertex { tag: Tag, text: String },
    /// A value is not a sharpness.
    #[error(
        "sharpness {text:?} in tag {tag} is not a number from 0 to inf: write it like 2, 0.5 or inf"
    )]
    Sharpness { tag: Tag, text: String },
    /// The file does not have this vertex or edge.
    #[error("tag {tag}: {cause}")]
    Mesh { tag: Tag, cause: CreaseError },
}
