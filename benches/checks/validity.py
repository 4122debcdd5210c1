#!/usr/bin/env python3
"""Compares the answers of `sixfold pick` with the measured times of eight programs.

    benches/checks/validity.py --to reports/validity [--budget 3] [MESH...]

For each mesh, the programs of the example `programs` are measured on four structures: these ratios are the truth. Each program
is also recorded. Five predictions are compared with the truth: the built-in workload that is closest to the program, the
recorded workload, the recorded trace, and for both workloads the first answer of `pick`: the counted table rows, which are
printed before any time is measured, sorted by rows and then by bytes. Without a mesh, four built-in shapes are used. Needs about two minutes for each mesh.
Writes `validity.json` and `tables.md`, whose tables are in `report.md`. Builds the command, and then the programs as a package of a
user is compiled: for speed. (The package that has the example is compiled for size.)
"""

import argparse
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

STRUCTURES = ["face-vertex", "winged-edge", "half-edge", "corner-table"]
# The built-in workload that is closest to each program.
PROGRAMS = {
    "geodesics": "geodesic-dijkstra",
    "feature-lines": "feature-detection",
    "laplacian": "parameterisation",
    "regions": "region-growing",
    "remesh": "remeshing",
    "taubin": "smoothing",
    "gathered-normals": "vertex-normals",
    "scattered-normals": "rendering-upload",
}
SHAPES = {
    "ball": ["geodesic", "frequency=45"],
    "torus-shuffled": ["triangle-torus", "m=200", "n=150", "--order", "shuffled"],
    "blobs": ["blobs"],
    "built-in-mesh": ["built-in-mesh"],
}
METHODS = ["built-in workload", "recorded workload", "trace", "first answer, built-in", "first answer, recorded"]
# Two structures count as equally fast up to this ratio of their true times.
EQUAL = 1.05


# The package that has the example is compiled for size, and its examples with it.
AS_A_USER = [
    "--config", "profile.release.package.sixfold-measure.opt-level=3",
    "--config", "profile.release.package.sixfold-measure.codegen-units=16",
]


def run(command):
    """Returns the standard output; None if the command fails."""
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode != 0:
        print(f"{' '.join(command)}: exit code {ran.returncode}: {ran.stderr.strip()}", file=sys.stderr)
    return ran.stdout if ran.returncode == 0 else None


def counted_reads(printed):
    """Returns the table rows that each operation reads, which `pick` prints before it measures."""
    found = re.search(r"^Reads: (.*?) table\s+rows", printed, re.MULTILINE | re.DOTALL)
    counts = re.findall(r"([a-z-]+)\s+([0-9][0-9.,]*[0-9]|[0-9])", found[1]) if found else []
    return {name: float(reads.replace(",", "")) for name, reads in counts}


def times(finding):
    return {row["backend"]: row["ns_per_operation"] for row in finding["ranking"] if row["backend"] in STRUCTURES}


def picked(sixfold, mesh, option, value, budget, scratch):
    """Returns the measured times of a workload or trace, and the counted table rows."""
    file = f"{scratch}/pick.json"
    printed = run([sixfold, "pick", mesh, option, value, "--backends", ",".join(STRUCTURES), "--budget", f"{budget}s", "--json", file])
    if printed is None:
        return {}, {}
    return times(json.load(open(file))["findings"][0]), counted_reads(printed)


def compared(true, predicted):
    """Returns how well the predicted times agree with the true ones."""
    both = [name for name in true if name in predicted]
    if len(both) < 2:
        return None
    # Of equal counts, the first one is the answer: `pick` sorts them by bytes.
    chosen = min((name for name in predicted if name in true), key=predicted.get)
    best = min(both, key=true.get)
    errors = []
    agreeing = 0
    pairs = list(itertools.combinations(both, 2))
    for a, b in pairs:
        agreeing += (predicted[a] < predicted[b]) == (true[a] < true[b])
        # A structure can need no table row; then there is no ratio.
        if predicted[a] and predicted[b]:
            error = (predicted[a] / predicted[b]) / (true[a] / true[b])
            errors.append(max(error, 1 / error))
    if not errors:
        return None
    return {
        "chosen": chosen,
        "best": best,
        "regret": true[chosen] / true[best],
        "tau": (2 * agreeing - len(pairs)) / len(pairs),
        "error": median(errors),
        "worst_error": max(errors),
    }


