//! The contents of a file that the reader ignores.

use std::fmt;

use crate::excerpt::shortened;
use crate::place::Place;

/// A kind of content that a reader ignores.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum IgnoredKind {
    /// `vt` in OBJ, and texture coordinates of vertices or faces.
    TextureCoordinates,
    /// `vn` in OBJ, and normals of vertices. Normals of STL facets follow from the positions and
    /// are not reported.
    Normals,
    /// Colours of vertices or faces; in binary STL, facets with attributes.
    Colours,
    /// Tangents of vertices.
    Tangents,
    /// Values after the three coordinates of a vertex: a weight or a colour.
    ExtraValues,
    /// Properties of PLY and attributes of glTF with another meaning.
    Properties,
    /// Elements of PLY other than vertices, faces and triangle strips.
    Elements,
    /// Triangles of a strip that have no area because they only continue it.
    StripJoints,
    /// Corners that are too few for a triangle: at the end of a list of triangles of glTF, and in a
    /// strip of PLY.
    IncompleteTriangles,
    /// Corners of faces that repeat the corner next to them. The face keeps its other corners.
    RepeatedCorners,
    /// Polygons that name a vertex twice, not only in neighbouring corners: an outline with a bridge
    /// to a hole, or parts that meet in a vertex. Each was cut into triangles, which have its area.
    CutFaces,
    /// Bytes after the end of the mesh in a binary file.
    Trailing,
    /// Lines after the end of the mesh in a text file, except blank lines and comments.
    TrailingLines,
    /// Solids of ASCII STL that do not end in `endsolid`. The file may be cut off between two
    /// facets.
    MissingEnds,
    /// The number of facets in the header of a binary STL, if more facets follow. All are read.
    SmallFacetCount,
    /// Primitives of glTF that are lines, or points by index; their vertices are kept.
    OtherPrimitives,
    /// Meshes of glTF that are not part of the scene.
    UnusedMeshes,
    /// Animations, and morph targets whose weight is 0, of glTF.
    Deformations,
    /// Translations, rotations and scales of nodes of glTF that also have a matrix.
    NodeTransforms,
    /// Nodes of glTF that have meshes and are not part of the scene.
    UnusedNodes,
    /// Meshes of glTF that are bound to the joints of a skin. Their vertices stay as they are stored:
    /// neither the joints nor the place of the node move them.
    Skins,
    /// Nodes of glTF whose mesh is repeated at several places (`EXT_mesh_gpu_instancing`). The mesh is
    /// read once, at the place of the node.
    Instances,
    /// Extensions of glTF.
    Extensions,
    /// `o`.
    Objects,
    /// `g`.
    Groups,
    /// `usemtl`, `mtllib` and texture maps.
    Materials,
    /// `s` and `mg`.
    SmoothingGroups,
    /// `l`.
    Lines,
    /// `p`.
    Points,
    /// Curves and surfaces: `curv`, `surf`, `vp` and similar statements.
    FreeForm,
    /// Display attributes: `bevel`, `lod` and similar statements.
    Display,
    /// `t interpolateboundary` and similar tags: boundary rules of subdivision.
    BoundaryTags,
    /// `t creasemethod`: the rule for the sharpness at the next level.
    CreaseMethodTags,
    /// `t hole`: faces that are not drawn.
    HoleTags,
    /// The sharpness of an edge or a vertex that has another one later. The last counts.
    ReplacedSharpness,
    /// `t` with another name.
    OtherTags,
    /// A line whose keyword is not part of the format: in OBJ, in the header of PLY, and outside the
    /// solids of ASCII STL.
    Unknown,
}

