"""The tables of workloads in reports/README.md."""

from checks import data
from checks.advice import MESHES, plain

# In the order of `sixfold workloads`.
NAMES = (
    "rendering-upload", "vertex-normals", "ray-casting-setup", "smoothing", "remeshing", "decimation", "modelling",
    "subdivision", "region-growing", "geodesic-dijkstra", "parameterisation", "sculpting-brush", "feature-detection", "boundary-repair",
    "one-shot-conversion",
)
SHOWN = 3


def on_each(name, cell):
    """Returns a cell of each mesh for a workload. A mesh on which it cannot run has none."""
    known = data.workloads()
    return tuple(cell(known[name, mesh]) if (name, mesh) in known else "–" for mesh in MESHES)


def fastest_row(name):
    return on_each(name, fastest)


def cheapest_row(name):
    return on_each(name, cheapest)


def fastest(workload):
    """Returns the fastest backends with their ratios. The best and those tied with it are bold."""
    leaders = workload.leaders()
    ordered = sorted(workload.rows, key=workload.ns)
    shown = [backend for place, backend in enumerate(ordered) if place < SHOWN or backend in leaders]
    if not leaders:
        return "no winner: " + ", ".join(with_ratio(workload, backend) for backend in shown)
    bold = lambda backend: f"**{with_ratio(workload, backend)}**" if backend in leaders else with_ratio(workload, backend)
    return ", ".join(bold(backend) for backend in shown)


def cheapest(workload):
    return plain(workload.cheapest()) if workload.leaders() else "–"


def with_ratio(workload, backend):
    ratio = "" if backend == workload.fastest else f" {workload.ratio(backend):#.3g}"
    return plain(backend) + ratio


def meshes():
    """Returns the meshes of all documents."""
    return [mesh for read in data.workload_documents() for mesh in read["meshes"]]
