"""The claims of the chapters of the guide, which are checked in the sources of the chapters.

A chapter about a structure has many numbers that the program works out: rows, fields, reads. Only the section that says
when to choose the structure has measured figures.
"""

from checks import conclusions, data, figures, repeatability
from checks.claims import Claims
from checks.conclusions import STUDY
from checks.data import BUILT_IN

SOURCES = "crates/sixfold-cli/src/teaching/guide"
WHEN = "## When to choose it"


def chapter(name, definitions=""):
    return Claims(f"{SOURCES}/{name}.md", definitions, measured=WHEN)


def study():
    return data.study(STUDY)


def bytes_of(name):
    return study().bytes_per_vertex(name)


def ratio(operation, backend, other):
    return figures.ratio(study().ratios(backend, other, [operation])[0])


def to_best(operation, backend):
    return figures.ratio(study().to_best(operation, backend))


soup = chapter("polygon-soup", "If two faces compute")


@soup.says("For `vertex_faces` on the built-in mesh, it takes {} times the time of the fastest structure")
def soup_searches():
    return to_best("vertex_faces", "polygon-soup")


@soup.says("It needs {} bytes per vertex of a large triangle mesh, and the [indexed face set](indexed-face-set.md) needs {}.")
def soup_bytes():
    return bytes_of("polygon-soup"), bytes_of("indexed-face-set")


faces = chapter("indexed-face-set")


@faces.says("It needs {} bytes per vertex. To convert the built-in mesh once, every other backend takes at least {} times its time")
def faces_conversion():
    found = data.workload("one-shot-conversion", BUILT_IN)
    ratios = [found.ratio(name, "indexed-face-set") for name in found.rows if name != "indexed-face-set"]
    return bytes_of("indexed-face-set"), figures.at_least(ratios)


@faces.says("For `vertex_faces` on the built-in mesh, it takes {} times the time of the fastest structure")
def faces_search():
    return to_best("vertex_faces", "indexed-face-set")


fans = chapter("face-vertex", "It is the only one of the six")


@fans.says("For `vertex_faces` on the built-in mesh, half-edge takes {} times its time")
def fans_gather():
    return ratio("vertex_faces", "half-edge", "face-vertex")


@fans.says("For `edge_faces`, it takes {} times the time of half-edge, and for `face_faces` {} times.")
def fans_search():
    return tuple(ratio(operation, "face-vertex", "half-edge") for operation in ("edge_faces", "face_faces"))


wings = chapter("winged-edge", """
    must be one object with one number
    between the two wings
""")


@wings.says(
    "winged-edge takes {} to {} times the time of half-edge for the nine relations on the built-in mesh ([the "
    "study](../built-in-mesh/report.md)), and {} bytes per vertex, where half-edge takes {}."
)
def wings_ratios():
    ratios = study().ratios("winged-edge", "half-edge", data.RELATIONS.values())
    return *figures.span(ratios), bytes_of("winged-edge"), bytes_of("half-edge")


halves = chapter("half-edge", "measurements of workloads on four meshes")


@halves.says("In {} of {} measurements of workloads on four meshes, it takes at most twice the time of the fastest backend")
def halves_workloads():
    return conclusions.at_most_twice()[:2]


@halves.says("it needs {} bytes per vertex, and the [corner table](corner-table.md) {}.")
def halves_bytes():
    return bytes_of("half-edge"), bytes_of("corner-table")


corners = chapter("corner-table", "and `decimation` on three meshes")


@corners.says("In the workloads `remeshing` and `decimation` on three meshes, half-edge takes {} to {} times its time, "
              "which is clearly more on {} of them")
def corners_edits():
    return conclusions.corner_table()[2:5]


@corners.says("On the built-in mesh, half-edge takes {} times its time for `face_faces`")
def corners_faces():
    return ratio("face_faces", "half-edge", "corner-table")


