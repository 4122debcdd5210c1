"""The claims of reports/README.md."""

import math
import statistics

from checks import advice, beside, data, figures, neighbours, repeatability, workload_table
from checks.claims import Claims
from checks.data import BUILT_IN, ENOUGH, LARGE, LOCAL, QUADS, RELATIONS, SCANNING, STRUCTURES, WALKING

STUDY = "reports/built-in-mesh/results.json"
ORDERS = "reports/orders/orders.json"
GROWTH = {order: f"reports/growth/{name}.json" for order, name in (("given", "growth"), ("shuffled", "growth-shuffled"))}
# Operations whose rows of the elements do not hold the answer.
AROUND_VERTICES = ("vertex_vertices", "vertex_faces", "vertex_normal")

page = Claims(
    "reports/README.md",
    definitions="""
        two letters (V vertex, E edge, F face)
        quotient of two times of the same
        95 % intervals
        the nine relations
        one of the six structures
        has the three fastest backends
        times of two structures are close
        two operations, during which
        two schemes by three methods
        five spatial indices
        eight programs
        the best of four orders
        a million triangles in four orders
        from a thousand to four million triangles
        from a thousand to a million faces
        fifteen workloads on four meshes
        The two rows of programs
        so one of them can have
        ten times as large
        differs from it in one thing
        measures one structure twice
        share the first place
        shares the first place
        width="260"
    """,
)


def study():
    return data.study(STUDY)


def relations(letters):
    return [RELATIONS[pair] for pair in letters.split()]


# The introduction.


@page.says("an irregular mesh of {} triangles that is part of Sixfold")
def triangles():
    return figures.count(data.document(STUDY)["meshes"][0]["faces"])


@page.says("on {} cores of an {} with {} MiB of last-level cache, the study of the built-in mesh with {} MiB")
def machines():
    others = [*map(data.environment, (ORDERS, beside.DATA, *GROWTH.values())), *data.workload_environments()]
    own = data.environment(STUDY)
    last = lambda environment: max(environment["caches"], key=lambda cache: cache["level"])["bytes"] / 2**20
    same = lambda e: (e["cpu_model"], e["cores"], last(e)) == (own["cpu_model"], own["cores"], last(others[0]))
    data.require(all(map(same, others)), "other machines")
    return figures.word(own["cores"]), own["cpu_model"], f"{last(others[0]):.0f}", f"{last(own):.0f}"


@page.says("the difference is the noise: at most {} in the report on orders, {} in the median row of a size in the report on growth, "
           "and {} in a workload")
def noise():
    growth = [size["control"]["typical"] for order in GROWTH for size in data.sizes(order)]
    picked = [workload.found["noise"] for workload in data.workloads().values()]
    orders = data.finding(ORDERS, "orders")["control"]["worst"]
    return figures.percent_at_most([orders]), figures.percent_at_most(growth), figures.percent_at_most(picked)


@page.says("A row with fewer than {} samples of its fastest backend has no winner.")
def enough():
    return figures.word(ENOUGH)


# The conclusions.


def scanned():
    """Returns the relations for which both structures scan."""
    both = lambda relation: all(study().rows[relation, name]["sampled"] for name in SCANNING)
    return [relation for relation in RELATIONS.values() if both(relation)]


@page.says("**For queries, do not choose a structure that scans.** Polygon soup and indexed face set scan all faces")
def scanning():
    data.require(scanned(), "they scan for no relation")


@page.says("On the built-in mesh, they take {} to {} times the time of the fastest structure for {} of the nine relations")
def scans():
    ratios = [study().to_best(relation, name) for relation in scanned() for name in SCANNING]
    return *figures.span(ratios), figures.word(len(scanned()))


@page.says("In the report on growth, their total time grows with the number of faces to the power of {} to {}.")
def exponents():
    fits = [fit for path in GROWTH.values() for fit in data.finding(path, "growth")["fits"]]
    return figures.exponent_span(fit["all"]["exponent"] for fit in fits if fit["scans"] and not fit["estimated"])


@page.says(
    "choose the indexed face set: it needs {} bytes per vertex, and every other backend takes at least {} times its time in "
    "the workload `one-shot-conversion`"
)
def conversion():
    rows = advice.CONVERTING.everywhere()
    ratios = [w.ratio(name, "indexed-face-set") for w in rows for name in w.rows if name != "indexed-face-set"]
    return study().bytes_per_vertex("indexed-face-set"), figures.at_least(ratios)


