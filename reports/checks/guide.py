"""The claims of reports/guide/your-own-program.md, from the printed answer on the same page."""

import re

from checks import data, figures
from checks.claims import Claims

PATH = "reports/guide/your-own-program.md"

page = Claims(
    PATH,
    definitions="""
        guess these three points
        exit code 1.
        Dijkstra's algorithm (1959)
        takes two numbers
        is 0, Sixfold refuses
        more than a tenth of the budget
        two cores of an Intel Xeon
        the six access orders
        measured times of eight programs
        prints two lines
    """,
    printed=True,
)


def answer():
    """Returns the cells of each backend in the printed table: times in milliseconds, and the interval of the ratio."""
    ms = lambda text: float(text.split()[0]) * {"ms": 1, "µs": 1e-3}[text.split()[1]]
    cell = r"([\d.]+ (?:ms|µs))"
    pattern = rf"^([a-z-]+) +{cell} +\*?[\d.]+ +([\d.]+)–([\d.]+) +{cell} "
    rows = re.findall(pattern, data.content(PATH), re.MULTILINE)
    return {name: (ms(run), float(low), float(high), ms(build)) for name, run, low, high, build in rows}


def counted(pattern):
    return [int(number.replace(",", "")) for number in data.quoted(PATH, pattern)]


@page.says("The mesh is a scan with {} triangles (the Stanford bunny).")
def triangles():
    return figures.rounded(counted(r"vertices, ([\d,]+) faces")[0], 1)


@page.says(
    "The interval of half-edge ends before the interval of corner table begins: half-edge is faster. The interval of "
    "winged-edge overlaps both, so the measurement does not show where winged-edge belongs between them. All three are "
    "faster than face-vertex."
)
def intervals():
    low, high = ({name: row[side] for name, row in answer().items()} for side in (1, 2))
    data.require(high["half-edge"] <= low["corner-table"], "the intervals of half-edge and corner table overlap")
    for near in ("half-edge", "corner-table"):
        overlaps = low["winged-edge"] <= high[near] and low[near] <= high["winged-edge"]
        data.require(overlaps, f"the intervals of winged-edge and {near} do not overlap")
    slowest = max(high[name] for name in ("half-edge", "winged-edge", "corner-table"))
    data.require(slowest <= low["face-vertex"], "the interval of face-vertex overlaps another")


@page.says(
    "The relation tables take the least time for a run, but relation tables are made from another structure. For a single "
    "run, building this structure and the tables takes more time than the tables save."
)
def single_run():
    fastest = min(answer(), key=lambda name: answer()[name][0])
    data.require(fastest == "relation-tables", f"{fastest} takes the least time")
    once = {name: row[0] + row[3] for name, row in answer().items()}
    data.require(once["half-edge"] < once["relation-tables"], f"run and build take {once} ms")


@page.says("Here, the program queries the neighbours of each vertex once, and reads {} positions for each neighbour.")
def calls():
    positions, queries = counted(r"One run asks for ([\d,]+) position and ([\d,]+) vertex_vertices")
    vertices, faces = counted(r"([\d,]+) vertices, ([\d,]+) faces")
    data.require(queries == vertices, f"{queries} queries on {vertices} vertices")
    # A closed mesh of triangles has three edges for two faces, and each edge makes two neighbours.
    return figures.word(round(positions / (3 * faces)))


TEXTS = [page]
