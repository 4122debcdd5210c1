//! Arguments of `sixfold render`.

use std::path::PathBuf;

use clap::Args;
use sixfold_render::{Shading, Size, Up, View};

use super::ReadPolygons;

const EXAMPLES: &str = "Examples:
  sixfold render bunny.obj -o bunny.png
  sixfold render cage.obj level1.obj level2.obj -o row.svg --edges --size 1200x400
  sixfold render part.obj --creases part.creases -o part.png --view iso --up z
  sixfold render part.obj -o part.svg --wireframe --view=-20,10
  sixfold render scan.stl -o faults.png --faults --edges --labels

Several meshes are drawn in a row, all at one scale. Sharp edges and corners are red. The tags
`t crease` and `t corner` of the OBJ file, and the crease file, list the sharp edges and corners.
Give --creases at most once per mesh, in the order of the meshes. The front of a face is blue; the
back is sand-coloured. Seen from the front, the corners of a face run counter-clockwise. An SVG has
one colour per face.

With --faults, boundary edges are orange, non-manifold edges and vertices are magenta, and faces
that are turned against their neighbours or into their solid are yellow. `sixfold inspect` lists all
faults. A mesh with --labels can have at most 2,000 vertices, edges and faces.

Exit codes: 0 success; 2 wrong usage or unusable input; 3 too many faces for an SVG or too many
labels; 4 interrupted, nothing written.";

/// Draw meshes with their edges and creases, as PNG or SVG.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Render {
    /// The meshes
    #[arg(value_name = "MESH", required = true)]
    pub(crate) meshes: Vec<PathBuf>,
    /// The picture to write; .png or .svg selects the format
    #[arg(short, long, value_name = "OUT.png|OUT.svg")]
    pub(crate) output: PathBuf,
    /// Pixels of the whole picture [default: 480 × 480 per mesh]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<Size>,
    /// Viewpoint: degrees to the right and up, or iso
    #[arg(long, value_name = "AZIMUTH,ELEVATION", default_value = "30,22", value_parser = view, allow_hyphen_values = true)]
    pub(crate) view: [f64; 2],
    /// The axis that points up: y or z
    #[arg(long, value_name = "AXIS", default_value = "y")]
    pub(crate) up: Up,
    /// Also draw the edges that are not sharp
    #[arg(long)]
    pub(crate) edges: bool,
    /// Draw all edges, including hidden ones, and no faces
    #[arg(long)]
    pub(crate) wireframe: bool,
    /// Write the names of visible vertices, edges and faces
    #[arg(long)]
    pub(crate) labels: bool,
    /// Paint boundary edges, non-manifold elements and turned faces
    #[arg(long)]
    pub(crate) faults: bool,
    /// Sharp edges and corners, in addition to those in the mesh file
    #[arg(long, value_name = "FILE")]
    pub(crate) creases: Vec<PathBuf>,
    /// Shading: smooth or flat
    #[arg(long, value_name = "KIND", default_value = "smooth")]
    pub(crate) shade: Shading,
    #[command(flatten)]
    pub(crate) read: ReadPolygons,
}

/// Parses `640x480`.
fn size(text: &str) -> Result<Size, String> {
    let sides = text.trim().split_once(['x', '×']);
    let parsed = sides.and_then(|(width, height)| {
        let (width, height) = (width.trim().parse().ok()?, height.trim().parse().ok()?);
        Some(Size { width, height })
    });
    parsed.ok_or_else(|| "write a size in pixels as 640x480".into())
}

/// Parses `30,20` or `iso`.
fn view(text: &str) -> Result<[f64; 2], String> {
    if text.trim() == "iso" {
        return Ok(View::ISO);
    }
    let angles = text.split_once(',').and_then(|(azimuth, elevation)| {
        Some([azimuth.trim().parse().ok()?, elevation.trim().parse().ok()?])
    });
    let wrong = || "write a view in degrees as 30,20, or as iso".to_owned();
    let [azimuth, elevation] = angles.ok_or_else(wrong)?;
    // The up axis does not affect the check of the angles.
    let checked = View::new(azimuth, elevation, Up::Y);
    checked.map_err(|error| error.to_string())?;
    Ok([azimuth, elevation])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_views_are_parsed() {
        let (width, height) = (640, 48);
        assert_eq!(size("640x48"), Ok(Size { width, height }));
        assert_eq!(size(" 640 × 48 "), Ok(Size { width, height }));
        for text in [
            "",
            "640",
            "640x",
            "x48",
            "-1x4",
            "6.5x4",
            "1x2x3",
            "99999999999x4",
        ] {
            assert!(size(text).is_err(), "{text}");
        }
        assert_eq!(view("-30, 20.5"), Ok([-30.0, 20.5]));
        assert_eq!(view("iso"), Ok(View::ISO));
        for text in ["", "30", "30,", "30,91", "nan,0", "inf,0", "1,2,3"] {
            assert!(view(text).is_err(), "{text}");
        }
    }
}
