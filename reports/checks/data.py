"""The committed measurements. Ratios are quotients of two times of the same document (see SCHEMA.md)."""

import functools
import json
import math
import pathlib
import re
import statistics

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCANNING = ("polygon-soup", "indexed-face-set")
WALKING = ("winged-edge", "half-edge", "corner-table")
LOCAL = ("face-vertex", *WALKING)
STRUCTURES = (*SCANNING, *LOCAL)
RELATIONS = {
    f"{a[0]}{b[0]}".upper(): f"{a}_{plural}"
    for a in ("vertex", "edge", "face")
    for b, plural in (("vertex", "vertices"), ("edge", "edges"), ("face", "faces"))
}
# The fewest samples from which a winner is named.
ENOUGH = 4
# The meshes of the workloads. Each differs from the first in one thing: the order, the size, or the faces.
BUILT_IN, SHUFFLED, LARGE, QUADS = "built-in.obj", "shuffled.obj", "large.obj", "quads.obj"


class Missing(Exception):
    """A file or a value that a claim needs is missing."""


class Contradicted(Exception):
    """The data say the opposite of a sentence."""


def require(true, otherwise):
    """Raises `Contradicted` with the reason, unless the condition is true."""
    if not true:
        raise Contradicted(otherwise)


def use(root):
    """Reads the data of another checkout from now on."""
    global ROOT
    ROOT = pathlib.Path(root)
    for cached in (content, document, study, workloads):
        cached.cache_clear()


@functools.cache
def content(path):
    try:
        return (ROOT / path).read_text(encoding="utf-8")
    except OSError as error:
        raise Missing(f"cannot read {path}: {error.strerror}") from error


@functools.cache
def document(path):
    try:
        return json.loads(content(path))
    except ValueError as error:
        raise Missing(f"{path} is not JSON: {error}") from error


def finding(path, kind):
    return next(f for f in document(path)["findings"] if f["kind"] == kind)


def environment(path):
    return document(path)["runs"][0]["environment"]


# The line about the machine and the launches in a report that an example of sixfold-report writes.
INTRODUCTION = (
    "``` {}; {} cores; {} {}; {}, {} {}; Sixfold {} ({}); processor time of the thread; freed pages kept ({}); one thread. The "
    "times are medians of {} launches. A launch is a process of its own{}. From launch to launch, a time varies by {} (the standard deviation divided by the mean; median "
    "over all times)."
)


def introduction(path):
    """Returns the values of `INTRODUCTION`."""
    read = document(path)
    e = read["environment"]
    spreads = [statistics.stdev(row["cpu_ns"]) / statistics.fmean(row["cpu_ns"]) for row in read["results"] if len(row["cpu_ns"]) > 1]
    compiler = e["rustc"].split(" (")[0], e["profile"], e["rustflags"]
    program = e["sixfold"], e["commit"], e["heap"]["allocator"]
    once = " that runs every line of the tables once"
    rounds = f"; its time is the median of {read['rounds']} rounds, each of which runs every line of the tables once"
    launches = str(read["launches"]), once if read["rounds"] == 1 else rounds, f"{100 * statistics.median(spreads):.1f} %"
    return e["cpu_model"], str(e["cores"]), e["os"], e["kernel"], *compiler, *program, *launches


def commit(path):
    return environment(path)["commit"][:7]


def quoted(path, pattern):
    """Returns the groups of a pattern in printed output."""
    found = re.search(pattern, " ".join(content(path).split()))
    if not found:
        raise Missing(f"{path} has no text that matches {pattern}")
    return found.groups()


def geometric_mean(values):
    values = list(values)
    return math.exp(sum(map(math.log, values)) / len(values))


