//! Edits as values: the kind of an edit with its arguments.

use std::convert::Infallible;
use std::fmt;
use std::str::{FromStr, SplitWhitespace};

use crate::Point;
use crate::edit::edit_kind::Edit;
use crate::edit::edit_log::EditLog;
use crate::edit::element_name::{ElementName, NoElementName};
use crate::edit::element_names::ElementNames;
use crate::edit::mesh_edit::{MeshEdit, Refusal};
use crate::handles::handle::Handle;
use crate::named::UnknownName;
use crate::traits::query::MeshQuery;

/// An edit with elements of the mesh `M` as arguments.
pub type EditOf<M> =
    EditCall<<M as MeshQuery>::Vertex, <M as MeshQuery>::Edge, <M as MeshQuery>::Face>;

/// An edit with the names of elements as arguments. The position that an edit needs for a new vertex
/// can be left out: then it is the middle of the edge, of the face, or, for `split_vertex`, of the
/// vertex and its neighbours `left` and `right`.
///
/// As text, the arguments are separated by spaces:
///
/// | edit | arguments |
/// |---|---|
/// | `set_position` | vertex, position such as `0.5,1,0` |
/// | `add_vertex` | position |
/// | `add_face` | three or more vertices |
/// | `remove_face` | face |
/// | `remove_faces` | one or more faces |
/// | `remove_vertex` | vertex |
/// | `remove_isolated_vertices`, `compact` | none |
/// | `split_edge`, `bisect_edge` | edge; position |
/// | `poke_face` | face; position |
/// | `split_face` | face, two of its vertices |
/// | `dissolve_edge`, `flip_edge` | edge |
/// | `collapse_edge` | edge, the end that stays; position |
/// | `split_vertex` | vertex, left vertex, right vertex (`none` at a boundary); position |
///
/// The positions after a semicolon can be left out.
///
/// ```
/// use sixfold_core::{EditByName, EditCall};
///
/// let edit: EditByName = "split_vertex v0 v1 none 0.5,1,0".parse()?;
/// assert!(matches!(edit, EditCall::SplitVertex { v: 0, left: Some(1), right: None, .. }));
/// assert_eq!(edit.to_string(), "split_vertex v0 v1 none 0.5,1,0");
/// # Ok::<(), sixfold_core::EditTextError>(())
/// ```
pub type EditByName = EditCall<u32, [u32; 2], u32, Option<Point>>;

