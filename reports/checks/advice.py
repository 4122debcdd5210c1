"""The advice of README.md: which backend to use for each kind of program, from the workloads on four meshes.

The mean of a kind of program is the geometric mean over its workloads. Its interval comes from the times in each launch, as
in crates/results/src/launches.rs: for a single workload, it is the interval of `sixfold pick`. The errors of several workloads
are independent, because each was measured on its own (degrees of freedom: Welch 1947).
"""

import functools
import math
import statistics
from dataclasses import dataclass

from checks import data, figures
from checks.data import BUILT_IN, LARGE, QUADS, SHUFFLED, STRUCTURES

MESHES = (BUILT_IN, SHUFFLED, LARGE, QUADS)
TRIANGLES = (BUILT_IN, SHUFFLED, LARGE)
TABLES = "relation-tables"
BACKENDS = (*STRUCTURES, TABLES)
# The structures that hold every mesh.
ANY_MESH = ("polygon-soup", "indexed-face-set", "face-vertex")
NEIGHBOURS = (
    "vertex-normals", "smoothing", "region-growing", "geodesic-dijkstra", "sculpting-brush", "feature-detection", "boundary-repair",
)
FACES = ("rendering-upload", "ray-casting-setup", "parameterisation")
EDITS = ("remeshing", "decimation")
# Two backends whose ratio is certainly below this are called equal, as in the command.
EQUAL = 1.05
# Of crates/results/src/launches.rs.
ALIKE, TRIMMED, LASTING_IN_RATIOS = 1.5, 0.2, 1 / 20


@dataclass
class Mean:
    """A geometric mean of ratios. The interval is missing if the mean is a lower bound."""

    value: float
    low: float | None
    high: float | None

    def verdict(self):
        """Returns what the interval says, if it does not say that one of the two is clearly faster."""
        if self.low is None:
            return ""
        if max(self.high, 1 / self.low) <= EQUAL:
            return "equal: "
        return "undecided: " if self.low <= 1 <= self.high else ""

    def text(self):
        if self.low is None:
            return f"≥ {figures.ratio(self.value, math.floor)}×"
        return f"{figures.ratio(self.value)}× ({figures.ratio(self.low, math.floor)}–{figures.ratio(self.high, math.ceil)})"


def squared_error(logs):
    """Returns the squared error of the trimmed mean of logarithms of ratios, one for each launch, and its degrees of freedom."""
    if len(logs) < 2:
        raise data.Missing("a workload was measured in a single launch")
    logs, cut = sorted(logs), int(TRIMMED * len(logs))
    winsorised = [min(max(log, logs[cut]), logs[-1 - cut]) for log in logs]
    kept = len(logs) - 2 * cut
    variance = statistics.variance(winsorised) / (kept / len(logs)) ** 2
    return variance * (ALIKE / len(logs) + LASTING_IN_RATIOS), kept - 1


@functools.cache
def student(freedom):
    """Returns the 97.5 % quantile of Student's distribution."""
    norm = math.exp(math.lgamma((freedom + 1) / 2) - math.lgamma(freedom / 2)) / math.sqrt(freedom * math.pi)
    density = lambda t: norm * (1 + t * t / freedom) ** (-(freedom + 1) / 2)
    below, step = 0.5, 1e-4
    for place in range(int(20 / step)):
        below += step * density((place + 0.5) * step)
        if below >= 0.975:
            return (place + 1) * step
    raise ValueError(f"{freedom} degrees of freedom are too few")


def mean(workloads, backend, other):
    """Returns the geometric mean of the ratio of two backends; None if one was not measured in some workload."""
    if not all(name in w.rows for w in workloads for name in (backend, other)):
        return None
    logs = [math.log(w.ratio(backend, other)) for w in workloads]
    value = math.exp(statistics.fmean(logs))
    if any(w.rows[name]["estimated"] for w in workloads for name in (backend, other)):
        return Mean(value, None, None)
    launches = lambda w: zip(w.rows[backend]["launch_ns"], w.rows[other]["launch_ns"])
    return with_interval(value, [[math.log(a / b) for a, b in launches(w) if a and b] for w in workloads])


def with_interval(value, measurements):
    """Returns a geometric mean with its interval, from the logarithms of the ratios in the launches of each measurement."""
    errors = [squared_error(logs) for logs in measurements]
    squared = sum(error for error, _ in errors)
    if squared == 0:
        return Mean(value, value, value)  # a backend and itself
    freedom = squared**2 / sum(error**2 / freedom for error, freedom in errors)
    half = student(round(freedom, 1)) * math.sqrt(squared) / len(measurements)
    return Mean(value, value * math.exp(-half), value * math.exp(half))