class Study:
    """The times of a finding by operation and backend."""

    def __init__(self, found):
        self.backends = {backend["name"]: backend for backend in found["backends"]}
        self.rows = {(row["operation"], row["backend"]): row for row in found["results"]}
        self.operations = list(dict.fromkeys(operation for operation, _ in self.rows))

    def ns(self, operation, backend):
        """Returns the time of one run; None if there is none."""
        row = self.rows.get((operation, backend), {"median_ns": None, "estimated_ns": None})
        return row["median_ns"] or row["estimated_ns"]

    def ratios(self, backend, other, operations):
        return [self.ns(operation, backend) / self.ns(operation, other) for operation in operations]

    def to_best(self, operation, backend):
        times = [self.ns(operation, name) for name in self.backends]
        return self.ns(operation, backend) / min(ns for ns in times if ns)

    def leaders(self, operation):
        """Returns the backends that are best or share the first place, from enough samples."""
        led = lambda row: row and row["standing"] in ("best", "equal", "undecided", "tied") and row["samples"] >= ENOUGH
        return [name for name in self.backends if led(self.rows.get((operation, name)))]

    def won(self, backend):
        """Returns the operations in which the backend is the single fastest."""
        return [operation for operation in self.operations if self.leaders(operation) == [backend]]

    def bytes_per_vertex(self, backend):
        return f"{self.backends[backend]['bytes_per_vertex']:.0f}"


@functools.cache
def study(path):
    return Study(finding(path, "study"))


def sizes(order):
    """Returns the sizes of a growth document."""
    path = {"given": "reports/growth/growth.json", "shuffled": "reports/growth/growth-shuffled.json"}[order]
    return finding(path, "growth")["sizes"]


def per_element(order, operation, backends):
    """Returns the times per element at each size, one list for each backend."""
    every = lambda backend: [
        row["median_ns"] / row["elements"]
        for size in sizes(order)
        for row in size["results"]
        if (row["operation"], row["backend"]) == (operation, backend) and row["median_ns"]
    ]
    return [every(backend) for backend in backends]


class Workload:
    """The answer of `pick` for one workload and one mesh."""

    def __init__(self, found):
        self.found = found
        self.rows = {row["backend"]: row for row in found["ranking"]}
        self.fastest = min(self.rows, key=self.ns)

    def ns(self, backend):
        return self.rows[backend]["ns_per_operation"]

    def ratio(self, backend, other=None):
        return self.ns(backend) / self.ns(other or self.fastest)

    def enough(self, backend):
        return self.rows[backend]["samples"] >= ENOUGH

    def leaders(self):
        """Returns the backends that are fastest or share the first place. Empty if there are too few samples for a winner."""
        if not self.enough(self.fastest):
            return []
        return [name for name, row in self.rows.items() if row["tied_with_best"] and self.enough(name)]

    def fastest_structure(self):
        return min((name for name in self.rows if name in STRUCTURES), key=self.ns)

    def once_ns(self, backend):
        """Returns the time of one use: building the backend from an indexed face set, and all operations."""
        row = self.rows[backend]
        build_ns = 0 if backend == "indexed-face-set" else row["first_build_ns"] or row["build_ns"]
        return build_ns + self.found["operations"] * self.ns(backend)

    def cheapest(self):
        return min(self.rows, key=self.once_ns)


def workload_documents():
    """Returns all documents in `reports/workloads`."""
    paths = sorted((ROOT / "reports/workloads").glob("*.json"))
    return [document(path.relative_to(ROOT).as_posix()) for path in paths]


def workload_environments():
    return [run["environment"] for read in workload_documents() for run in read["runs"]]


@functools.cache
def workloads():
    """Returns the measured workloads by name and mesh."""
    found = {}
    for read in workload_documents():
        for each in read["findings"]:
            found[each["workload"]["name"], read["meshes"][each["meshes"][0]]["name"]] = Workload(each)
    return found


def workload(name, mesh):
    if (name, mesh) not in workloads():
        raise Missing(f"reports/workloads has no measurement of {name} on {mesh}")
    return workloads()[name, mesh]


def workload_names():
    return list(dict.fromkeys(name for name, _ in workloads()))
