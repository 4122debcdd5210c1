"""The claims of reports/subdivision/README.md, whose tables are computed from subdivision.json."""

import statistics

from checks import data, figures
from checks.claims import Claims
from checks.data import LOCAL, WALKING

DATA = "reports/subdivision/subdivision.json"
SCHEMES = ("catmull-clark", "loop")
WAYS = ("gather", "scatter", "native_fresh", "native")
LEVELS = (1, 2, 3, 4)

page = Claims(
    "reports/subdivision/README.md",
    definitions="""
        | level 1 | level 2 | level 3 | level 4 |
        makes one pass
        more than 0.4 s
        one thread
    """,
)


def times(scheme, way, backend):
    """Returns the time per face at each level."""
    rows = [r for r in data.document(DATA)["results"] if (r["scheme"], r["way"], r["backend"]) == (scheme, way, backend)]
    return {row["level"]: statistics.median(row["cpu_ns"]) / row["faces"] for row in rows}


def row(scheme, way, backend):
    found = times(scheme, way, backend)
    data.require(found, f"{DATA} has no such row")
    shown = lambda ns: "–" if ns is None else f"{ns:.0f}" if ns >= 1000 else f"{ns:.1f}"
    return tuple(shown(found.get(level)) for level in LEVELS)


def table(scheme, without):
    for way in WAYS:
        for backend in ("polygon-soup", "indexed-face-set", *LOCAL):
            if backend not in without and not (way.startswith("native") and backend not in LOCAL):
                sentence = f"| {way} | {backend} | {{}} | {{}} | {{}} | {{}} |"
                page.row(sentence, row, scheme, way, backend, section=f"## {scheme} ")


table("catmull-clark", without=["corner-table"])
table("loop", without=[])


@page.says(data.INTRODUCTION)
def introduction():
    return data.introduction(DATA)


@page.says("The control mesh is a geodesic sphere of {} triangles.")
def control_mesh():
    # A step of Loop makes four faces of each face.
    first = [row["faces"] for row in data.document(DATA)["results"] if (row["scheme"], row["level"]) == ("loop", 1)]
    return figures.count(first[0] // 4)


# The conclusions have no values, because the program that makes the report also writes them for other machines.


@page.says(
    "A polygon soup and an indexed face set must search all faces for the answers, so their time per new face grows with "
    "the size of the mesh."
)
def searches():
    grows = lambda found: all(found[level + 1] > 2 * found[level] for level in found if level + 1 in found)
    each = [times(scheme, "gather", backend) for scheme in SCHEMES for backend in ("polygon-soup", "indexed-face-set")]
    data.require(all(map(grows, each)), "the time per face at a level is less than twice that of the previous level")


@page.says("The indexed face set is the fastest structure with `scatter`.")
def scatter():
    for scheme in SCHEMES:
        found = {backend: times(scheme, "scatter", backend) for backend in ("polygon-soup", "indexed-face-set", *LOCAL)}
        found = {backend: each for backend, each in found.items() if each}
        for level in LEVELS:
            fastest = min(found, key=lambda backend: found[backend][level])
            data.require(fastest == "indexed-face-set", f"{fastest} is faster for {scheme} at level {level}")


@page.says("For half-edge, winged-edge and corner table, both are faster than `gather` and `scatter` at every level.")
def native():
    for scheme in SCHEMES:
        for backend in WALKING:
            found = {way: times(scheme, way, backend) for way in WAYS}
            for level in LEVELS if found["native"] else []:
                own = max(found[way][level] for way in ("native", "native_fresh"))
                others = min(found[way][level] for way in ("gather", "scatter"))
                data.require(own < others, f"another method is faster for {scheme} on {backend} at level {level}")


TEXTS = [page]