/// One argument of an edit.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say what the arguments are")]
pub enum EditArgument<'a, V, E, F, P = Point> {
    Vertex(&'a V),
    /// A vertex that may be missing.
    VertexIfAny(Option<&'a V>),
    Edge(&'a E),
    Face(&'a F),
    Position(&'a Point),
    /// The position of a vertex that is made or merged.
    NewPosition(&'a P),
}

/// A source of arguments for edits, which are asked in the order of the methods of [`MeshEdit`].
#[expect(missing_docs, reason = "each method returns one argument")]
#[expect(
    clippy::missing_errors_doc,
    reason = "the source has no argument of this kind"
)]
pub trait EditArguments {
    type Vertex;
    type Edge;
    type Face;
    type Position;
    type Error;

    fn vertex(&mut self) -> Result<Self::Vertex, Self::Error>;
    fn vertex_if_any(&mut self) -> Result<Option<Self::Vertex>, Self::Error>;
    /// Returns the corners of a new face.
    fn vertices(&mut self) -> Result<Vec<Self::Vertex>, Self::Error>;
    /// Returns two corners of a face.
    fn corners(&mut self) -> Result<[Self::Vertex; 2], Self::Error>;
    fn edge(&mut self) -> Result<Self::Edge, Self::Error>;
    fn face(&mut self) -> Result<Self::Face, Self::Error>;
    fn faces(&mut self) -> Result<Vec<Self::Face>, Self::Error>;
    fn position(&mut self) -> Result<Point, Self::Error>;
    /// Returns the position of a vertex that is made or merged.
    fn new_position(&mut self) -> Result<Self::Position, Self::Error>;
}

/// What an edit returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say what the results are")]
pub enum EditResult<V, E, F> {
    Vertex(V),
    Edge(E),
    Face(F),
    /// The number of removed vertices.
    Count(usize),
    Nothing,
}

/// Code for one argument of an edit, by the kind of the argument.
macro_rules! argument {
    (pass vertices $a:ident) => {
        $a
    };
    (pass faces $a:ident) => {
        $a
    };
    (pass $kind:ident $a:ident) => {
        *$a
    };
    (map vertex $a:ident $v:ident $e:ident $f:ident) => {
        $v($a)?
    };
    (map vertex_if_any $a:ident $v:ident $e:ident $f:ident) => {
        match $a {
            Some(v) => Some($v(v)?),
            None => None,
        }
    };
    (map vertices $a:ident $v:ident $e:ident $f:ident) => {
        $a.iter().map(&mut $v).collect::<Result<_, _>>()?
    };
    (map faces $a:ident $v:ident $e:ident $f:ident) => {
        $a.iter().map(&mut $f).collect::<Result<_, _>>()?
    };
    (map corners $a:ident $v:ident $e:ident $f:ident) => {{
        let [a, b] = $a;
        [$v(a)?, $v(b)?]
    }};
    (map edge $a:ident $v:ident $e:ident $f:ident) => {
        $e($a)?
    };
    (map face $a:ident $v:ident $e:ident $f:ident) => {
        $f($a)?
    };
    (map position $a:ident $v:ident $e:ident $f:ident) => {
        *$a
    };
    (map new_position $a:ident $v:ident $e:ident $f:ident) => {
        $a.clone()
    };
    (place new_position $a:ident $to:ident) => {
        $to($a)
    };
    (place $kind:ident $a:ident $to:ident) => {
        $a
    };
    (visit vertex $a:ident $visit:ident) => {
        $visit(EditArgument::Vertex($a))
    };
    (visit vertex_if_any $a:ident $visit:ident) => {
        $visit(EditArgument::VertexIfAny($a.as_ref()))
    };
    (visit vertices $a:ident $visit:ident) => {
        $a.iter().for_each(|v| $visit(EditArgument::Vertex(v)))
    };
    (visit faces $a:ident $visit:ident) => {
        $a.iter().for_each(|f| $visit(EditArgument::Face(f)))
    };
    (visit corners $a:ident $visit:ident) => {
        $a.iter().for_each(|v| $visit(EditArgument::Vertex(v)))
    };
    (visit edge $a:ident $visit:ident) => {
        $visit(EditArgument::Edge($a))
    };
    (visit face $a:ident $visit:ident) => {
        $visit(EditArgument::Face($a))
    };
    (visit position $a:ident $visit:ident) => {
        $visit(EditArgument::Position($a))
    };
    (visit new_position $a:ident $visit:ident) => {
        $visit(EditArgument::NewPosition($a))
    };
    (result vertex $result:expr) => {
        $result.map(EditResult::Vertex)
    };
    (result edge $result:expr) => {
        $result.map(EditResult::Edge)
    };
    (result face $result:expr) => {
        $result.map(EditResult::Face)
    };
    (result nothing $result:expr) => {
        $result.map(|()| EditResult::Nothing)
    };
    (result count $result:expr) => {
        Ok(EditResult::Count($result))
    };
    (result unit $result:expr) => {{
        $result;
        Ok(EditResult::Nothing)
    }};
}

macro_rules! edit_calls {
    ($($edit:ident $name:literal $method:ident($($a:ident: $kind:ident $type:ty),*) -> $result:ident;)+) => {
        /// An edit with its arguments. Its values are the methods of [`MeshEdit`].
        ///
        /// The type parameters say how vertices, edges, faces, and the positions of new vertices are
        /// given: by handles ([`EditOf`]), by names ([`EditByName`]), or by other numbers.
        #[derive(Clone, Debug, PartialEq)]
        #[expect(
            missing_docs,
            reason = "the names are those of the methods and arguments of MeshEdit"
        )]
        pub enum EditCall<V, E, F, P = Point> {
            $($edit { $($a: $type),* },)+
        }

        impl<V, E, F, P> EditCall<V, E, F, P> {
            /// Returns the kind of the edit.
            pub const fn edit(&self) -> Edit {
                match self {
                    $(Self::$edit { .. } => Edit::$edit,)+
                }
            }

            /// Makes an edit of the given kind. `from` gives the arguments, in their order.
            ///
            /// # Errors
            ///
            /// Returns the first error of `from`.
            pub fn with_arguments<A>(edit: Edit, from: &mut A) -> Result<Self, A::Error>
            where
                A: EditArguments<Vertex = V, Edge = E, Face = F, Position = P>,
            {
                Ok(match edit {
                    $(Edit::$edit => Self::$edit {
                        $($a: from.$kind()?),*
                    },)+
                })
            }

            /// Translates the elements, in their order.
            ///
            /// # Errors
            ///
            /// Returns the first error of the functions.
            pub fn try_map<W, D, G, Error>(
                &self,
                mut vertex: impl FnMut(&V) -> Result<W, Error>,
                mut edge: impl FnMut(&E) -> Result<D, Error>,
                mut face: impl FnMut(&F) -> Result<G, Error>,
            ) -> Result<EditCall<W, D, G, P>, Error>
            where
                P: Clone,
            {
                let _ = (&mut vertex, &mut edge, &mut face);
                Ok(match self {
                    $(Self::$edit { $($a),* } => EditCall::$edit {
                        $($a: argument!(map $kind $a vertex edge face)),*
                    },)+
                })
            }

            /// Translates the position of a new vertex.
            pub fn map_position<Q>(self, to: impl FnOnce(P) -> Q) -> EditCall<V, E, F, Q> {
                match self {
                    $(Self::$edit { $($a),* } => EditCall::$edit {
                        $($a: argument!(place $kind $a to)),*
                    },)+
                }
            }

            /// Calls a function with each argument, in their order.
            pub fn for_each_argument<'a>(
                &'a self,
                mut visit: impl FnMut(EditArgument<'a, V, E, F, P>),
            ) {
                match self {
                    $(Self::$edit { $($a),* } => {
                        $(argument!(visit $kind $a visit);)*
                    })+
                }
            }
        }

        impl<V: Handle, E: Handle, F: Handle> EditCall<V, E, F> {
            /// Runs the edit, and reports all changes to `log`.
            ///
            /// # Errors
            ///
            /// Returns the error of the method of [`MeshEdit`].
            #[inline(always)]
            pub fn apply<M>(
                &self,
                mesh: &mut M,
                log: &mut impl EditLog<M>,
            ) -> Result<EditResult<V, E, F>, Refusal<M>>
            where
                M: MeshEdit<Vertex = V, Edge = E, Face = F>,
            {
                match self {
                    $(Self::$edit { $($a),* } => {
                        argument!(result $result mesh.$method($(argument!(pass $kind $a),)* log))
                    })+
                }
            }
        }
    };
}

crate::for_each_edit!(edit_calls! {});

impl<V, E, F, P> EditCall<V, E, F, P> {
    /// Returns the first argument for which `get` returns a value.
    pub fn find_argument<'a, T>(
        &'a self,
        get: impl Fn(EditArgument<'a, V, E, F, P>) -> Option<T>,
    ) -> Option<T> {
        let mut found = None;
        self.for_each_argument(|argument| {
            if found.is_none() {
                found = get(argument);
            }
        });
        found
    }

    /// Returns the edge among the arguments.
    pub fn edge(&self) -> Option<&E> {
        self.find_argument(|argument| match argument {
            EditArgument::Edge(e) => Some(e),
            _ => None,
        })
    }

    /// Returns the face among the arguments.
    pub fn face(&self) -> Option<&F> {
        self.find_argument(|argument| match argument {
            EditArgument::Face(f) => Some(f),
            _ => None,
        })
    }

    /// Returns the vertices among the arguments, without the ends of an edge.
    pub fn vertices(&self) -> impl Iterator<Item = &V> {
        let mut vertices = Vec::new();
        self.for_each_argument(|argument| match argument {
            EditArgument::Vertex(v) => vertices.push(v),
            EditArgument::VertexIfAny(v) => vertices.extend(v),
            _ => {}
        });
        vertices.into_iter()
    }
}

impl<V: Handle, E: Handle, F: Handle> EditCall<V, E, F, Option<Point>> {
    /// Gives the edit the middle of its edge, of its face or of its vertices, if it needs a position
    /// that was left out.
    #[must_use]
    pub fn with_middle<M>(self, mesh: &M) -> EditCall<V, E, F>
    where
        M: MeshQuery<Vertex = V, Edge = E, Face = F>,
    {
        let vertices: Vec<V> = match (self.edge(), self.face()) {
            (Some(&e), _) => mesh.edge_vertices(e).to_vec(),
            (None, Some(&f)) => mesh.face_vertices(f).collect(),
            (None, None) => self.vertices().copied().collect(),
        };
        self.map_position(|position| {
            position.unwrap_or_else(|| {
                let sum: Point = vertices.iter().map(|&v| mesh.position(v)).sum();
                sum / vertices.len() as f32
            })
        })
    }
}

impl EditByName {
    /// Translates the names to handles of `mesh`, and a position that was left out to the middle.
    ///
    /// # Errors
    ///
    /// Returns the first name that has no element in the mesh.
    pub fn find<M: MeshQuery>(
        &self,
        mesh: &M,
        names: &ElementNames<M::Vertex, M::Face>,
    ) -> Result<EditOf<M>, ElementName> {
        let vertex = |&v: &u32| names.vertex(v).ok_or(ElementName::Vertex(v));
        let edge = |&ends: &[u32; 2]| {
            let [a, b] = ends.map(|v| names.vertex(v));
            let edge = a.zip(b).and_then(|(a, b)| mesh.edge_between(a, b));
            edge.ok_or(ElementName::Edge(ends))
        };
        let face = |&f: &u32| names.face(f).ok_or(ElementName::Face(f));
        Ok(self.try_map(vertex, edge, face)?.with_middle(mesh))
    }
}

/// The error for a text that is not an edit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum EditTextError {
    /// A word that is not the name of an edit.
    #[error(transparent)]
    UnknownEdit(#[from] UnknownName),
    /// A word that is not the name of an element.
    #[error(transparent)]
    NoElementName(#[from] NoElementName),
    /// A word that is not a position.
    #[error("`{text}` is not a position: write 0.5,1,0")]
    NotAPosition { text: String },
    /// Arguments of other kinds, too many, or too few.
    #[error("`{text}`: write {example}")]
    OtherArguments { text: String, example: String },
}

impl fmt::Display for EditByName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = self.edit().name().to_owned();
        let mut word = |word: &dyn fmt::Display| text += &format!(" {word}");
        self.for_each_argument(|argument| match argument {
            EditArgument::Vertex(&v) | EditArgument::VertexIfAny(Some(&v)) => {
                word(&ElementName::Vertex(v));
            }
            EditArgument::VertexIfAny(None) => word(&NONE),
            EditArgument::Edge(&ends) => word(&ElementName::Edge(ends)),
            EditArgument::Face(&face) => word(&ElementName::Face(face)),
            EditArgument::Position(p) | EditArgument::NewPosition(Some(p)) => {
                word(&format_args!("{},{},{}", p.x, p.y, p.z));
            }
            EditArgument::NewPosition(None) => {}
        });
        f.write_str(&text)
    }
}

