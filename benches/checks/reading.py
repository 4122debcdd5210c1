#!/usr/bin/env python3
"""Compares the time and memory of reading large mesh files with trimesh, libigl and MeshLab.

Usage: reading.py [--rounds 7] [--frequency 707] [--folder DIR] [--json FILE]

Before this script, run `cargo build --release -p sixfold-cli -p sixfold-io --bin sixfold --example reading`
and `pip install trimesh libigl pymeshlab`.

The script writes a geodesic sphere of 20 * frequency^2 triangles as binary PLY, binary STL and OBJ. In each
round, every reader reads each file in a process of its own, in turn. The time is that of the call that reads the
file into arrays of vertices and faces, without the start of the process; the memory is the largest resident
memory during the call minus that before it. `sixfold inspect` also computes the facts and faults of the OBJ
file, and its figures are those of the whole process. The table has medians over the rounds, and the median of the
ratios to Sixfold within each round.
"""

import argparse
import importlib.metadata
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILT = ROOT / "target" / "release"

# Reads the file named by the first argument and prints seconds, bytes and numbers of elements.
PROBE = r"""
import json, sys, time
{imports}
def memory(field):
    for line in open("/proc/self/status"):
        if line.startswith(field):
            return int(line.split()[1]) * 1024
open("/proc/self/clear_refs", "w").write("5")
before = memory("VmRSS:")
start = time.perf_counter()
{read}
seconds = time.perf_counter() - start
print(json.dumps([seconds, memory("VmHWM:") - before, int(vertices), int(faces)]))
"""

# `process=False` keeps trimesh from merging vertices, except in STL, where the others weld as well or not at all.
LIBRARIES = {
    "trimesh": ("import trimesh",
                "mesh = trimesh.load(sys.argv[1], process=False)\n"
                "vertices, faces = len(mesh.vertices), len(mesh.faces)"),
    "libigl": ("import igl",
               "v, f = igl.read_triangle_mesh(sys.argv[1])[:2]\n"
               "vertices, faces = len(v), len(f)"),
    "pymeshlab": ("import pymeshlab",
                  "meshes = pymeshlab.MeshSet()\nmeshes.load_new_mesh(sys.argv[1])\n"
                  "mesh = meshes.current_mesh()\n"
                  "vertices, faces = mesh.vertex_number(), mesh.face_number()"),
}
COLUMNS = {
    "ply": ["sixfold", "trimesh", "libigl", "pymeshlab"],
    "stl": ["sixfold", "trimesh", "libigl", "pymeshlab"],
    "obj": ["sixfold", "pymeshlab", "sixfold inspect"],
}


def output(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))[:200]}: {done.stderr.strip()[-400:]}")
    return done.stdout


def read_with(reader, file):
    """Returns seconds, bytes, vertices and faces."""
    if reader == "sixfold":
        return json.loads(output([BUILT / "examples" / "reading", "--json", file]))
    if reader == "sixfold inspect":
        # The numbers of elements are in the document, and the process is measured from outside.
        with tempfile.TemporaryDirectory() as folder:
            document = pathlib.Path(folder) / "facts.json"
            timed = output([sys.executable, "-c", INSPECT, BUILT / "sixfold", file, document])
            facts = json.loads(document.read_text())["facts"]
        return [*json.loads(timed), facts["vertices"], facts["faces"]]
    imports, read = LIBRARIES[reader]
    return json.loads(output([sys.executable, "-c", PROBE.format(imports=imports, read=read), file]).splitlines()[-1])


INSPECT = r"""
import json, resource, subprocess, sys, time
start = time.perf_counter()
subprocess.run([sys.argv[1], "inspect", sys.argv[2], "--json", sys.argv[3]], check=True, stdout=subprocess.DEVNULL)
seconds = time.perf_counter() - start
print(json.dumps([seconds, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024]))
"""


def version(reader):
    return "" if reader.startswith("sixfold") else importlib.metadata.version(reader)


def measure(folder, frequency, rounds):
    files = {}
    for ending in COLUMNS:
        files[ending] = folder / f"ball.{ending}"
        if not files[ending].exists():
            output([BUILT / "sixfold", "generate", "geodesic", f"frequency={frequency}", "-o", files[ending]])
    samples = {(ending, reader): [] for ending, readers in COLUMNS.items() for reader in readers}
    for number in range(rounds):
        for ending, readers in COLUMNS.items():
            # Each reader is the first in some round.
            shift = number % len(readers)
            for reader in readers[shift:] + readers[:shift]:
                samples[ending, reader].append(read_with(reader, files[ending]))
                print(f"round {number + 1}: {ending} {reader}: {samples[ending, reader][-1]}", file=sys.stderr)
    rows = []
    for (ending, reader), taken in samples.items():
        own = samples[ending, "sixfold"]
        seconds, memory = ([sample[i] for sample in taken] for i in (0, 1))
        rows.append({
            "file": ending,
            "bytes": files[ending].stat().st_size,
            "reader": reader,
            "version": version(reader),
            "vertices": taken[0][2],
            "faces": taken[0][3],
            "seconds": statistics.median(seconds),
            "seconds_range": [min(seconds), max(seconds)],
            "memory": statistics.median(memory),
            "to_sixfold": statistics.median(sample[0] / mine[0] for sample, mine in zip(taken, own)),
        })
    return rows


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def table(rows):
    lines = ["| file | reader | seconds | least to most | MB/s | memory, MB | time relative to Sixfold |",
             "|---|---|--:|--:|--:|--:|--:|"]
    for row in rows:
        low, high = row["seconds_range"]
        lines.append(f"| {row['file']} | {row['reader']} {row['version']} | {row['seconds']:.2f} | "
                     f"{low:.2f} to {high:.2f} | {row['bytes'] / 1e6 / row['seconds']:.0f} | "
                     f"{row['memory'] / 1e6:.0f} | {row['to_sixfold']:.2f} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--frequency", type=int, default=707)
    parser.add_argument("--folder", type=pathlib.Path, help="where the meshes are kept; a new one by default")
    parser.add_argument("--json", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.folder or pathlib.Path(temporary)
        rows = measure(folder, arguments.frequency, arguments.rounds)
    print(table(rows))
    if arguments.json:
        document = {"processor": processor(), "cores": os.cpu_count(), "rounds": arguments.rounds,
                    "frequency": arguments.frequency, "rows": rows}
        arguments.json.write_text(json.dumps(document, indent=1) + "\n")


if __name__ == "__main__":
    main()
