//! Options of reading.

use crate::format::Format;
use crate::narrowing::Origin;

/// Which vertices with equal positions become one vertex. [The documentation of the
/// crate](crate#which-vertices-become-one) says why.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Welding {
    /// Those of STL, which has no vertex numbers; other formats keep their vertices.
    #[default]
    StlOnly,
    /// Those of every format.
    All,
    /// None: in STL, each facet has three vertices of its own.
    Nothing,
}

/// Which scene of a glTF file is read; other formats have none, and are read as they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Scene {
    /// The default scene of the file, or else its first one.
    #[default]
    Default,
    /// The scene with this number; the first one has number 0.
    Number(usize),
    /// Every node at its place, in one scene or not, and at the origin every mesh that no node names.
    All,
}

/// Options of reading; the default suits most programs.
///
/// # Examples
///
/// ```
/// use sixfold_io::{ReadOptions, Welding, read_from};
///
/// let text = "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
///             endfacet\nfacet\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n\
///             endfacet\nendsolid\n";
/// let square = read_from("square.stl", text.as_bytes(), &ReadOptions::default())?;
/// assert_eq!(square.positions.len(), 4);
/// let as_stored = ReadOptions::default().with_welding(Welding::Nothing);
/// let square = read_from("square.stl", text.as_bytes(), &as_stored)?;
/// assert_eq!(square.positions.len(), 6);
/// # Ok::<(), sixfold_io::ReadError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadOptions {
    pub(crate) format: Option<Format>,
    pub(crate) welding: Welding,
    pub(crate) origin: Origin,
    pub(crate) scene: Scene,
}

impl ReadOptions {
    /// Reads the file as `format`, whatever its content and name are. The two forms of a format
    /// are still told apart by the content.
    #[must_use]
    pub fn with_format(self, format: Format) -> Self {
        let format = Some(format);
        Self { format, ..self }
    }

    /// Sets which vertices with equal positions become one vertex.
    #[must_use]
    pub fn with_welding(self, welding: Welding) -> Self {
        Self { welding, ..self }
    }

    /// Moves the mesh so that the centre of its bounding box is the origin, before coordinates are
    /// rounded to 32 bits. [`FileMesh::origin`](crate::FileMesh::origin) is the old place of the
    /// origin.
    #[must_use]
    pub fn recentred(self) -> Self {
        let origin = Origin::Centre;
        Self { origin, ..self }
    }

    /// Moves the mesh so that `origin`, in the coordinates of the file, is the origin, before
    /// coordinates are rounded to 32 bits. So several files can be moved in the same way:
    ///
    /// ```
    /// use sixfold_io::{ReadOptions, read_from};
    ///
    /// let [first, second] = ["OFF 2 0\n5e5 0 0\n5e5 2 0\n", "OFF 1 0\n500000.01 1 0\n"];
    /// let first = read_from("a.off", first.as_bytes(), &ReadOptions::default().recentred())?;
    /// let options = ReadOptions::default().with_origin(first.origin);
    /// let second = read_from("b.off", second.as_bytes(), &options)?;
    /// assert_eq!((first.origin, second.positions[0].y), ([5e5, 1.0, 0.0], 0.0));
    /// assert!((second.positions[0].x - 0.01).abs() < 1e-9);
    /// # Ok::<(), sixfold_io::ReadError>(())
    /// ```
    #[must_use]
    pub fn with_origin(self, origin: [f64; 3]) -> Self {
        let origin = Origin::At(origin);
        Self { origin, ..self }
    }

    /// Sets which scene of a glTF file is read.
    #[must_use]
    pub fn with_scene(self, scene: Scene) -> Self {
        Self { scene, ..self }
    }
}