def leading(backend, measured):
    """Returns in how many measurements a backend is the fastest or shares the first place, and the number of measurements."""
    return figures.count(sum(backend in workload.leaders() for workload in measured)), figures.count(len(measured))


@page.says("**For a program that only queries a few known relations, choose relation tables.**")
def tables_first():
    data.require(advice.QUERIES.used() == advice.TABLES, "another backend is used")


@page.says(
    "In the {} workloads that query neighbours, they are fastest, or share the first place, in {} of {} measurements (each "
    "workload on each mesh), and the best structure on average takes {} to {} times their time."
)
def tables():
    ratios = [advice.QUERIES.next_best(mesh)[1].value for mesh in advice.MESHES]
    led = leading(advice.TABLES, advice.QUERIES.everywhere())
    return figures.word(len(advice.NEIGHBOURS)), *led, *figures.span(ratios)


@page.says("Including the time to build, they are the cheapest for one use in {} of {}.")
def tables_once():
    measured = advice.QUERIES.everywhere()
    return figures.count(sum(w.cheapest() == advice.TABLES for w in measured)), figures.count(len(measured))


@page.says("**To edit triangle meshes, choose the corner table.**")
def corner_table_first():
    data.require(advice.TRIANGLE_EDITS.used() == "corner-table", "another backend is used")


@page.says(
    "The corner table holds only triangles and needs {} bytes per vertex, half-edge {}. In the workloads `remeshing` and `decimation`, half-edge "
    "takes {} to {} times its time (geometric means for each mesh), a clear difference on {} of the {} meshes. The corner table is "
    "fastest, or shares the first place, in {} of {} measurements."
)
def corner_table():
    kind = advice.TRIANGLE_EDITS
    ratios = [advice.mean(kind.on(mesh), "half-edge", "corner-table").value for mesh in kind.meshes]
    sizes = [study().bytes_per_vertex(name) for name in ("corner-table", "half-edge")]
    clear = figures.word(len(kind.decided())) if kind.decided() else "none"
    return *sizes, *figures.span(ratios), clear, figures.word(len(kind.meshes)), *leading("corner-table", kind.everywhere())


@page.says(
    "On the built-in mesh, it is also the fastest for the relations FV, FE and FF and for a breadth-first search over faces"
)
def corner_table_relations():
    led = {operation: study().leaders(operation) for operation in [*relations("FV FE FF"), "ff_bfs"]}
    data.require(all(names == ["corner-table"] for names in led.values()), f"the fastest are {led}")


@page.says("for VV, VE, VF, EV, EE and EF, it takes {} to {} times the time of half-edge")
def corner_table_elsewhere():
    return figures.span(study().ratios("corner-table", "half-edge", relations("VV VE VF EV EE EF")))


@page.says("On the built-in mesh, half-edge is the single fastest in {} of {} operations, including VV and VE.")
def half_edge():
    won = study().won("half-edge")
    data.require(set(relations("VV VE")) <= set(won), f"half-edge is the fastest in {won}")
    return figures.count(len(won)), figures.count(len(study().operations))


@page.says("In the workload `modelling`, no backend is faster on any mesh.")
def modelling():
    measured = advice.POLYGON_EDITS.everywhere()
    data.require(all("half-edge" in workload.leaders() for workload in measured), "another backend is faster")


@page.says("**To edit polygon meshes, or to query vertices and edges, choose half-edge.**")
def half_edge_first():
    won = {name: len(study().won(name)) for name in STRUCTURES}
    data.require(max(won, key=won.get) == "half-edge", f"the numbers of fastest operations are {won}")


@page.says(
    "In {} of {} measurements of workloads, it takes at most twice the time of the fastest backend; the corner table does in {} of "
    "the {} that it can do."
)
def at_most_twice():
    counts = []
    for name in ("half-edge", "corner-table"):
        ratios = [w.ratio(name) for w in data.workloads().values() if name in w.rows]
        counts += [figures.count(sum(ratio <= 2 for ratio in ratios)), figures.count(len(ratios))]
    return tuple(counts)


