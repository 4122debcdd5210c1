"""The claims of README.md and docs/measuring.md."""

from checks import advice, beside, data, figures, repeatability, workload_table
from checks.claims import Claims
from checks.data import BUILT_IN, QUADS, SHUFFLED

SMOOTHING = ("smoothing", BUILT_IN)

page = Claims(
    "README.md",
    definitions="""
        library of six mesh data structures
        behind one query trait
        on four meshes
        Three of them differ
        in one thing
        ten times as large
        with its 95 % interval
        lies within 5 % of 1
        Below 1, the other backend
        it contains 1 and is wider
        completes the six
        Rust 1.88 or newer
        has the six structures
        eight example programs
        seven [subdivision]
        the sixteen [edits]
        a ratio is the quotient of two times
        intervals are 95 %
        with 95 % intervals
        32-bit floats
        with 32 bits
        Apache License 2.0
        nine relations
        1st build
    """,
)


@page.says("The advice follows from [{} workloads](reports/README.md#the-fifteen-workloads) on four meshes")
def workload_count():
    return figures.word(len(data.workload_names()))


@page.says(
    "the built-in mesh of {} triangles, in one thing: the order of the elements, the size, or the faces ({} quads, with as many "
    "edges)"
)
def meshes():
    found = {mesh["name"]: mesh for mesh in workload_table.meshes()}
    data.require(found[QUADS]["edges"] == found[BUILT_IN]["edges"], "the quads have another number of edges")
    return figures.count(found[BUILT_IN]["faces"]), figures.count(found[QUADS]["faces"])


@page.says("(per vertex, the corner table needs {} and half-edge {})")
def sizes():
    rows = data.workload(*SMOOTHING).rows
    return tuple(f"{rows[name]['bytes_per_vertex']:.0f}" for name in ("corner-table", "half-edge"))


for program, kind in advice.ROWS.items():
    page.row(f"| {program} | {{}} | {{}} | {{}} | {{}} | {{}} |", kind.row)


@page.says(
    "in these workloads, half-edge takes up to {}× its time in the original order, and clearly longer in {} of {}; polygon soup takes "
    "clearly longer in {} of {}."
)
def random_order():
    rows = {name: slower_in_random_order(name) for name in ("half-edge", "polygon-soup")}
    worst = max(ratio for ratio, _ in rows["half-edge"])
    counts = [(figures.count(sum(clear for _, clear in found)), figures.count(len(found))) for found in rows.values()]
    return figures.ratio(worst), *counts[0], *counts[1]


def slower_in_random_order(backend):
    """Returns the ratio of the times in random and in the original order for each workload, and whether it is clearly above 1."""
    pairs = [[data.workload(name, mesh).rows[backend] for mesh in (SHUFFLED, BUILT_IN)] for name in data.workload_names()]
    clear = lambda a, b: a["ns_ci_low"] is not None and b["ns_ci_high"] is not None and a["ns_ci_low"] > b["ns_ci_high"]
    return [(a["ns_per_operation"] / b["ns_per_operation"], clear(a, b)) for a, b in pairs]


@page.says("With `--budget {}`, on {} cores of an {} (commit {}), it measured [these times](reports/workloads/built-in-smoothing.json), shortened:")
def machine():
    found = data.workload(*SMOOTHING).found
    read = next(read for read in data.workload_documents() if any(each is found for each in read["findings"]))
    environment = read["runs"][found["run"]]["environment"]
    budget = f"{read['runs'][found['run']]['settings']['budget_s']:.0f}s"
    return budget, figures.word(environment["cores"]), environment["cpu_model"], environment["commit"][:7]


def printed_row(backend):
    """Returns the row that the command prints for a backend, after its name. The ratio is the quotient of the shown times."""
    workload = data.workload(*SMOOTHING)
    row = workload.rows[backend]
    ratio = shown_ratio(workload, backend)
    data.require(row["ci_low"] <= ratio <= row["ci_high"], f"the quotient {ratio} is outside of the interval")
    time = ("~" if row["sampled"] else "") + figures.time(row["ns_per_operation"])
    relative = ("*" if backend == workload.fastest else "") + figures.three_digits(ratio)
    interval = f"{figures.three_digits(row['ci_low'])}–{figures.three_digits(row['ci_high'])}"
    builds = figures.time(row["first_build_ns"]), figures.time(row["build_ns"])
    size = f"{row['bytes_per_vertex']:.1f}"
    cells = time, relative, interval, *builds, size
    widths = 0, 6, 12, 10, 8, 9
    return " ".join(cell.rjust(width) for cell, width in zip(cells, widths))


