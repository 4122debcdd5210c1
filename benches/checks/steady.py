#!/usr/bin/env python3
"""Repeats one study, and prints how stable its control and its medians are.

Usage: steady.py [--sixfold PATH] [--times 16] [--budget 8s] [--heap kept]

Repeatedly studies a geodesic sphere of 20,480 triangles, on the four structures that answer locally, with
the same settings. The exit code is 1 if

- the control leaves its limits in more than one study (a ratio of 1.10 or its inverse for operations that make
  a mesh, 1.05 or its inverse for other operations);
- the largest median of a row is more than 1.25 times its smallest median; or
- kept samples have page faults with `--heap kept`.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
STRUCTURES = "half-edge,corner-table,winged-edge,face-vertex"
MAKES = ("catmull_clark", "loop", "split_collapse", "flip_all", "decimate")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--sixfold", default=ROOT / "target/release/sixfold")
    parser.add_argument("--times", type=int, default=16)
    parser.add_argument("--budget", default="8s")
    parser.add_argument("--heap", default="kept")
    chosen = parser.parse_args()
    figures, outside, wide, faults = {}, 0, [], 0
    with tempfile.TemporaryDirectory() as name:
        mesh, out = pathlib.Path(name, "g.obj"), pathlib.Path(name, "study.json")
        subprocess.run([chosen.sixfold, "generate", "geodesic", "frequency=32", "-o", mesh], check=True,
                       capture_output=True)
        for study in range(chosen.times):
            subprocess.run([chosen.sixfold, "study", mesh, "--budget", chosen.budget, "--backends", STRUCTURES,
                            "--heap", chosen.heap, "--json", out], check=True, capture_output=True)
            [report] = json.loads(out.read_text())["findings"]
            beyond = []
            for row in report["control"]["operations"]:
                limit = 1.10 if row["operation"].startswith(MAKES) else 1.05
                if max(row["ratio"], 1 / row["ratio"]) > limit:
                    beyond.append(f"{row['operation']} {row['ratio']:.3f}")
            outside += bool(beyond)
            measured = [row for row in report["results"] if row["median_ns"]]
            known = [row for row in measured if row["ci_low_ns"]]
            wide.append(sum(max(row["ci_high_ns"] - row["median_ns"], row["median_ns"] - row["ci_low_ns"])
                            > 0.1 * row["median_ns"] for row in known))
            faults += sum(row["faults"] or 0 for row in measured)
            for row in measured:
                figures.setdefault((row["operation"], row["backend"]), []).append(row["ns_per_element"])
            load = report["start"]["load_average"]
            print(f"{study + 1}: control within its limits" if not beyond else f"{study + 1}: control: {', '.join(beyond)}",
                  f"(load {load:.2f}; {wide[-1]} of {len(known)} intervals wide)", flush=True)
    spread = {cell: max(values) / min(values) for cell, values in figures.items()}
    worst = max(spread, key=spread.get)
    print(f"control within its limits in {chosen.times - outside} of {chosen.times} studies")
    print(f"largest / smallest median of a row: at most {spread[worst]:.2f} ({worst[0]} on {worst[1]}), "
          f"median of {len(spread)} rows {statistics.median(spread.values()):.2f}")
    print(f"intervals wider than 10 % of the median: {min(wide)} to {max(wide)} of {len(known)} rows")
    print(f"page faults in kept samples: {faults}")
    for cell in sorted(spread, key=spread.get, reverse=True)[:5]:
        print(f"  {cell[0]:<22} {cell[1]:<13} {spread[cell]:.2f}  {min(figures[cell]):.2f} to {max(figures[cell]):.2f}")
    sys.exit(0 if outside <= 1 and spread[worst] <= 1.25 and (faults == 0 or chosen.heap != "kept") else 1)


if __name__ == "__main__":
    main()