@page.says("Half-edge needs {} bytes per vertex")
def half_edge_bytes():
    return study().bytes_per_vertex("half-edge")


@page.says(
    "a query of VF takes {} to {} ns at every size and in both orders of the report on growth. Half-edge, winged-edge and "
    "corner table walk around the vertex, which takes {} to {} ns in the original order and {} to {} ns in random order"
)
def vertex_faces():
    times = lambda order, names: [ns for line in data.per_element(order, "vertex_faces", names) for ns in line]
    stored = times("given", ["face-vertex"]) + times("shuffled", ["face-vertex"])
    walks = [figures.ns_span(times(order, WALKING)) for order in GROWTH]
    return *figures.ns_span(stored), *walks[0], *walks[1]


@page.says("**To collect the faces around vertices, choose face-vertex.**")
def face_vertex_first():
    led = study().leaders("vertex_faces")
    data.require(led == ["face-vertex"], f"the fastest are {led}")


@page.says("In the workload `vertex-normals`, face-vertex takes at most {} times the time of the fastest backend on the four meshes")
def vertex_normals():
    return figures.at_most(data.workload("vertex-normals", mesh).ratio("face-vertex") for mesh in advice.MESHES)


@page.says("EV, EE, EF and FF take {} to {} times the time of half-edge on the built-in mesh")
def face_vertex_searches():
    return figures.span(study().ratios("face-vertex", "half-edge", relations("EV EE EF FF")))


@page.says(
    "**Winged-edge is almost never the best choice.** Winged-edge needs {} bytes per vertex. On the built-in mesh, it takes "
    "{} to {} times the time of half-edge for the nine relations, and is the single fastest in {} of {} operations."
)
def winged_edge():
    won, ratios = study().won("winged-edge"), study().ratios("winged-edge", "half-edge", RELATIONS.values())
    counts = figures.word(len(won)) if won else "none", figures.count(len(study().operations))
    return study().bytes_per_vertex("winged-edge"), *figures.span(ratios), *counts


def ordered_ns(operation, backend):
    """Returns the times of a structure in the four orders."""
    rows = [r for r in data.finding(ORDERS, "orders")["results"] if (r["operation"], r["backend"]) == (operation, backend)]
    return {row["case"]: row["median_ns"] for row in rows}


def disorder(names):
    """Returns the times in random order, relative to the best order."""
    times = [ordered_ns(operation, name) for operation in AROUND_VERTICES for name in names]
    return [ns["shuffled"] / min(ns.values()) for ns in times]


@page.says(
    "On {} triangles in random order, half-edge, winged-edge and corner table take {} to {} times their time in the best of "
    "four orders (for VV, VF and vertex normals), and face-vertex takes at most {} times"
)
def random_order():
    faces = data.document(ORDERS)["meshes"][0]["faces"]
    return figures.count(faces), *figures.span(disorder(WALKING)), figures.at_most(disorder(["face-vertex"]))


@page.says(
    "If each of these structures has its best order, the slowest takes {} to {} times the time of the fastest, depending on "
    "the operation"
)
def best_orders():
    operations = dict.fromkeys(row["operation"] for row in data.finding(ORDERS, "orders")["results"])
    best = [[min(ordered_ns(operation, name).values()) for name in LOCAL] for operation in operations]
    return figures.span(max(times) / min(times) for times in best)


def growths(order, operations):
    lines = [line for operation in operations for line in data.per_element(order, operation, WALKING)]
    return [line[-1] / line[0] for line in lines]


@page.says(
    "From {} to {} triangles in the original order, the time per element of half-edge, winged-edge and corner table changes "
    "by a factor of {} to {}, and in a breadth-first search over faces by a factor of {} to {}."
)
def growth():
    faces = [size["faces"] for size in data.sizes("given")]
    operations = [fit["operation"] for fit in data.finding(GROWTH["given"], "growth")["fits"]]
    others = [operation for operation in dict.fromkeys(operations) if operation != "ff_bfs"]
    factors = *figures.span(growths("given", others)), *figures.span(growths("given", ["ff_bfs"]))
    return figures.count(faces[0]), figures.count(faces[-1]), *factors


@page.says("For meshes in random order, the factor for VV, VF and vertex normals is {} to {}.")
def growth_shuffled():
    return figures.span(growths("shuffled", AROUND_VERTICES))