def shown_ratio(workload, backend):
    return figures.shown(workload.ns(backend)) / figures.shown(workload.ns(workload.fastest))


PRINTED = ("relation-tables", "half-edge", "corner-table", "winged-edge", "face-vertex", "indexed-face-set", "polygon-soup")


@page.says(" ".join(f"{name} {{}}" for name in PRINTED) + " ```")
def printed_rows():
    return tuple(map(printed_row, PRINTED))


@page.says("- For smoothing, {} is clearly fastest: {} per operation; {} takes {} × that time (95 %: {} to {}).")
def sentence():
    workload = data.workload(*SMOOTHING)
    first, second = sorted(workload.rows, key=workload.ns)[:2]
    made_from, row = workload.rows[first]["made_from"], workload.rows[second]
    best = f"{first} (made from {made_from})" if made_from else first
    interval = figures.three_digits(row["ci_low"]), figures.three_digits(row["ci_high"])
    return best, figures.time(workload.ns(first)), second, figures.three_digits(shown_ratio(workload, second)), *interval


@page.says(
    "In twenty studies of a minute on a busy shared machine, {} of the intervals of ratios and {} of those of times contained "
    "the median of the other studies"
)
def repeated():
    data.require(repeatability.runs() == ("20", "60"), "other studies were repeated")
    return repeatability.coverage("ratios"), repeatability.coverage("times")


@page.says("in twenty studies of two operations, during which the machine became faster, {} and {} (")
def repeated_named():
    return tuple(repeatability.coverage(kind, repeatability.NAMED) for kind in ("ratios", "times"))


@page.says(
    "On two cores of an {} (commit {}), the times of other libraries relative to Sixfold's half-edge, which needs {} "
    "bytes per vertex"
)
def beside_half_edge():
    found = data.environment(beside.DATA)
    return found["cpu_model"], found["commit"][:7], data.study(beside.DATA).bytes_per_vertex(beside.REFERENCE)


for name in ("OpenSubdiv", "parry3d", "CGAL", "lox", "OpenMesh", "alum", "tri-mesh"):
    page.row(f"| {name} {{}} | {{}} | {{}} | {{}} | {{}} |", beside.row, name.lower())


measuring = Claims(
    "docs/measuring.md",
    definitions="""
        is one of the six structures
        one backend, the *control*, has two
        the two times of the control
        median of its samples
        (20 s) and the work
        by at most 2 %
        is at most 5 %
        These three numbers
        1.3 times as long as at best
        at most three times
        median polish (Tukey 1977)
        the ratio of two structures is the quotient of their times
        from only one of several launches
        fewer than four samples of a single launch
        a budget
        a second, that of a whole study takes 4 s
        below 6 s has a single one
        its 95 % interval
        Jones 2013, 2020
        within 5 % of 1
        the interval contains 1 and
        (Tukey and McLaughlin 1963)
        is taken as 1.5 times that of independent launches
        include 1/8 of the variance from launch to launch, and those of ratios 1/20
        at most
        one of 200 comparisons
        than six times
        1.3 × as long or more
        a factor of 1.3
        | 1 | a negative
        | 0 | success
        | 2 | wrong
        | 3 | none
        change by 10 % could
        | 4 | interrupted
        changed by 10 % unnoticed
        `--fail-if-slower` is 3
        within 5 % of 1, and the noise
        rounded to 32 bits
        one JSON object per line
        refuses to compare two studies
        and one more
        exit code 1.
        and the exit code is 1; with `--keep-going` it is 0
        exactly 20 rounds
        `--confidence 99%`
        by default 95%
        how far two surfaces
        1 edge with three or more faces: v0–v1 (line 7)
    """,
)

TEXTS = [page, measuring]
