//! The built-in workloads, as files that users can copy and change.

use crate::workload::Workload;

/// The names and the texts of the files.
const FILES: [(&str, &str); 15] = [
    (
        "rendering-upload",
        include_str!("../workloads/rendering-upload.toml"),
    ),
    (
        "vertex-normals",
        include_str!("../workloads/vertex-normals.toml"),
    ),
    (
        "ray-casting-setup",
        include_str!("../workloads/ray-casting-setup.toml"),
    ),
    ("smoothing", include_str!("../workloads/smoothing.toml")),
    ("remeshing", include_str!("../workloads/remeshing.toml")),
    ("decimation", include_str!("../workloads/decimation.toml")),
    ("modelling", include_str!("../workloads/modelling.toml")),
    ("subdivision", include_str!("../workloads/subdivision.toml")),
    (
        "region-growing",
        include_str!("../workloads/region-growing.toml"),
    ),
    (
        "geodesic-dijkstra",
        include_str!("../workloads/geodesic-dijkstra.toml"),
    ),
    (
        "parameterisation",
        include_str!("../workloads/parameterisation.toml"),
    ),
    (
        "sculpting-brush",
        include_str!("../workloads/sculpting-brush.toml"),
    ),
    (
        "feature-detection",
        include_str!("../workloads/feature-detection.toml"),
    ),
    (
        "boundary-repair",
        include_str!("../workloads/boundary-repair.toml"),
    ),
    (
        "one-shot-conversion",
        include_str!("../workloads/one-shot-conversion.toml"),
    ),
];

/// Returns the names of the built-in workloads, with the texts of their files.
pub fn built_ins() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.into_iter()
}

/// Returns the built-in workload called `name`; `None` if the name is unknown.
///
/// # Panics
///
/// Panics if the file of the workload has an error. A test parses all built-in files.
pub fn built_in(name: &str) -> Option<Workload> {
    let (name, text) = FILES.into_iter().find(|(known, _)| *known == name)?;
    let workload = Workload::parse(name, &format!("{name}.toml"), text);
    Some(workload.unwrap_or_else(|error| panic!("a built-in file has an error: {error}")))
}
