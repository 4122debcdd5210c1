#!/usr/bin/env python3
"""Checks that the work of reading a file grows in proportion to the file.

Usage: reading_growth.py [--reading PROGRAM]

Before this script, run `cargo build -p sixfold-io --example reading`. Needs valgrind.

The script writes files with many items of one kind, and then the same with four times as many. It counts the
instructions of reading both under callgrind, so the result depends neither on the speed of the machine nor on
other programs. Four times as many items need about 4 times the instructions. If each item is compared with all
others, they need 16 times the instructions. The exit code is 1 if a ratio is above 6.
"""

import argparse
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SMALL, FACTOR, LIMIT = 5_000, 4, 6.0

TRIANGLE = ("element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\n")
ROWS = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"


def ply(header):
    return f"ply\nformat ascii 1.0\n{TRIANGLE}{header}end_header\n{ROWS}".encode()


def properties(count):
    return "element other 0\n" + "".join(f"property uchar p{i}\n" for i in range(count))


def elements(count):
    return "".join(f"element e{i} 0\nproperty uchar p\n" for i in range(count))


def glb(count=1, **members):
    """Returns a file with `count` accessors, all of the same three vertices."""
    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    document = {
        "asset": {"version": "2.0"},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}] * count,
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(data)}],
        "buffers": [{"byteLength": len(data)}],
        **members,
    }
    text = json.dumps(document).encode()
    chunks = [(b"JSON", text + b" " * (-len(text) % 4)), (b"BIN\0", data)]
    body = b"".join(struct.pack("<I", len(chunk)) + kind + chunk for kind, chunk in chunks)
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def extensions(count):
    mesh = {"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}
    return glb(extensionsRequired=["KHR_materials_unlit"] * count, meshes=[mesh] * count)


def primitives(count):
    return glb(count, meshes=[{"primitives": [{"attributes": {"POSITION": i}, "mode": 0} for i in range(count)]}])


def copies(count):
    """Every node repeats a mesh of primitives without vertices. The reader refuses such a file."""
    return glb(meshes=[{"primitives": [{"attributes": {}}] * count}], nodes=[{"mesh": 0}] * count)


# The ending of the file, the function that makes it, and whether it is read.
FILES = {
    "PLY properties": ("ply", lambda count: ply(properties(count)), True),
    "PLY elements": ("ply", lambda count: ply(elements(count)), True),
    "PLY elements after properties": ("ply", lambda count: ply(properties(count) + elements(count)), True),
    "glTF extensions and meshes": ("glb", extensions, True),
    "glTF primitives": ("glb", primitives, True),
    "glTF copies of empty primitives": ("glb", copies, False),
}


def instructions(reading, file, is_read):
    """Returns the number of instructions that reading `file` executes."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", reading, file]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if (done.returncode == 0) != is_read:
        sys.exit(f"{file}: exit code {done.returncode}: {done.stderr[-400:]}")
    return int(re.search(r"Collected *: *(\d+)", done.stderr)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--reading", type=pathlib.Path, default=ROOT / "target/debug/examples/reading")
    reading = parser.parse_args().reading
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        # The start of the program is not part of the growth.
        empty = pathlib.Path(folder) / "one.ply"
        empty.write_bytes(ply(""))
        start = instructions(reading, empty, True)
        for name, (ending, make, is_read) in FILES.items():
            counts = []
            for count in (SMALL, FACTOR * SMALL):
                file = pathlib.Path(folder) / f"{count}.{ending}"
                file.write_bytes(make(count))
                counts.append(instructions(reading, file, is_read) - start)
            ratio = counts[1] / counts[0]
            print(f"{name}: {counts[0]:,} and {counts[1]:,} instructions, {ratio:.2f} times")
            if ratio > LIMIT:
                faults.append(name)
    if faults:
        sys.exit(f"more than {LIMIT} times the instructions for {FACTOR} times the items: {', '.join(faults)}")


if __name__ == "__main__":
    main()
