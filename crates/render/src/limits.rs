//! The limits of pictures.

/// Maximum width and height of a picture, in pixels.
pub const MAX_SIDE: u32 = 8192;

/// Maximum number of pixels of a picture.
pub const MAX_PIXELS: u32 = 1 << 23;

/// Minimum width and height, in pixels, of the part of a picture that shows one mesh.
pub const MIN_PANEL: u32 = 16;

/// Maximum number of vertices, edges and faces of a mesh with labels. More labels cannot be read.
pub const MAX_LABELS: usize = 2000;

/// Maximum number of visible faces of a mesh in an SVG file. SVG viewers fail to show more faces.
pub const MAX_SVG_FACES: usize = 50_000;