@page.says("The largest structures of the report fit into the last-level cache, which the machine shares with others: half-edge is larger than "
           "it from {} triangles on, the corner table from {} triangles on")
def cache_limits():
    found = data.finding(GROWTH["given"], "growth")
    last = max(limit["level"] for limit in found["cache_limits"])
    faces = {limit["backend"]: limit["faces"] for limit in found["cache_limits"] if limit["level"] == last}
    largest = max(size["faces"] for order in GROWTH for size in data.sizes(order))
    data.require(largest < min(faces[name] for name in LOCAL), f"a structure of {largest} faces is larger")
    return figures.count(faces["half-edge"]), figures.count(faces["corner-table"])


@page.says("**Of {} other libraries, only {} is as fast as half-edge on average.**")
def as_fast():
    faster, equal = beside.faster()
    data.require(not faster, f"{faster} are faster")
    return figures.word(len(beside.libraries())), figures.names(map(beside.title, equal))


@page.says("Relative to half-edge on the built-in mesh (geometric mean over the nine relations), OpenSubdiv takes {} times the "
           "time, parry3d {}, CGAL's Surface_mesh {}, OpenMesh {}, lox {}, alum {} and tri-mesh {}.")
def beside_means():
    means = map(beside.on_relations, ("opensubdiv", "parry3d", "cgal", "openmesh", "lox", "alum", "tri-mesh"))
    return tuple(figures.ratio(mean.value) for mean in means)


def beside_ratios(library, *letters):
    ratios = data.study(beside.DATA).ratios(library, "half-edge", [RELATIONS[pair] for pair in letters])
    return tuple(figures.ratio(ratio) for ratio in ratios)


@page.says(
    "OpenSubdiv stores relations as flat tables that cannot be edited: it takes {} times the time of half-edge for VE, {} "
    "for VF and {} for EF"
)
def opensubdiv():
    return beside_ratios("opensubdiv", "VE", "VF", "EF")


@page.says("To build a mesh, the libraries take {} times ({}) to {} times ({}) the time of half-edge")
def builds():
    ratios = {name: beside.mean(name, ["build"]).value for name in beside.libraries()}
    low, high = min(ratios, key=ratios.get), max(ratios, key=ratios.get)
    return figures.ratio(ratios[low], math.floor), low, figures.ratio(ratios[high], math.ceil), high


# The table of workloads.


@page.says(
    "The built-in mesh has {} triangles. Each of the other meshes differs from it in one thing: the order is random, it has {} "
    "triangles, or it has {} quads with as many edges."
)
def meshes():
    faces = {mesh["name"]: mesh["faces"] for mesh in workload_table.meshes()}
    return tuple(figures.count(faces[mesh]) for mesh in (BUILT_IN, LARGE, QUADS))


@page.says("All workloads were measured at commit {}.")
def workload_commit():
    return figures.names(sorted({found["commit"][:7] for found in data.workload_environments()}))


for workload_name in workload_table.NAMES:
    cells = f"| {workload_name} | {{}} | {{}} | {{}} | {{}} |"
    page.row(cells, workload_table.fastest_row, workload_name, section="## The fifteen workloads")
    page.row(cells, workload_table.cheapest_row, workload_name, section="### Including the time to build")


@page.says("## The {} workloads")
def all_workloads():
    data.require(set(data.workload_names()) == set(workload_table.NAMES), "the names differ from checks/workload_table.py")
    return figures.word(len(workload_table.NAMES))


for program, kind in advice.ROWS.items():
    page.row(f"| {program} | {{}} | {{}} |", advice.Kind.described, kind, section="### The workloads of the advice")


# The list of reports.


EXAMPLES = ("reports/editing/editing.json", "reports/subdivision/subdivision.json")
ANSWER = "reports/built-in-mesh/report.md"


@page.says(
    "Half-edge is fastest for queries and for subdivision, shares the first place with corner table for edits, and indexed face set "
    "is fastest to build."
)
def answer_of_study():
    expected = {
        "Queries": "half-edge",
        "Subdivision": "half-edge",
        "Edits": "corner-table or half-edge",
        "Building": "indexed-face-set",
    }
    for work, winner in expected.items():
        [found] = data.quoted(ANSWER, rf"- {work}: ([a-z -]+); ")
        data.require(found == winner, f"{work}: {found}")