@corners.says("**If memory counts**: {} bytes per vertex. Only the [indexed face set](indexed-face-set.md), which has no")
def corners_bytes():
    smaller = [name for name in data.STRUCTURES if float(bytes_of(name)) < float(bytes_of("corner-table"))]
    data.require(smaller == ["indexed-face-set"], f"{smaller} need less memory")
    return bytes_of("corner-table")


@corners.says("for `vertex_vertices`, it takes {} times the time of half-edge, and for `edge_vertices` {} times.")
def corners_vertices():
    return tuple(ratio(operation, "corner-table", "half-edge") for operation in ("vertex_vertices", "edge_vertices"))


reading = Claims(
    f"{SOURCES}/study.md",
    definitions="""
        what makes two times comparable
        between two structures
        not from two programmers
        One of them is measured twice
        the time of *one* query
        one query after another
        The two times of one structure
        is one such time divided by another
        A 95 % interval
        19 of 20 intervals
        a ratio that contains 1 means
        which of the two is faster
        for milliseconds
        its whole interval is above 1.
        If two ! structures are close
        disturbed 48 % of the samples
        disturbance of minutes
        × the fastest 95 % per new face
        --budget 6s
        one row for each operation, one column
        ## Three mistakes
        two columns of different runs
    """,
)

# The operation of the example, and its structures without a lower bound, the fastest first.
EXAMPLE = "catmull_clark_gather"
FIRST, SECOND, THIRD = "face-vertex", "half-edge", "winged-edge"


def example(backend):
    """Returns a row of the report for the example, after the name of the backend."""
    ns = lambda name: study().rows[EXAMPLE, name]["ns_per_element"]
    row = study().rows[EXAMPLE, backend]
    shown = figures.three_digits(figures.shown(ns(backend)) / figures.shown(ns(FIRST)))
    low, high = (figures.three_digits(row[f"ratio_ci_{end}"]) for end in ("low", "high"))
    interval = "–" if backend == FIRST else f"{low} to {high}"
    remark = {"undecided": " undecided", "slower": ""}[row["standing"]]
    return f"{shown} {interval} {figures.time(ns(backend))}{remark}"


@reading.says("per new face " + " ".join(f"{name} {{}}" for name in (FIRST, SECOND, THIRD)) + " ```")
def example_rows():
    rows = [row for (operation, _), row in study().rows.items() if operation == EXAMPLE and row["ns_per_element"]]
    data.require(len(rows) == 3, "other structures are measured")
    return tuple(map(example, (FIRST, SECOND, THIRD)))


@reading.says("for the operation `catmull_clark_gather`: one step of Catmull–Clark subdivision to {} faces")
def new_faces():
    return figures.count(study().rows[EXAMPLE, FIRST]["elements"])


def percent(share):
    return f"{100 * share:.0f} %"


@reading.says(
    "The time of face-vertex is less by {} ns, but the interval of half-edge goes from {} to {}: it may take ! {} less time, or "
    "{} more."
)
def tie():
    first, second = (study().rows[EXAMPLE, name] for name in (FIRST, SECOND))
    less = figures.shown(second["ns_per_element"]) - figures.shown(first["ns_per_element"])
    low, high = second["ratio_ci_low"], second["ratio_ci_high"]
    ends = figures.three_digits(low), figures.three_digits(high)
    return f"{less:.1f}", *ends, percent(1 - low), percent(high - 1)


@reading.says("By how much is less certain: between {} and {} times the time of face-vertex.")
def slower():
    row = study().rows[EXAMPLE, THIRD]
    return figures.three_digits(row["ratio_ci_low"]), figures.three_digits(row["ratio_ci_high"])


@reading.says("Why do {} relations have times only for a sample of the elements")
def sampled():
    both = lambda relation: all(study().rows[relation, name]["sampled"] for name in data.SCANNING)
    return figures.word(sum(map(both, data.RELATIONS.values())))


@reading.says("of the intervals of ratios in twenty studies on a busy machine, {} contained the median of the other studies")
def covered():
    return repeatability.coverage("ratios")


TEXTS = [soup, faces, fans, wings, halves, corners, reading]