def means(workloads, candidates):
    """Returns the backends with their means relative to the one with the least mean, in this order."""
    bounded = lambda name: any(w.rows[name]["estimated"] for w in workloads)
    measured = [name for name in candidates if not bounded(name)]
    best = min(measured, key=lambda name: mean(workloads, name, measured[0]).value)
    found = {name: mean(workloads, name, best) for name in candidates}
    return dict(sorted(((name, each) for name, each in found.items() if each), key=lambda item: item[1].value))


class Kind:
    """A kind of program: its workloads, the meshes it may have, and the backends that it can use."""

    def __init__(self, title, workloads, meshes=MESHES, candidates=BACKENDS):
        self.title, self.workloads, self.meshes, self.candidates = title, workloads, meshes, candidates

    def on(self, mesh):
        return [data.workload(name, mesh) for name in self.workloads]

    def everywhere(self):
        """Returns the workloads on all meshes."""
        return [workload for mesh in self.meshes for workload in self.on(mesh)]

    def candidates_on(self, mesh):
        return [name for name in self.candidates if all(name in w.rows for w in self.on(mesh))]

    def used(self):
        """Returns the backend with the least mean over the meshes, of those that can be used on each; of those that are not
        clearly slower, the one with the fewest bytes."""
        usable = [name for name in self.candidates if all(name in self.candidates_on(mesh) for mesh in self.meshes)]
        every = self.everywhere()
        fast = [name for name, ratio in means(every, usable).items() if ratio.low is not None and ratio.low <= 1]
        return min(fast, key=lambda name: every[0].rows[name]["bytes_per_vertex"])

    def decided(self):
        """Returns the meshes on which the used backend is clearly faster than the best other one."""
        return [mesh for mesh in self.meshes if self.next_best(mesh)[1].low > 1]

    def next_best(self, mesh):
        """Returns the best other backend on a mesh, and its mean relative to the used one."""
        used = self.used()
        others = [name for name in self.candidates_on(mesh) if name != used]
        best = next(iter(means(self.on(mesh), others)))
        return best, mean(self.on(mesh), best, used)

    def cell(self, mesh):
        """Returns what a mesh says: the best other backend, and its time relative to the used one."""
        if mesh not in self.meshes:
            return "–"
        name, ratio = self.next_best(mesh)
        return f"{ratio.verdict()}{plain(name)} {ratio.text()}"

    def described(self):
        """Returns the workloads and the candidates in words."""
        left_out = [name for name in data.workload_names() if name not in self.workloads]
        listed = lambda names: ", ".join(f"`{name}`" for name in names)
        workloads = listed(self.workloads) if len(self.workloads) <= len(left_out) else f"all but {listed(left_out)}"
        named = {BACKENDS: "all backends", STRUCTURES: "the six structures", ANY_MESH: ", ".join(map(plain, ANY_MESH))}
        return workloads, named[self.candidates]

    def row(self):
        return link(self.used()), *map(self.cell, MESHES)


def plain(backend):
    """Returns the name of a backend in a sentence."""
    return backend if backend.endswith(("-edge", "-vertex")) else backend.replace("-", " ")


def link(backend):
    crate = "relation-table" if backend == TABLES else backend
    return f"[{plain(backend)}](crates/{crate})"


ON_ANY_MESH = (*NEIGHBOURS, "modelling", "subdivision", *FACES, "one-shot-conversion")
ON_TRIANGLES = (*NEIGHBOURS, *EDITS, "subdivision", *FACES, "one-shot-conversion")
QUERIES = Kind("queries", NEIGHBOURS)
TRIANGLE_EDITS = Kind("triangle edits", EDITS, TRIANGLES)
POLYGON_EDITS = Kind("polygon edits", ("modelling",))
CONVERTING = Kind("conversion", ("one-shot-conversion",))
# The rows of the table in README.md.
ROWS = {
    "queries neighbours, and keeps its connectivity (vertices may move)": QUERIES,
    "changes triangles: remeshing, decimation": TRIANGLE_EDITS,
    "changes polygons: modelling": POLYGON_EDITS,
    "refines its mesh by subdivision": Kind("subdivision", ("subdivision",)),
    "reads the corners of faces, again and again": Kind("corners of faces", FACES),
    "reads all faces once, to store or convert them": CONVERTING,
    "is not written yet, and has triangles only": Kind("all, on triangles", ON_TRIANGLES, TRIANGLES, STRUCTURES),
    "is not written yet, and has polygons": Kind("all, on any mesh", ON_ANY_MESH, MESHES, STRUCTURES),
    "holds meshes that are not manifold": Kind("", ON_ANY_MESH, MESHES, ANY_MESH),
}