/// The word for a vertex that is missing.
const NONE: &str = "none";

impl FromStr for EditByName {
    type Err = EditTextError;

    fn from_str(text: &str) -> Result<Self, EditTextError> {
        let mut words = text.split_whitespace();
        let edit = words.next().unwrap_or_default().parse()?;
        let mut words = Words { text, words, edit };
        let call = Self::with_arguments(edit, &mut words)?;
        match words.words.next() {
            None => Ok(call),
            Some(_) => Err(words.other_arguments()),
        }
    }
}

/// The arguments of an edit as text.
struct Words<'t> {
    text: &'t str,
    words: SplitWhitespace<'t>,
    edit: Edit,
}

impl Words<'_> {
    fn other_arguments(&self) -> EditTextError {
        let text = self.text.to_owned();
        let Ok(example) = EditByName::with_arguments(self.edit, &mut Example::default());
        let whole = example.clone().map_position(|_| Some(EXAMPLE));
        let example = match whole == example {
            true => format!("`{example}`"),
            false => format!("`{example}` or `{whole}`"),
        };
        EditTextError::OtherArguments { text, example }
    }

    fn element(&mut self) -> Result<ElementName, EditTextError> {
        let word = self.words.next().ok_or_else(|| self.other_arguments())?;
        Ok(word.parse()?)
    }

    /// Returns the next word, if it is a position.
    fn next_position(&mut self) -> Result<Option<Point>, EditTextError> {
        let mut rest = self.words.clone();
        let Some(word) = rest.next().filter(|word| word.contains(',')) else {
            return Ok(None);
        };
        self.words = rest;
        let numbers: Option<Vec<f32>> = word.split(',').map(|x| x.parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y, z]) if x.is_finite() && y.is_finite() && z.is_finite() => {
                Ok(Some(Point::new(x, y, z)))
            }
            _ => Err(EditTextError::NotAPosition { text: word.into() }),
        }
    }
}

