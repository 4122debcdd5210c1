"""The other libraries relative to half-edge, from reports/beside: a table of README.md, and sentences of reports/README.md.

The mean over the nine relations is geometric. All relations were measured in the same launches, so a launch gives one mean, and
the interval comes from the means of the launches.
"""

import math
import statistics

from checks import advice, data, figures
from checks.data import RELATIONS, STRUCTURES

DATA = "reports/beside/results.json"
REFERENCE = "half-edge"


def libraries():
    return [name for name in data.study(DATA).backends if name not in STRUCTURES]


def described(library):
    """Returns the name of a library, the rest of its version, and the compiler with its flags (without those of all Rust code)."""
    version, compiler = data.study(DATA).backends[library]["external"]["library"].rstrip(")").split(" (")
    name, version = version.split("<")[0].split(" ", 1)
    return name, version, compiler.split(", -C")[0].replace("GNU", "g++")


def title(library):
    return described(library)[0]


def mean(library, operations):
    """Returns the geometric mean of the times of some operations, relative to half-edge."""
    study = data.study(DATA)
    pairs = [zip(*(study.rows[operation, name]["launch_ns"] for name in (library, REFERENCE))) for operation in operations]
    launches = [[math.log(a / b) for a, b in launch] for launch in zip(*pairs) if all(a and b for a, b in launch)]
    value = data.geometric_mean(study.ratios(library, REFERENCE, operations))
    return advice.with_interval(value, [[statistics.fmean(logs) for logs in launches]])


def on_relations(library):
    return mean(library, RELATIONS.values())


def faster():
    """Returns the libraries that are clearly faster than half-edge on average, and those that are equal."""
    means = {name: on_relations(name) for name in libraries()}
    equal = [name for name, mean in means.items() if mean.verdict() == "equal: "]
    return [name for name, mean in means.items() if mean.high < 1 and name not in equal], equal


def row(library):
    size = data.study(DATA).bytes_per_vertex(library)
    relations = on_relations(library)
    _, version, compiler = described(library)
    return version, compiler, size, relations.verdict() + relations.text(), mean(library, ["build"]).text()