@page.says(
    "Relation tables are fastest on the built-in mesh in most workloads that query neighbours, and no structure is fastest in all "
    "workloads."
)
def answer_of_workloads():
    fastest = {name: data.workload(name, BUILT_IN).found["ranking"][0]["backend"] for name in data.workload_names()}
    local = [fastest[name] for name in advice.ROWS["queries neighbours, and keeps its connectivity (vertices may move)"].workloads]
    data.require(local.count("relation-tables") > len(local) / 2, f"{local}")
    data.require(len(set(fastest.values())) > 1, f"{fastest}")


@page.says("Random order costs half-edge more time than the choice of another structure for vertex neighbours.")
def answer_of_orders():
    rows = [row for row in data.finding(ORDERS, "orders")["results"] if row["operation"] == "vertex_vertices"]
    best = {}
    for row in rows:
        known = best.setdefault(row["backend"], [])
        known.append(row["ns_per_element"])
    own = best["half-edge"]
    others = [min(best[name]) for name in LOCAL if name != "half-edge"]
    data.require(max(own) / min(own) > max(others) / min(own), f"{best}")


@page.says(
    "In the original order, the time for the neighbours of all vertices grows with the square of the number of faces if the "
    "structure scans, and in proportion to it otherwise."
)
def answer_of_growth():
    fits = data.finding(GROWTH["given"], "growth")["fits"]
    of = lambda names: [fit for fit in fits if fit["backend"] in names and fit["operation"] == "vertex_vertices" and fit["all"]]
    data.require(all(1.9 < fit["all"]["exponent"] < 2.2 for fit in of(SCANNING)), "the exponents of scans")
    data.require(all(0.9 < fit["all"]["exponent"] < 1.15 for fit in of(LOCAL)), "the exponents of the others")


@page.says(
    "No library but OpenSubdiv, whose relations cannot be edited, is as fast as half-edge on average over the nine relations."
)
def answer_of_libraries():
    faster, equal = beside.faster()
    data.require([*faster, *equal] == ["opensubdiv"], f"{faster}, {equal}")


@page.says("In both schemes, a structure that splits its own tables (`native`) is fastest.")
def answer_of_subdivision():
    rows = data.document(EXAMPLES[1])["results"]
    for scheme in {row["scheme"] for row in rows}:
        last = max(row["level"] for row in rows if row["scheme"] == scheme)
        here = [row for row in rows if (row["scheme"], row["level"]) == (scheme, last)]
        fastest = min(here, key=lambda row: statistics.median(row["cpu_ns"]))
        data.require(fastest["way"].startswith("native"), f"{fastest}")


@page.says(
    "The first five of the list, and those on subdivision, editing and neighbours, were measured on machines of one kind, at commit {} "
    "(workloads: {})."
)
def measured():
    found = [*map(data.environment, (STUDY, ORDERS, beside.DATA, *GROWTH.values(), *neighbours.DOCUMENTS))]
    found += [data.document(path)["environment"] for path in EXAMPLES]
    data.require(len({each["cpu_model"] for each in [*found, *data.workload_environments()]}) == 1, "other machines")
    return figures.names(sorted({each["commit"][:7] for each in found})), workload_commit()


# Repeatability.


@page.says("The built-in mesh was studied {} times, one study after the other, for {} seconds each, on a machine that was not idle.")
def repeated():
    return repeatability.runs()


@page.says("Of the 95 % intervals of ratios, {} contain the median of the other studies; of those of times, {} do.")
def coverage():
    return repeatability.coverage("ratios"), repeatability.coverage("times")


@page.says("In {} studies of two operations, during which the machine became faster, {} of the intervals of ratios and {} of those of "
           "times contain the median of the other studies.")
def coverage_of_named():
    shares = [repeatability.coverage(kind, repeatability.NAMED) for kind in ("ratios", "times")]
    return repeatability.runs(repeatability.NAMED)[0], *shares


@page.says("The studies name a sole winner for {} operations each, and {} of these are the usual winner.")
def winners():
    return repeatability.winners()


@page.says("From study to study, a time varies by {} and a ratio by {} (the standard deviation divided by the mean; median over all).")
def variation():
    return repeatability.variation("times"), repeatability.variation("ratios")


TEXTS = [page]