impl EditArguments for Words<'_> {
    type Vertex = u32;
    type Edge = [u32; 2];
    type Face = u32;
    type Position = Option<Point>;
    type Error = EditTextError;

    fn vertex(&mut self) -> Result<u32, EditTextError> {
        match self.element()? {
            ElementName::Vertex(v) => Ok(v),
            _ => Err(self.other_arguments()),
        }
    }

    fn vertex_if_any(&mut self) -> Result<Option<u32>, EditTextError> {
        if self.words.clone().next() == Some(NONE) {
            self.words.next();
            return Ok(None);
        }
        self.vertex().map(Some)
    }

    fn vertices(&mut self) -> Result<Vec<u32>, EditTextError> {
        let mut vertices = Vec::new();
        while vertices.len() < 3 || self.words.clone().next().is_some() {
            vertices.push(self.vertex()?);
        }
        Ok(vertices)
    }

    fn corners(&mut self) -> Result<[u32; 2], EditTextError> {
        Ok([self.vertex()?, self.vertex()?])
    }

    fn edge(&mut self) -> Result<[u32; 2], EditTextError> {
        match self.element()? {
            ElementName::Edge(ends) => Ok(ends),
            _ => Err(self.other_arguments()),
        }
    }

    fn face(&mut self) -> Result<u32, EditTextError> {
        match self.element()? {
            ElementName::Face(f) => Ok(f),
            _ => Err(self.other_arguments()),
        }
    }

    fn faces(&mut self) -> Result<Vec<u32>, EditTextError> {
        let mut faces = vec![self.face()?];
        while self.words.clone().next().is_some() {
            faces.push(self.face()?);
        }
        Ok(faces)
    }

    fn position(&mut self) -> Result<Point, EditTextError> {
        self.next_position()?.ok_or_else(|| self.other_arguments())
    }

    fn new_position(&mut self) -> Result<Option<Point>, EditTextError> {
        self.next_position()
    }
}

