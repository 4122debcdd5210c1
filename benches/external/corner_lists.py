"""A column for `sixfold study --external NAME='python3 corner_lists.py {mesh}'`.

Stores faces as lists of corners, and for each vertex the list of its faces. README.md in this folder
describes the protocol. This is an example of the protocol; it is not optimised.
"""

import json
import math
import sys
import time


class Mesh:
    def __init__(self, positions, faces):
        self.positions = positions
        self.faces = faces
        self.faces_of = [[] for _ in positions]
        for face, corners in enumerate(faces):
            for vertex in corners:
                self.faces_of[vertex].append(face)


def read(path):
    positions, faces = [], []
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            kind, *words = line.split() or [""]
            if kind == "v":
                positions.append(tuple(float(word) for word in words[:3]))
            elif kind == "f":
                faces.append([int(word.split("/")[0]) - 1 for word in words])
    return positions, faces


def field_sum(points):
    return sum(abs(x) + 2 * abs(y) + 3 * abs(z) for x, y, z in points)


def build(mesh):
    rebuilt = Mesh(mesh.positions, mesh.faces)
    return len(rebuilt.positions) + len(rebuilt.faces), len(rebuilt.faces)


def vertex_faces(mesh):
    return sum(1 for faces in mesh.faces_of for _ in faces), len(mesh.positions)


def face_vertices(mesh):
    return sum(1 for corners in mesh.faces for _ in corners), len(mesh.faces)


def circulate(mesh):
    count = vertex_faces(mesh)[0] + face_vertices(mesh)[0]
    return count, count


def face_barycenter(mesh):
    means = []
    for corners in mesh.faces:
        points = [mesh.positions[vertex] for vertex in corners]
        means.append(tuple(sum(axis) / len(points) for axis in zip(*points)))
    return field_sum(means), len(means)


def face_normal(points):
    ax, ay, az = points[0]
    nx = ny = nz = 0.0
    for (bx, by, bz), (cx, cy, cz) in zip(points[1:], points[2:]):
        ux, uy, uz = bx - ax, by - ay, bz - az
        vx, vy, vz = cx - ax, cy - ay, cz - az
        nx += uy * vz - uz * vy
        ny += uz * vx - ux * vz
        nz += ux * vy - uy * vx
    return nx, ny, nz


def vertex_normal(mesh):
    face_normals = [face_normal([mesh.positions[vertex] for vertex in corners]) for corners in mesh.faces]
    normals = []
    for faces in mesh.faces_of:
        total = [sum(face_normals[face][axis] for face in faces) for axis in range(3)]
        length = math.hypot(*total) or 1.0
        normals.append([part / length for part in total])
    return field_sum(normals), len(normals)


OPERATIONS = {
    run.__name__: run
    for run in (build, vertex_faces, face_vertices, circulate, face_barycenter, vertex_normal)
}


def respond(mesh, request):
    run = OPERATIONS.get(request["run"])
    if run is None:
        return {"refused": "this example does not support the operation"}
    wall, cpu = time.perf_counter_ns(), time.thread_time_ns()
    for _ in range(request["times"]):
        checksum, elements = run(mesh)
    wall, cpu = time.perf_counter_ns() - wall, time.thread_time_ns() - cpu
    return {"wall_ns": wall, "cpu_ns": cpu, "checksum": checksum, "elements": elements}


def main():
    mesh = Mesh(*read(sys.argv[1]))
    print(json.dumps({"protocol": 1, "holds": True, "library": "lists of Python"}), flush=True)
    for line in sys.stdin:
        print(json.dumps(respond(mesh, json.loads(line))), flush=True)


main()
