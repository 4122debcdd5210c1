//! The contents of a file that the reader ignores.

use std::fmt;

/// A kind of ignored statement or ignored value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum IgnoredKind {
    /// `vt`.
    TextureCoordinates,
    /// `vn`.
    Normals,
    /// Values after the three coordinates of a vertex: a weight or a colour.
    ExtraValues,
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
    /// `t` with another name.
    OtherTags,
    /// A keyword that is not part of OBJ.
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

    /// Returns the name in the singular and in the plural.
    const fn names(self) -> [&'static str; 2] {
        match self {
            Self::TextureCoordinates => ["texture coordinate", "texture coordinates"],
            Self::Normals => ["normal", "normals"],
            Self::ExtraValues => ["vertex weight or colour", "vertex weights or colours"],
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
            Self::OtherTags => ["other tag", "other tags"],
            Self::Unknown => ["unknown statement", "unknown statements"],
        }
    }
}

/// A kind of ignored statement and the number of such statements, printed for example as `ignored
/// 48612 texture coordinates (first at line 12)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Kind of the ignored statements.
    pub kind: IgnoredKind,
    /// Number of ignored statements. For [`IgnoredKind::ExtraValues`], number of vertices with such
    /// values.
    pub count: usize,
    /// Line of the first ignored statement, counted from 1.
    pub first_line: u32,
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, several] = self.kind.names();
        let line = self.first_line;
        match self.count {
            1 => write!(f, "ignored 1 {one} (line {line})"),
            n => write!(f, "ignored {n} {several} (first at line {line})"),
        }
    }
}

/// Adds a statement of `kind` at `line` to `notices`.
pub(crate) fn add_notice(notices: &mut Vec<Notice>, kind: IgnoredKind, line: u32) {
    match notices.iter_mut().find(|notice| notice.kind == kind) {
        Some(notice) => notice.count += 1,
        None => notices.push(Notice {
            kind,
            count: 1,
            first_line: line,
        }),
    }
}
