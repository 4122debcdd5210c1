//! What of a file is passed over.

use std::fmt;

/// A kind of statement, or part of one, that a mesh does not need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Passed {
    /// `vt`.
    TextureCoordinates,
    /// `vn`.
    Normals,
    /// What follows the three coordinates of a vertex: a weight or a colour.
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
    /// Curves and surfaces: `curv`, `surf`, `vp` and their kin.
    FreeForm,
    /// How to draw it: `bevel`, `lod` and their kin.
    Display,
    /// `t interpolateboundary` and its kin: how subdivision treats boundaries.
    BoundaryTags,
    /// `t creasemethod`: how sharpness wears off.
    CreaseMethodTags,
    /// `t hole`: faces that are not drawn.
    HoleTags,
    /// `t` with another name.
    OtherTags,
    /// A keyword that OBJ does not have.
    Unknown,
}

impl Passed {
    /// What a statement with this keyword is; neither `v` nor `f`.
    pub(crate) fn of(keyword: &[u8]) -> Self {
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

    /// What a `t` statement with this name is; neither `crease` nor `corner`.
    pub(crate) fn of_tag(name: &[u8]) -> Self {
        match name {
            b"interpolateboundary"
            | b"facevaryinginterpolateboundary"
            | b"facevaryingpropagatecorners" => Self::BoundaryTags,
            b"creasemethod" => Self::CreaseMethodTags,
            b"hole" => Self::HoleTags,
            _ => Self::OtherTags,
        }
    }

    /// What one and what several of them are called.
    const fn names(self) -> [&'static str; 2] {
        match self {
            Self::TextureCoordinates => ["texture coordinate", "texture coordinates"],
            Self::Normals => ["normal", "normals"],
            Self::ExtraValues => [
                "weight or colour of a vertex",
                "weights or colours of vertices",
            ],
            Self::Objects => ["object name", "object names"],
            Self::Groups => ["group", "groups"],
            Self::Materials => ["material statement", "material statements"],
            Self::SmoothingGroups => ["smoothing group", "smoothing groups"],
            Self::Lines => ["line", "lines"],
            Self::Points => ["point statement", "point statements"],
            Self::FreeForm => ["free-form statement", "free-form statements"],
            Self::Display => ["display attribute", "display attributes"],
            Self::BoundaryTags => ["tag of boundary rules", "tags of boundary rules"],
            Self::CreaseMethodTags => ["tag of the crease method", "tags of the crease method"],
            Self::HoleTags => ["tag of holes", "tags of holes"],
            Self::OtherTags => ["tag of another kind", "tags of another kind"],
            Self::Unknown => ["unknown statement", "unknown statements"],
        }
    }
}

/// One kind of thing that was passed over; prints as
/// `passed over 48612 texture coordinates (first at line 12)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// What it is.
    pub passed: Passed,
    /// How often it stands there; of values after coordinates, how many vertices have some.
    pub count: usize,
    /// The line of the first.
    pub first_line: u32,
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, several] = self.passed.names();
        let line = self.first_line;
        match self.count {
            1 => write!(f, "passed over 1 {one} (line {line})"),
            n => write!(f, "passed over {n} {several} (first at line {line})"),
        }
    }
}

/// Adds one more of `passed`, at `line`, to `notices`, of which there is one for each kind.
pub(crate) fn note(notices: &mut Vec<Notice>, passed: Passed, line: u32) {
    match notices.iter_mut().find(|notice| notice.passed == passed) {
        Some(notice) => notice.count += 1,
        None => notices.push(Notice {
            passed,
            count: 1,
            first_line: line,
        }),
    }
}