impl IgnoredKind {
    /// Returns the kind of a statement from its keyword. The keyword is not `v` or `f`.
    pub(crate) fn from_keyword(keyword: &[u8]) -> Self {
        match keyword {
            b"vt" => Self::TextureCoordinates,
            b"vn" => Self::Normals,
            b"o" => Self::Objects,
            b"g" => Self::Groups,
            b"usemtl" | b"mtllib" | b"usemap" | b"maplib" => Self::Materials,
            b"s" | b"mg" => Self::SmoothingGroups,
            b"l" => Self::Lines,
            b"p" => Self::Points,
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf"
            | b"parm" | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"bsp" | b"bzp"
            | b"cdc" | b"cdp" | b"res" => Self::FreeForm,
            b"bevel" | b"c_interp" | b"d_interp" | b"lod" | b"shadow_obj" | b"trace_obj"
            | b"ctech" | b"stech" => Self::Display,
            _ => Self::Unknown,
        }
    }

    /// Returns the kind of a `t` statement from its name. The name is not `crease` or `corner`.
    pub(crate) fn from_tag(name: &[u8]) -> Self {
        match name {
            b"interpolateboundary"
            | b"facevaryinginterpolateboundary"
            | b"facevaryingpropagatecorners" => Self::BoundaryTags,
            b"creasemethod" => Self::CreaseMethodTags,
            b"hole" => Self::HoleTags,
            _ => Self::OtherTags,
        }
    }

    /// Returns the name of the ignored contents, in the plural: `texture coordinates`.
    pub const fn title(self) -> &'static str {
        self.names()[1]
    }

    /// Returns what the kind means for the mesh, if its name does not say it.
    const fn remark(self) -> &'static str {
        match self {
            Self::CutFaces => ": the triangles have the same area",
            Self::MissingEnds => ": the file may be cut off",
            Self::SmallFacetCount => ": more facets follow than it says, and all are read",
            Self::Skins => ": vertices stay where they are stored, because joints are not read",
            Self::Instances => ": the mesh of a node is read once",
            _ => "",
        }
    }

    /// Returns the name in the singular and in the plural.
    const fn names(self) -> [&'static str; 2] {
        match self {
            Self::TextureCoordinates => ["texture coordinate", "texture coordinates"],
            Self::Normals => ["normal", "normals"],
            Self::Colours => ["colour", "colours"],
            Self::Tangents => ["tangent", "tangents"],
            Self::ExtraValues => ["vertex weight or colour", "vertex weights or colours"],
            Self::Properties => ["other property", "other properties"],
            Self::Elements => ["other element", "other elements"],
            Self::StripJoints => ["joint of triangle strips", "joints of triangle strips"],
            Self::IncompleteTriangles => [
                "corner of an incomplete triangle",
                "corners of incomplete triangles",
            ],
            Self::RepeatedCorners => ["repeated corner of a face", "repeated corners of faces"],
            Self::CutFaces => [
                "face that names a vertex twice",
                "faces that name a vertex twice",
            ],
            Self::Trailing => ["byte after the mesh", "bytes after the mesh"],
            Self::TrailingLines => ["line after the mesh", "lines after the mesh"],
            Self::MissingEnds => ["missing `endsolid`", "missing `endsolid` lines"],
            Self::SmallFacetCount => ["number of facets", "numbers of facets"],
            Self::OtherPrimitives => [
                "primitive of points or lines",
                "primitives of points or lines",
            ],
            Self::UnusedMeshes => ["mesh outside the scene", "meshes outside the scene"],
            Self::Deformations => ["animation or morph", "animations and morphs"],
            Self::NodeTransforms => [
                "translation, rotation or scale beside a matrix",
                "translations, rotations and scales beside a matrix",
            ],
            Self::UnusedNodes => [
                "node with a mesh outside the scene",
                "nodes with meshes outside the scene",
            ],
            Self::Skins => ["skin of a mesh", "skins of meshes"],
            Self::Instances => ["list of instances", "lists of instances"],
            Self::Extensions => ["extension", "extensions"],
            Self::Objects => ["object name", "object names"],
            Self::Groups => ["group", "groups"],
            Self::Materials => ["material statement", "material statements"],
            Self::SmoothingGroups => ["smoothing group", "smoothing groups"],
            Self::Lines => ["line", "lines"],
            Self::Points => ["point statement", "point statements"],
            Self::FreeForm => ["free-form statement", "free-form statements"],
            Self::Display => ["display attribute", "display attributes"],
            Self::BoundaryTags => ["boundary rule tag", "boundary rule tags"],
            Self::CreaseMethodTags => ["crease method tag", "crease method tags"],
            Self::HoleTags => ["hole tag", "hole tags"],
            Self::ReplacedSharpness => [
                "sharpness that a later one replaces",
                "sharpness values that later ones replace",
            ],
            Self::OtherTags => ["other tag", "other tags"],
            Self::Unknown => ["unknown statement", "unknown statements"],
        }
    }
}