/// Arguments that show how an edit is written.
#[derive(Default)]
struct Example {
    vertices: u32,
}

const EXAMPLE: Point = Point::new(0.5, 1.0, 0.0);

impl EditArguments for Example {
    type Vertex = u32;
    type Edge = [u32; 2];
    type Face = u32;
    type Position = Option<Point>;
    type Error = Infallible;

    fn vertex(&mut self) -> Result<u32, Infallible> {
        self.vertices += 1;
        Ok(self.vertices - 1)
    }

    fn vertex_if_any(&mut self) -> Result<Option<u32>, Infallible> {
        self.vertex().map(Some)
    }

    fn vertices(&mut self) -> Result<Vec<u32>, Infallible> {
        Ok(vec![0, 1, 2])
    }

    fn corners(&mut self) -> Result<[u32; 2], Infallible> {
        Ok([0, 2])
    }

    fn edge(&mut self) -> Result<[u32; 2], Infallible> {
        Ok([0, 1])
    }

    fn face(&mut self) -> Result<u32, Infallible> {
        Ok(0)
    }

    fn faces(&mut self) -> Result<Vec<u32>, Infallible> {
        Ok(vec![0, 1])
    }

    fn position(&mut self) -> Result<Point, Infallible> {
        Ok(EXAMPLE)
    }

