#!/usr/bin/env python3
"""Checks that the engine itself takes less than 1 % of the time that it measures.

Usage: engine_cost.py [--times 3] [--limit 0.01]

Runs the test `engine_cost` of the crate sixfold-study in the profile release. The test measures all operations
on a geodesic sphere of 20,480 triangles, on the four structures that answer locally, for 20 s. The cost of the
engine is the time that is not spent in the structures (operations, untimed runs, copies and building), divided
by the time of the timed runs. Both are processor time of the thread. The exit code is 1 if the smallest cost of
all runs is above the limit.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = ["cargo", "test", "--quiet", "--release", "-p", "sixfold-study", "--lib", "engine_cost", "--",
           "--ignored", "--nocapture", "--test-threads=1"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--limit", type=float, default=0.01)
    chosen = parser.parse_args()
    costs = []
    for _ in range(chosen.times):
        load = os.getloadavg()[0]
        done = subprocess.run(COMMAND, cwd=ROOT, check=True, capture_output=True, text=True)
        line = re.search(r"engine_cost (\S+) (.*)", done.stdout)
        if line is None:
            sys.exit(f"error: the test printed no cost:\n{done.stdout}")
        costs.append(float(line[1]))
        print(f"{100 * costs[-1]:.3f} % (load {load:.1f}): {line[2]}", flush=True)
    least = min(costs)
    print(f"smallest cost: {100 * least:.3f} %, limit {100 * chosen.limit:.1f} %")
    return int(least > chosen.limit)


if __name__ == "__main__":
    sys.exit(main())
