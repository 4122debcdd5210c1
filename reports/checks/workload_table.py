"""The table of workloads in reports/README.md."""

from checks import data
from checks.data import BUILT_IN, SHUFFLED

# In the order of `sixfold workloads`.
NAMES = (
    "rendering-upload", "vertex-normals", "ray-casting-setup", "smoothing", "remeshing", "decimation", "subdivision",
    "region-growing", "geodesic-dijkstra", "parameterisation", "sculpting-brush", "feature-detection", "boundary-repair",
    "one-shot-conversion",
)
SHOWN = 4


def cells(name):
    """Returns the four cells of a workload: the fastest backends and the cheapest for one use, on each mesh."""
    rows = [data.workload(name, mesh) for mesh in (BUILT_IN, SHUFFLED)]
    return tuple(cell for workload in rows for cell in (fastest(workload), cheapest(workload)))


def row(name):
    return f"| {name} | {' | '.join(cells(name))} |"


def fastest(workload):
    """Returns the fastest backends with their ratios. The best and those tied with it are bold."""
    leaders = workload.leaders()
    shown = sorted(workload.rows, key=workload.ns)[: max(SHOWN, len(leaders))]
    if not leaders:
        return "no winner: " + ", ".join(with_ratio(workload, backend) for backend in shown)
    bold = lambda backend: f"**{with_ratio(workload, backend)}**" if backend in leaders else with_ratio(workload, backend)
    return ", ".join(bold(backend) for backend in shown)


def cheapest(workload):
    return plain(workload.cheapest()) if workload.leaders() else "–"


def with_ratio(workload, backend):
    ratio = "" if backend == workload.fastest else f" {workload.ratio(backend):#.3g}"
    return plain(backend) + ratio


def plain(backend):
    """Returns the name of a backend in a sentence."""
    return backend if backend.endswith(("-edge", "-vertex")) else backend.replace("-", " ")


def meshes():
    """Returns the meshes of all documents."""
    return [mesh for read in data.workload_documents() for mesh in read["meshes"]]