    fn new_position(&mut self) -> Result<Option<Point>, Infallible> {
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_read_and_written() {
        for edit in Edit::ALL {
            let Ok(example) = EditByName::with_arguments(edit, &mut Example::default());
            let with_position = example.clone().map_position(|_| Some(EXAMPLE));
            for call in [example, with_position] {
                let text = call.to_string();
                assert_eq!(text.parse(), Ok(call.clone()), "{text}");
                assert_eq!(call.edit(), edit);
                assert!(text.starts_with(edit.name()), "{text}");
            }
        }
        for text in [
            "set_position v0 0.5,1,0",
            "add_face v0 v1 v2 v3 v4",
            "remove_faces f2",
            "remove_faces f2 f0 f1",
            "split_face f0 v0 v2",
            "collapse_edge v0-v1 v0",
            "collapse_edge v0-v1 v0 -0,1,0.1",
            "split_vertex v0 v1 v2",
            "split_vertex v0 v1 none 0.5,1,0",
        ] {
            let call: EditByName = text.parse().expect(text);
            assert_eq!(call.to_string(), text);
        }
    }

    #[test]
    fn each_wrong_edit_says_what_to_write() {
        for (text, expected) in [
            ("", "choose"),
            ("flip", "choose"),
            ("flip_edge", "write `flip_edge v0-v1`"),
            ("flip_edge v0", "write `flip_edge v0-v1`"),
            ("flip_edge v0-v1 v1", "write `flip_edge v0-v1`"),
            ("flip_edge v0-v1 0,0,0", "write `flip_edge v0-v1`"),
            ("flip_edge none", "write v3 for a vertex"),
            ("add_face v0 v1", "write `add_face v0 v1 v2`"),
            ("add_face v0 v1 none", "write v3 for a vertex"),
            ("remove_faces", "write `remove_faces f0 f1`"),
            ("remove_faces f0 v1", "write `remove_faces f0 f1`"),
            ("add_vertex", "write `add_vertex 0.5,1,0`"),
            ("add_vertex 0,0", "write 0.5,1,0"),
            ("add_vertex 0,0,nan", "write 0.5,1,0"),
            ("set_position v0", "write `set_position v0 0.5,1,0`"),
            (
                "collapse_edge v0-v1 f0",
                "or `collapse_edge v0-v1 v0 0.5,1,0`",
            ),
            ("split_vertex v0 v1", "write `split_vertex v0 v1 v2` or"),
            ("compact v0", "write `compact`"),
            ("split_face f0 v0 v1 v2", "write `split_face f0 v0 v2`"),
        ] {
            let error = text.parse::<EditByName>().expect_err(text).to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
