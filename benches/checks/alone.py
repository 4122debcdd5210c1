#!/usr/bin/env python3
"""Compares the times of a study with the times of each operation in a separate process.

Usage: alone.py [--sixfold PATH] [--peer PATH] [--times 10] [--sizes 2000,20000,200000] [--json FILE]

Before this script, run `cargo build --release -p sixfold-cli -p sixfold-study --bin sixfold --example peer`.

For each size, the script studies a geodesic sphere on the four structures that answer locally. Before and
after each study, `peer` runs every operation alone, in processes of one structure. A cell is an operation
on a structure. Its ratio is the time in the study divided by the time alone. The script prints the medians of
the paired ratios. At 200,000 faces, the script compares the nine relations, the sweeps, `vv_smooth` and
`build`; at smaller sizes, it compares all operations. The exit code is 1 if fewer than 95 % of the cells are
within 5 %, or if a cell differs by more than 15 %.
"""

import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
STRUCTURES = ["face-vertex", "winged-edge", "half-edge", "corner-table"]
# Seconds of a study, by number of faces.
BUDGETS = {2_000: 10, 20_000: 20, 200_000: 60}
# Rounds of processes before each study, and the same number after it. A single round of one second
# could lie completely in a phase in which the processor runs slower or faster.
PASSES = 3
RELATIONS = [f"{a}_{b}" for a in ("vertex", "edge", "face") for b in ("vertices", "edges", "faces")]
SWEEPS = ["circulate", "face_barycenter", "vertex_normal", "vv_smooth", "edge_length", "boundary",
          "ff_bfs", "all_queries"]
MAKERS = [f"{scheme}_{way}" for scheme in ("catmull_clark", "loop") for way in ("gather", "scatter", "native")]
EDITS = ["split_collapse", "flip_all", "decimate_half", "decimate_tenth"]


def lines(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout


def studied(sixfold, mesh, budget, operations, seed, folder):
    out = folder / "study.json"
    lines([sixfold, "study", mesh, "--budget", f"{budget}s", "--seed", str(seed), "--json", out,
           "--backends", ",".join(STRUCTURES), "--operations", ",".join(operations)])
    rows = json.loads(out.read_text())["findings"][0]["results"]
    # A single sample is nearly a warm-up run, so its time cannot be compared.
    return {(r["operation"], r["backend"]): r["median_ns"] for r in rows
            if r["median_ns"] and r["samples"] > 1}


def alone(peer, mesh, operations, reps, found):
    for structure in STRUCTURES:
        text = lines([peer, "--mesh", mesh, "--backend", structure, "--reps", str(reps),
                      "--budget", "0.2", "--op", *operations])
        for line in text.splitlines():
            row = json.loads(line)
            if not math.isnan(row["checksum"] if row["checksum"] is not None else math.nan):
                found.setdefault((row["op"], structure), []).append(row["cpu_median_ns"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--sixfold", default=ROOT / "target/release/sixfold")
    parser.add_argument("--peer", default=ROOT / "target/release/examples/peer")
    parser.add_argument("--times", type=int, default=10)
    parser.add_argument("--sizes", default="2000,20000,200000")
    parser.add_argument("--reps", type=int, default=7)
    parser.add_argument("--scale", type=float, default=1.0, help="factor for the budgets")
    parser.add_argument("--json")
    chosen = parser.parse_args()
    ratios, missing = {}, set()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for size in map(int, chosen.sizes.split(",")):
            mesh = folder / f"{size}.obj"
            frequency = round(math.sqrt(size / 20))
            lines([chosen.sixfold, "generate", "geodesic", f"frequency={frequency}", "-o", mesh])
            operations = ["build", *RELATIONS, *SWEEPS]
            if size < 200_000:
                operations += [*MAKERS, *EDITS]
            for seed in range(1, chosen.times + 1):
                budget = BUDGETS.get(size, 20) * chosen.scale
                single = {}
                for _ in range(PASSES):
                    alone(chosen.peer, mesh, operations, chosen.reps, single)
                both = studied(chosen.sixfold, mesh, budget, operations, seed, folder)
                for _ in range(PASSES):
                    alone(chosen.peer, mesh, operations, chosen.reps, single)
                missing |= {(size, *cell) for cell in single.keys() - both.keys()}
                for cell in both.keys() & single.keys():
                    ratio = both[cell] / statistics.median(single[cell])
                    ratios.setdefault((size, *cell), []).append(ratio)
                print(f"{size} faces, {seed} of {chosen.times}", file=sys.stderr, flush=True)
    cells = {cell: statistics.median(values) for cell, values in ratios.items()}
    off = {cell: ratio for cell, ratio in cells.items() if max(ratio, 1 / ratio) > 1.05}
    worst = max(max(ratio, 1 / ratio) for ratio in cells.values())
    share = 1 - len(off) / len(cells)
    if missing - cells.keys():
        print(f"without two samples in any study: {sorted(missing - cells.keys())}")
    print(f"{len(cells)} cells; {100 * share:.1f} % within 5 %; the largest difference is {100 * (worst - 1):.1f} %")
    for (size, operation, structure), ratio in sorted(off.items(), key=lambda item: -abs(math.log(item[1]))):
        values = sorted(ratios[size, operation, structure])
        print(f"  {size:>7} {operation:<22} {structure:<13} {ratio:.3f}  ({values[0]:.3f} to {values[-1]:.3f})")
    if chosen.json:
        rows = [{"faces": c[0], "operation": c[1], "structure": c[2], "ratio": cells[c], "ratios": ratios[c]}
                for c in sorted(cells)]
        pathlib.Path(chosen.json).write_text(json.dumps(rows, indent=0) + "\n")
    sys.exit(0 if share >= 0.95 and worst <= 1.15 and not missing - cells.keys() else 1)


if __name__ == "__main__":
    main()