/// A kind of ignored content and its amount, printed for example as `ignored 48612 texture
/// coordinates (first at line 12)`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Notice {
    /// Kind of the ignored content.
    pub kind: IgnoredKind,
    /// Number of ignored values or statements. For [`IgnoredKind::ExtraValues`], number of vertices
    /// with such values.
    pub count: u64,
    /// Place of the first one. If the format declares it in a header, the place of the declaration.
    pub first: Place,
    /// Names in the file, at most [`MAX_NAMES`](Self::MAX_NAMES). Empty if the kind has no names.
    pub names: Vec<String>,
    /// Whether the file has further names, which `names` leaves out.
    pub has_more_names: bool,
}

impl Notice {
    /// Maximum number of names that a notice lists.
    pub const MAX_NAMES: usize = 8;
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, several] = self.kind.names();
        let first = self.first;
        let verb = match self.kind {
            IgnoredKind::CutFaces => "cut",
            _ => "ignored",
        };
        match self.count {
            1 => write!(f, "{verb} 1 {one}")?,
            n => write!(f, "{verb} {n} {several}")?,
        }
        if !self.names.is_empty() {
            write!(f, ": {}", self.names.join(", "))?;
            f.write_str(if self.has_more_names { ", …" } else { "" })?;
        }
        match self.count {
            1 => write!(f, " ({first})")?,
            _ => write!(f, " (first at {first})")?,
        }
        f.write_str(self.kind.remark())
    }
}

/// The notices of a file, one for each kind.
#[derive(Default)]
pub(crate) struct Notices(pub(crate) Vec<Notice>);

impl Notices {
    /// Counts one more occurrence of `kind`.
    pub(crate) fn add(&mut self, kind: IgnoredKind, place: Place) {
        self.add_many(kind, 1, place);
    }

    /// Counts `count` more occurrences of `kind`, unless it is 0.
    pub(crate) fn add_many(&mut self, kind: IgnoredKind, count: u64, place: Place) {
        if count > 0 {
            let notice = self.entry(kind, place);
            notice.count = notice.count.saturating_add(count);
        }
    }

    /// Counts `count` more occurrences of `kind`, which the file calls `name`.
    pub(crate) fn add_named(&mut self, kind: IgnoredKind, count: u64, place: Place, name: &str) {
        if count == 0 {
            return;
        }
        let notice = self.entry(kind, place);
        notice.count = notice.count.saturating_add(count);
        let name = shortened(name);
        if notice.names.contains(&name) {
            return;
        }
        match notice.names.len() < Notice::MAX_NAMES {
            true => notice.names.push(name),
            false => notice.has_more_names = true,
        }
    }

    fn entry(&mut self, kind: IgnoredKind, first: Place) -> &mut Notice {
        let known = self.0.iter().position(|notice| notice.kind == kind);
        let at = known.unwrap_or_else(|| {
            self.0.push(Notice {
                kind,
                count: 0,
                first,
                names: Vec::new(),
                has_more_names: false,
            });
            self.0.len() - 1
        });
        &mut self.0[at]
    }
}
