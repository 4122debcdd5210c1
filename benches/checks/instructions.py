#!/usr/bin/env python3
"""Compares the instruction counts of the operations with the committed baseline.

Usage: instructions.py [--write] [--profile NAME] [--against FILE]

Builds and runs the benchmarks of `benches/instructions.rs` under callgrind in a few minutes; needs valgrind and
gungraun-runner. The exit code is 1 if a count is more than 0.5 % above the baseline, or a benchmark has none.
`--write` replaces the baseline. `--profile` builds with another profile of Cargo.toml, and `--against FILE` prints the
ratio of each count to that of another file written by `--write-to`.

Counts depend on the compiler: with another rustc than that of the baseline they are printed and not compared. The C
library chooses its copying functions by processor; the script makes it choose those that every x86-64 processor has.
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
# The largest count, relative to the baseline.
LIMIT = 1.005
PLAIN_FUNCTIONS = "glibc.cpu.hwcaps=-AVX_Fast_Unaligned_Load,-AVX2,-AVX512F,-AVX512VL,-ERMS,-FSRM"

# Rust's default release profile, which programs that depend on Sixfold use.
DEFAULT_PROFILE = {"CARGO_PROFILE_RELEASE_LTO": "false", "CARGO_PROFILE_RELEASE_CODEGEN_UNITS": "16"}


def counted(profile):
    """Runs the benchmarks; returns the instructions of each line of `instructions.txt`."""
    command = ["cargo", "bench", "-p", "sixfold-benches", "--bench", "instructions", "--locked", "--profile", profile,
               "--", "--output-format=json"]
    environment = {**os.environ, "GLIBC_TUNABLES": PLAIN_FUNCTIONS, **(DEFAULT_PROFILE if profile == "release" else {})}
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, env=environment)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stderr[-4000:]}")
    counts = {}
    lines = LINES.read_text().split("\n")
    for text in done.stdout.splitlines():
        if text.startswith("{"):
            summary = json.loads(text)
            number = int(summary["id"].rsplit("_", 1)[1])
            counts[lines[number]] = instructions(summary)
    return counts


def instructions(summary):
    """Returns the number of executed instructions of one benchmark."""
    (callgrind,) = [profile for profile in summary["profiles"] if profile["tool"].lower() == "callgrind"]
    return new_count(callgrind["data"]["total"]["metrics"]["Ir"])


def new_count(value):
    """Returns the count of this run; a value may also have that of the run before."""
    if isinstance(value, dict):
        inner = next((value[key] for key in ("new", "New", "both", "Both") if key in value), None)
        return new_count(next(iter(value.values())) if inner is None else inner)
    return new_count(value[0]) if isinstance(value, list) else value


def compiler():
    return subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True).stdout.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--write", action="store_true", help="replace the baseline")
    parser.add_argument("--write-to", type=pathlib.Path, help="also write the counts to this file")
    parser.add_argument("--profile", default="release")
    parser.add_argument("--against", type=pathlib.Path, help="print the ratio of each count to this file")
    chosen = parser.parse_args()
    counts = counted(chosen.profile)
    document = {"rustc": compiler(), "profile": chosen.profile, "instructions": counts}
    for path in [BASELINE] * chosen.write + [chosen.write_to] * bool(chosen.write_to):
        path.write_text(json.dumps(document, indent=1) + "\n")
    if chosen.against:
        other = json.loads(chosen.against.read_text())["instructions"]
        ratios = {name: count / other[name] for name, count in counts.items() if name in other}
        for name, ratio in sorted(ratios.items(), key=lambda item: -item[1]):
            print(f"{ratio:6.3f}  {counts[name]:>12,}  {name}")
        mean = math.exp(sum(map(math.log, ratios.values())) / len(ratios))
        print(f"geometric mean {mean:.3f} over {len(ratios)} operations, largest {max(ratios.values()):.3f}")
        return
    if chosen.write or chosen.write_to:
        return
    baseline = json.loads(BASELINE.read_text())
    if baseline["rustc"] != document["rustc"]:
        print(f"not compared: the baseline is of {baseline['rustc']}, this is {document['rustc']}")
        return
    known = baseline["instructions"]
    faults = [f"{name}: {count:,}, without a baseline" for name, count in counts.items() if name not in known]
    faults += [f"{name}: {counts[name]:,} instructions, {100 * (counts[name] / known[name] - 1):.2f} % more than {known[name]:,}"
               for name in counts.keys() & known.keys() if counts[name] > LIMIT * known[name]]
    if faults:
        sys.exit("more instructions than the baseline:\n" + "\n".join(sorted(faults))
                 + "\nIf this is intended, run `python3 benches/checks/instructions.py --write`.")
    print(f"{len(counts)} operations, each at most {100 * (LIMIT - 1):.1f} % above the baseline")


if __name__ == "__main__":
    main()
