#!/usr/bin/env python3
"""Compares the instruction counts of the operations with the committed baseline.

Usage: instructions.py [--write]

Builds the benchmarks of `benches/instructions.rs` with the profile `release`, which programs that depend on
Sixfold use, and runs them under callgrind. Needs valgrind and gungraun-runner. The exit code is 1 if

- a count is more than 0.5 % above the baseline, or has no baseline;
- a count is more than 10 % above the count with the profile `dist`, which has link-time optimisation; or
- the geometric mean of these ratios is above 1.02.

The last two limits ensure that the structures do not rely on link-time optimisation.

`--write` counts with both profiles, replaces the baseline and prints the ratios. Without `--write`, the
counts of `dist` come from the baseline.

Counts depend on the compiler. If rustc differs from the rustc of the baseline, the script only prints the
counts and does not compare them. The C library chooses its copying functions by processor. The script makes
it choose functions that run on every x86-64 processor.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BASELINE = ROOT / "benches/checks/instructions.json"
LINES = ROOT / "benches/instructions.txt"
# The largest allowed count, relative to the baseline.
LIMIT = 1.005
# The largest allowed count and geometric mean with the profile `release`, relative to `dist`.
LIMIT_TO_DIST, MEAN_LIMIT_TO_DIST = 1.10, 1.02
PLAIN_FUNCTIONS = "glibc.cpu.hwcaps=-AVX_Fast_Unaligned_Load,-AVX2,-AVX512F,-AVX512VL,-SSSE3,-ERMS,-FSRM"


def counted(profile):
    """Runs the benchmarks; returns the instructions of each line of `instructions.txt`."""
    command = ["cargo", "bench", "-p", "sixfold-benches", "--bench", "instructions", "--locked", "--profile", profile,
               "--", "--output-format=json"]
    environment = {**os.environ, "GLIBC_TUNABLES": PLAIN_FUNCTIONS}
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, env=environment)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stderr[-4000:]}")
    lines = LINES.read_text().splitlines()
    summaries = [json.loads(text) for text in done.stdout.splitlines() if text.startswith("{")]
    counts = {lines[int(summary["id"].rsplit("_", 1)[1])]: instructions(summary) for summary in summaries}
    if counts.keys() != set(lines) or not all(counts.values()):
        sys.exit(f"not counted: {[line for line in lines if not counts.get(line)]}")
    return counts


def instructions(summary):
    """Returns the number of executed instructions of one benchmark."""
    (callgrind,) = [profile for profile in summary["profiles"] if profile["tool"].lower() == "callgrind"]
    return callgrind["data"]["total"]["metrics"]["Ir"]["values"]["new"]


def faults_of_ratios(release, dist):
    """Prints the instructions of `release` relative to `dist`; returns the ratios that exceed the limits."""
    ratios = {name: count / dist[name] for name, count in release.items() if name in dist}
    mean = math.exp(sum(map(math.log, ratios.values())) / len(ratios))
    worst = max(ratios, key=ratios.get)
    print(f"release relative to dist: geometric mean {mean:.3f}, at most {ratios[worst]:.3f} ({worst})")
    faults = [f"{name}: {ratio:.3f} times the instructions of the profile dist"
              for name, ratio in ratios.items() if ratio > LIMIT_TO_DIST]
    if mean > MEAN_LIMIT_TO_DIST:
        faults.append(f"geometric mean: {mean:.3f} times the instructions of the profile dist")
    return faults, ratios


def write(rustc):
    """Counts with both profiles and replaces the baseline."""
    dist, release = counted("dist"), counted("release")
    BASELINE.write_text(json.dumps({"rustc": rustc, "release": release, "dist": dist}, indent=1) + "\n")
    faults, ratios = faults_of_ratios(release, dist)
    for name, ratio in sorted(ratios.items(), key=lambda item: -item[1]):
        print(f"{ratio:6.3f}  {release[name]:>12,}  {name}")
    return faults


def compare(rustc):
    """Counts with the profile `release`, and compares the counts with the baseline."""
    counts, baseline = counted("release"), json.loads(BASELINE.read_text())
    if baseline["rustc"] != rustc:
        for name, count in counts.items():
            print(f"{count:>12,}  {name}")
        print(f"not compared: the baseline is of {baseline['rustc']}, this is {rustc}")
        return []
    faults, _ = faults_of_ratios(counts, baseline["dist"])
    for name, count in counts.items():
        known = baseline["release"].get(name)
        if known is None:
            faults.append(f"{name}: {count:,} instructions, without a baseline")
        elif count > LIMIT * known:
            faults.append(f"{name}: {count:,} instructions, {100 * (count / known - 1):.2f} % more than {known:,}")
    if not faults:
        print(f"{len(counts)} operations, each at most {100 * (LIMIT - 1):.1f} % above the baseline")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--write", action="store_true", help="count with both profiles and replace the baseline")
    chosen = parser.parse_args()
    version = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True).stdout.strip()
    faults = write(version) if chosen.write else compare(version)
    if faults:
        sys.exit("too many instructions:\n" + "\n".join(sorted(faults))
                 + "\nIf a count may be above the baseline, run `python3 benches/checks/instructions.py --write`.")


if __name__ == "__main__":
    main()