def measure(name, mesh, programs, sixfold, budget, scratch):
    """Returns one row for each program."""
    truth_file, records = f"{scratch}/truth.json", f"{scratch}/records"
    chosen = ["--backends", ",".join(STRUCTURES)]
    run([programs, mesh, *chosen, "--budget", f"{budget * len(PROGRAMS)}s", "--json", truth_file])
    run([programs, mesh, *chosen, "--budget", f"{budget * len(PROGRAMS)}s", "--record", records])
    truth = {f["workload"]["name"]: times(f) for f in json.load(open(truth_file))["findings"]}
    built_in = {w: picked(sixfold, mesh, "--workload", w, budget, scratch) for w in sorted(set(PROGRAMS.values()))}
    rows = []
    for program, workload in PROGRAMS.items():
        true = truth.get(program, {})
        if len(true) < 2:
            continue
        by_built_in, reads_of_built_in = built_in[workload]
        workload_file = Path(records) / f"{program}.toml"
        with workload_file.open("w") as out:
            trace = f"{records}/{program}.trace"
            command = [sixfold, "workloads", "--trace", trace, mesh, "--budget", f"{budget}s"]
            subprocess.run(command, stdout=out, check=True)
        by_recorded, reads_of_recorded = picked(sixfold, mesh, "--workload", str(workload_file), budget, scratch)
        by_trace, _ = picked(sixfold, mesh, "--trace", f"{records}/{program}.trace", budget, scratch)
        every = [by_built_in, by_recorded, by_trace, reads_of_built_in, reads_of_recorded]
        predictions = dict(zip(METHODS, every))
        row = {"mesh": name, "program": program, "workload": workload, "ns": true, "predicted_ns": predictions}
        row["agreement"] = {method: compared(true, predictions[method]) for method in METHODS}
        rows.append(row)
        print(name, program, {m: a and round(a["regret"], 3) for m, a in row["agreement"].items()}, flush=True)
    return rows


def summary(rows, method):
    each = [row["agreement"][method] for row in rows if row["agreement"][method]]
    regrets = [a["regret"] for a in each]
    return {
        "cases": len(each),
        "right": sum(r == 1.0 for r in regrets),
        "within": sum(r <= EQUAL for r in regrets),
        "mean": sum(regrets) / len(regrets),
        "worst": max(regrets),
        "tau": sum(a["tau"] for a in each) / len(each),
        "error": median(a["error"] for a in each),
        "worst_error": max(a["worst_error"] for a in each),
    }


def tables(rows):
    lines = [
        "| prediction | cases | fastest named | within 5 % | mean regret | worst regret | rank correlation | typical error of ratios | worst |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for method in METHODS:
        s = summary(rows, method)
        lines.append(
            f"| {method} | {s['cases']} | {s['right']} | {s['within']} | {s['mean']:.3f} | {s['worst']:.2f} | {s['tau']:.2f} "
            f"| {s['error']:.2f} | {s['worst_error']:.2f} |"
        )
    lines += ["", "## By program", "", "| program | built-in workload | prediction | within 5 % | worst regret | typical error |", "|---|---|---|---|---|---|"]
    for program, workload in PROGRAMS.items():
        of_program = [row for row in rows if row["program"] == program]
        for method in METHODS if of_program else []:
            # `pick` has no first answer for a program with edits.
            if not any(row["agreement"][method] for row in of_program):
                continue
            s = summary(of_program, method)
            lines.append(f"| {program} | {workload} | {method} | {s['within']} of {s['cases']} | {s['worst']:.2f} | {s['error']:.2f} |")
    lines += ["", "## All cases", "", "Times relative to the fastest structure: measured / by the recorded workload / by the trace.", ""]
    lines += ["| mesh | program | " + " | ".join(STRUCTURES) + " |", "|---|---|" + "---|" * len(STRUCTURES)]
    for row in rows:
        cells = []
        for structure in STRUCTURES:
            values = [row["ns"]] + [row["predicted_ns"][method] for method in METHODS[1:3]]
            shown = [f"{v[structure] / min(v.values()):.2f}" if structure in v else "–" for v in values]
            cells.append(" / ".join(shown))
        lines.append(f"| {row['mesh']} | {row['program']} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="*", metavar="MESH")
    parser.add_argument("--to", type=Path, required=True, help="the folder of the report")
    parser.add_argument("--budget", type=float, default=3, help="seconds for each measurement")
    arguments = parser.parse_args()
    checkout = Path(__file__).resolve().parents[2]
    built = Path(os.environ.get("CARGO_TARGET_DIR") or checkout / "target") / "release"
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        build = ["cargo", "build", "--release", "-p"]
        subprocess.run([*build, "sixfold-measure", "--example", "programs", *AS_A_USER], cwd=checkout, check=True)
        programs = shutil.copy(built / "examples/programs", scratch)
        subprocess.run([*build, "sixfold-cli", "--bins"], cwd=checkout, check=True)
        sixfold = shutil.copy(built / "sixfold", scratch)
        meshes = {Path(mesh).stem: mesh for mesh in arguments.meshes}
        for name, shape in SHAPES.items() if not meshes else []:
            meshes[name] = f"{scratch}/{name}.obj"
            run([sixfold, "generate", *shape, "-o", meshes[name]])
        for name, mesh in meshes.items():
            folder = f"{scratch}/{name}"
            os.mkdir(folder)
            rows += measure(name, mesh, programs, sixfold, arguments.budget, folder)
    arguments.to.mkdir(parents=True, exist_ok=True)
    json.dump(rows, open(arguments.to / "validity.json", "w"), indent=1)
    (arguments.to / "tables.md").write_text(tables(rows))


main()