# The picture: the kinds of its rows, and its measures.
DRAWN = [kind for kind in ROWS.values() if kind.title]
PICTURE = "reports/workloads/advice.svg"
# So narrow that a phone shows it at readable size.
NAMES, COLUMN, HEAD, TITLE, ROW = 122, 48, 48, 22, 21
# From dark to light, for ratios from 1 to 1,000 on a logarithmic scale: points of the colour map viridis of van der Walt and
# Smith (2015).
COLOURS = ((68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37))
NAMES_OF_MESHES = {BUILT_IN: "built-in", SHUFFLED: "random order", LARGE: "ten times as large", QUADS: "quads"}


def colour(share):
    """Returns the colour of a share of the scale, as CSS."""
    place = min(share * (len(COLOURS) - 1), len(COLOURS) - 1.001)
    left, right = COLOURS[int(place)], COLOURS[int(place) + 1]
    return "rgb({},{},{})".format(*(round(a + (b - a) * (place % 1)) for a, b in zip(left, right)))


def picture():
    """Returns a heat map as SVG: the means of each kind of program on each mesh, relative to the least."""
    width, height = NAMES + COLUMN * len(BACKENDS), HEAD + sum(TITLE + ROW * len(kind.meshes) + 6 for kind in DRAWN)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
        "<title>Time of each kind of program on each backend, relative to the fastest of its row</title>",
        "<desc>Dark is fast. Bold: the fastest. Hatched: perhaps the fastest, because its interval contains 1.</desc>",
        *[f'<pattern id="{name}" width="5" height="5" patternUnits="userSpaceOnUse"><path d="M-1 6L6 -1" stroke="{ink}"/></pattern>'
          for name, ink in (("white", "#fff"), ("black", "#000"))],
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
    ]
    text = lambda x, y, content, more: parts.append(f'<text x="{x}" y="{y}" {more}>{content}</text>')
    for column, backend in enumerate(BACKENDS):
        words = plain(backend).replace("-", "- ").split(" ")
        for line, word in enumerate(reversed(words)):
            text(NAMES + COLUMN * (column + 0.5), HEAD - 8 - 13 * line, word, 'text-anchor="middle" font-size="11"')
    y = HEAD
    for kind in DRAWN:
        text(4, y + 16, kind.title, 'font-weight="bold"')
        y += TITLE
        for mesh in kind.meshes:
            found = means(kind.on(mesh), kind.candidates_on(mesh))
            text(NAMES - 8, y + 15, NAMES_OF_MESHES[mesh], 'text-anchor="end"')
            for column, backend in enumerate(BACKENDS):
                x, ratio = NAMES + COLUMN * column, found.get(backend)
                share = min(math.log10(max(ratio.value, 1)) / 3, 1) if ratio else 0
                fill = f'fill="{colour(share)}"' if ratio else 'fill="none" stroke="#ccc"'
                parts.append(f'<rect x="{x + 1}" y="{y + 1}" width="{COLUMN - 2}" height="{ROW - 2}" {fill}/>')
                ink = "#fff" if ratio and share < 0.45 else "#000" if ratio else "#888"
                if ratio and ratio.value > 1 and ratio.low is not None and ratio.low <= 1:
                    name = "white" if ink == "#fff" else "black"
                    for left in (x + 1, x + COLUMN - 8):
                        parts.append(f'<rect x="{left}" y="{y + 1}" width="7" height="{ROW - 2}" fill="url(#{name})"/>')
                bound = "≥" if ratio and ratio.low is None else ""
                shown = f"{bound}{figures.ratio(ratio.value)}" if ratio else "–"
                weight = ' font-weight="bold"' if ratio and ratio.value == 1 else ""
                text(x + COLUMN / 2, y + 15, shown, f'text-anchor="middle" fill="{ink}"{weight}')
            y += ROW
        y += 6
    return "\n".join([*parts, "</svg>"]) + "\n"
