"""The claims of reports/neighbours/README.md, whose table is computed from the four documents of the folder."""

from checks import data, figures
from checks.claims import Claims

FOLDER = "reports/neighbours"
DOCUMENTS = tuple(f"{FOLDER}/{name}.json" for name in ("built-in-near", "built-in-box", "sphere-near", "sphere-box"))
TASKS = (
    "build_vertices", "nearest_vertex", "vertices_within", "nearest_eight", "build_triangles", "closest_point", "first_hit",
)

page = Claims(
    f"{FOLDER}/README.md",
    definitions="""
        writes four results
        a geodesic sphere of 499,280 triangles
        the eight nearest vertices
        the two fastest indices
    """,
)


def cell(path, task):
    """Returns the two fastest indices. Those that share the first place are bold."""
    rows = [row for row in data.finding(path, "neighbours")["results"] if row["operation"] == task and row["median_ns"]]
    rows = sorted(rows, key=lambda row: row["ratio_to_best"] or 1)
    leads = lambda row: row["standing"] in ("best", "equal", "undecided")
    ratio = lambda row: "" if row is rows[0] else f" {figures.ratio(row['ratio_to_best'])}"
    shown = lambda row: f"**{row['backend']}{ratio(row)}**" if leads(row) else row["backend"] + ratio(row)
    return ", ".join(shown(row) for place, row in enumerate(rows) if place < 2 or leads(row))


def row(task):
    return tuple(cell(path, task) for path in DOCUMENTS)


for name in TASKS:
    page.row(f"| `{name}` | {{}} | {{}} | {{}} | {{}} |", row, name)


@page.says("``` {}; {} cores; {} {}; {}, {} {}; Sixfold {} ({})")
def machine():
    e = data.environment(DOCUMENTS[0])
    data.require(all(data.environment(path)["commit"] == e["commit"] for path in DOCUMENTS), "several commits")
    compiler = e["rustc"].split(" (")[0], e["profile"], e["rustflags"]
    return e["cpu_model"], str(e["cores"]), e["os"], e["kernel"], *compiler, e["sixfold"], e["commit"]


@page.says("the grid takes {} times the time of the fastest index for `nearest_vertex` in the box, and {} times near the surface.")
def grid_in_the_box():
    rows = lambda path: data.finding(path, "neighbours")["results"]
    grid = lambda path: next(row for row in rows(path) if (row["operation"], row["backend"]) == ("nearest_vertex", "grid"))
    near, box = (grid(path) for path in DOCUMENTS[2:])
    data.require(box["sample_size"] is not None, "the grid answered all queries in the box")
    return figures.ratio(box["ratio_to_best"]), figures.ratio(near["ratio_to_best"])


TEXTS = [page]
