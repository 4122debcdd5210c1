"""The claims of reports/editing/README.md, whose tables are computed from editing.json."""

import math
import statistics

from checks import data, figures
from checks.claims import Claims
from checks.data import LOCAL, SCANNING, STRUCTURES

DATA = "reports/editing/editing.json"
EDITS = (
    "set_position", "add_vertex", "add_face", "remove_face", "remove_vertex", "remove_isolated_vertices", "split_edge",
    "bisect_edge", "poke_face", "split_face", "dissolve_edge", "flip_edge", "collapse_edge", "split_vertex", "compact",
)
PASSES = ("split_collapse", "flip_all", "decimate_half", "decimate_tenth")
WHOLE_MESH = ("remove_isolated_vertices", "compact")
# Edits that must find the faces at a vertex or an edge, and edits of a given face.
SEARCHING = ("remove_vertex", "split_edge", "bisect_edge", "dissolve_edge", "flip_edge", "collapse_edge", "split_vertex")
OF_A_FACE = ("remove_face", "poke_face", "split_face")
# The largest mesh that fits into the second-level cache.
CACHED_FACES = 20_000

page = Claims(
    "reports/editing/README.md",
    definitions="""
        up to 4096 places
        (12 places if
        has the time of one edit
        and two exponents
        exponent of about 0
        exponent of about 1
        ## One edit
        has two times
        The two times
        these four structures
        On the four structures
        One untimed edit
        the first exponents are near 0
        with exponents of about 1 on large meshes
    """,
)


def points(what, backend):
    """Returns the numbers of faces and the median times."""
    rows = [row for row in data.document(DATA)["results"] if (row["what"], row["backend"]) == (what, backend)]
    return sorted((row["faces"], statistics.median(row["cpu_ns"])) for row in rows)


def exponent(times):
    """Returns the slope of the line through the logarithms; None for fewer than two times."""
    if len(times) < 2:
        return None
    xs, ys = [math.log(faces) for faces, _ in times], [math.log(max(ns, 0.1)) for _, ns in times]
    return statistics.linear_regression(xs, ys).slope


def exponents(what, backend):
    """Returns the exponents of the meshes that fit into the cache, and of the larger ones."""
    times = points(what, backend)
    cached = [time for time in times if time[0] <= CACHED_FACES]
    return exponent(cached), exponent(cached[-1:] + times[len(cached) :])


def edit_cell(what, backend):
    cached = [time for time in points(what, backend) if time[0] <= CACHED_FACES]
    return " ".join([time_text(cached[-1][1]), *map("{:+.2f}".format, exponents(what, backend))]) if cached else "–"


def pass_cell(what, backend):
    times = points(what, backend)
    slope = exponent([(faces, faces * ns) for faces, ns in times if faces > 10_000])
    shown = "–" if slope is None else f"{slope:.2f}"
    return f"{time_text(times[0][1])} to {time_text(times[-1][1])}, {shown}"


def time_text(ns):
    for least, size, digits, unit in ((1e6, 1e6, 1, "ms"), (1e4, 1e3, 0, "µs"), (1e3, 1e3, 1, "µs")):
        if ns >= least:
            return f"{ns / size:.{digits}f} {unit}"
    return f"{ns:.0f} ns"


def row(cell, what):
    return tuple(cell(what, backend) for backend in STRUCTURES)


for names, cell in ((EDITS, edit_cell), (PASSES, pass_cell)):
    for name in names:
        page.row(f"| `{name}` |" + " {} |" * len(STRUCTURES), row, cell, name)


@page.says(f"| | {' | '.join(STRUCTURES)} |", section="## One edit")
@page.says(f"| | {' | '.join(STRUCTURES)} |", section="## Whole workloads")
def columns():
    found = {row["what"] for row in data.document(DATA)["results"]}
    data.require(found == {*EDITS, *PASSES}, f"{DATA} has the edits {sorted(found)}")


@page.says(data.INTRODUCTION)
def introduction():
    return data.introduction(DATA)


@page.says("The meshes are tori of {} to {} triangles.")
def sizes():
    faces = [row["faces"] for row in data.document(DATA)["results"]]
    return figures.count(min(faces)), figures.count(max(faces))


@page.says("Each cell has the time of one edit on a mesh of {} faces, and two exponents of growth: from {} to {} faces (the "
           "structures fit into the cache), and from {} to {} faces (larger than the cache).")
def ranges():
    faces = sorted({row["faces"] for row in data.document(DATA)["results"]})
    cached = max(size for size in faces if size <= CACHED_FACES)
    return tuple(map(figures.count, (cached, faces[0], cached, cached, faces[-1])))


@page.says("The two times are for {} faces and for the largest mesh")
def smallest():
    return figures.count(min(row["faces"] for row in data.document(DATA)["results"]))


@page.says("for meshes of {} faces or more; –")
def large():
    return figures.count(min(row["faces"] for row in data.document(DATA)["results"] if row["faces"] > 10_000))


# The conclusions have no values, because the program that makes the report also writes them for other machines.


def all_exponents(names, backends, larger):
    measured = [(name, backend) for name in names for backend in backends if points(name, backend)]
    found = {(name, backend): exponents(name, backend)[larger] for name, backend in measured}
    return {key: value for key, value in found.items() if value is not None}


def require_between(found, low, high):
    wrong = {key: round(value, 2) for key, value in found.items() if not low <= value <= high}
    data.require(not wrong, f"not between {low} and {high}: {wrong}")


@page.says("Half-edge, winged-edge, corner table and face-vertex store which elements are adjacent. On these four structures, "
           "the time of an edit depends little on the size of the mesh while the structure fits into the cache: the first "
           "exponents are near 0. The exceptions are `remove_isolated_vertices` and `compact`, which visit the whole mesh.")
def constant():
    require_between(all_exponents(set(EDITS) - set(WHOLE_MESH), LOCAL, False), -0.4, 0.4)
    require_between(all_exponents(WHOLE_MESH, LOCAL, False), 0.6, 1.3)


@page.says("For meshes larger than the cache, most exponents are larger, but stay below 1.")
def beyond():
    found, cached = (all_exponents(set(EDITS) - set(WHOLE_MESH), LOCAL, larger) for larger in (True, False))
    require_between(found, 0, 0.8)
    larger = sum(found[key] > cached[key] for key in found)
    data.require(larger > 0.8 * len(found), f"only {larger} of {len(found)} exponents are larger for large meshes")


@page.says(
    "On the indexed face set and the polygon soup, an edit that must find the faces at a vertex or an edge scans all faces, "
    "with exponents of about 1 on large meshes. On the indexed face set, an edit of a given face does not scan: on the largest mesh, "
    "it takes a small part of the time of an edit that does."
)
def searching():
    require_between(all_exponents(SEARCHING, SCANNING, True), 0.9, 1.3)
    longest, scan = (of(points(what, "indexed-face-set")[-1][1] for what in edits) for of, edits in ((max, OF_A_FACE), (min, SEARCHING)))
    data.require(longest < 0.05 * scan, f"an edit of a given face takes {longest} ns, one that scans {scan} ns")


@page.says("their time per face grows less than the time per edge of `flip_all`.")
def decimation():
    grows = lambda what, backend: points(what, backend)[-1][1] / points(what, backend)[0][1]
    smaller = all(grows(what, b) < grows("flip_all", b) for what in ("decimate_half", "decimate_tenth") for b in LOCAL)
    data.require(smaller, "decimation grows more than flip_all")


TEXTS = [page]
