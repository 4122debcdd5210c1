//! The workloads that Sixfold brings along, as the very files that users can copy and change.

use crate::workload::Workload;

/// The names, and the files.
const FILES: [(&str, &str); 12] = [
    (
        "rendering-upload",
        include_str!("../workloads/rendering-upload.toml"),
    ),
    (
        "ray-casting-setup",
        include_str!("../workloads/ray-casting-setup.toml"),
    ),
    ("smoothing", include_str!("../workloads/smoothing.toml")),
    ("remeshing", include_str!("../workloads/remeshing.toml")),
    ("decimation", include_str!("../workloads/decimation.toml")),
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
        "boundary-repair",
        include_str!("../workloads/boundary-repair.toml"),
    ),
    (
        "one-shot-conversion",
        include_str!("../workloads/one-shot-conversion.toml"),
    ),
];

/// The names of the built-in workloads and the text of their files, in the order in which they are
/// listed.
pub fn built_ins() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.into_iter()
}

/// The built-in workload called `name`.
///
/// # Panics
///
/// If a file that we ship were faulty; a test reads them all.
pub fn built_in(name: &str) -> Option<Workload> {
    let (name, text) = FILES.into_iter().find(|(known, _)| *known == name)?;
    let workload = Workload::parse(name, &format!("{name}.toml"), text);
    Some(workload.unwrap_or_else(|error| panic!("a file of ours is faulty: {error}")))
}
