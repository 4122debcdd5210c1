// The mesh as the page draws it: positions, faces and edges by the numbers of their names.

// The valences of regular vertices inside and at a boundary, by the corners of the faces.
const REGULAR = { 3: [6, 4], 4: [4, 3] };

// A mesh with its edges, its bounds and the triangles that cover its faces. `geometry` is that of the engine:
// an element that was deleted is null.
export class Model {
  constructor(geometry) {
    this.vertices = geometry.vertices;
    this.faces = geometry.faces;
    this.vertexCount = this.vertices.reduce((count, vertex) => count + (vertex ? 1 : 0), 0);
    this.faceCount = this.faces.reduce((count, face) => count + (face ? 1 : 0), 0);
    this.edges = new Edges(this.faces);
    // The places of faces that were asked for.
    this.facePlaces = new Map();
    this.measure();
    this.cover();
  }

  // For each vertex its edges, and whether it is at a boundary: { valence, isBoundary, isIrregular }; null without a vertex.
  // A vertex is regular if it is one of a plane that is tiled by the polygons of the mesh. Without such a tiling, none is
  // irregular. Computed once.
  get valences() {
    if (this.counted) return this.counted;
    this.counted = this.vertices.map((vertex) => vertex && { valence: 0, isBoundary: false });
    for (const { ends, faces } of this.edges.values()) {
      for (const v of ends) {
        this.counted[v].valence += 1;
        if (faces.length === 1) this.counted[v].isBoundary = true;
      }
    }
    const degrees = new Set(this.faces.filter((face) => face).map((face) => face.length));
    const [inside, atBoundary] = (degrees.size === 1 && REGULAR[[...degrees][0]]) || [];
    for (const one of this.counted) {
      const regular = one?.isBoundary ? atBoundary : inside;
      if (one) one.isIrregular = regular !== undefined && one.valence > 0 && one.valence !== regular;
    }
    return this.counted;
  }

  // The closed chains of edges with one face, as lists of names. At a vertex where chains touch, one of them goes on.
  // Faces need not agree on a side.
  boundaryLoops() {
    const at = new Map();
    const add = (v, edge) => at.set(v, [...at.get(v) ?? [], edge]);
    for (const edge of this.edges.values()) if (edge.faces.length === 1) for (const v of edge.ends) add(v, edge);
    const used = new Set();
    const next = (v) => at.get(v).find((edge) => !used.has(edge));
    const loops = [];
    for (const start of at.keys()) {
      while (next(start)) {
        const loop = [];
        for (let v = start, edge = next(v); edge; edge = next(v)) {
          used.add(edge);
          loop.push(edge.name);
          v = edge.ends[0] === v ? edge.ends[1] : edge.ends[0];
          if (v === start) break;
        }
        loops.push(loop);
      }
    }
    return loops;
  }

  // The centre and the radius of the mesh.
  measure() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (const vertex of this.vertices) {
      if (!vertex) continue;
      for (let axis = 0; axis < 3; axis += 1) {
        low[axis] = Math.min(low[axis], vertex[axis]);
        high[axis] = Math.max(high[axis], vertex[axis]);
      }
    }
    this.centre = this.vertexCount ? mix(low, high, 0.5) : [0, 0, 0];
    const [x, y, z] = this.centre;
    let most = 0;
    for (const vertex of this.vertices) {
      if (vertex) most = Math.max(most, (vertex[0] - x) ** 2 + (vertex[1] - y) ** 2 + (vertex[2] - z) ** 2);
    }
    // A little room for the names.
    this.radius = 1.06 * Math.sqrt(most) || 1;
  }

  // Cuts the faces into triangles: three numbers of vertices and one of a face for each.
  cover() {
    const triangles = [];
    this.faces.forEach((face, f) => {
      if (!face) return;
      if (face.length === 3) triangles.push(face[0], face[1], face[2], f);
      else for (const [a, b, c] of cut(face.map((v) => this.vertices[v]))) triangles.push(face[a], face[b], face[c], f);
    });
    this.triangles = Uint32Array.from(triangles);
  }

  // Whether the mesh has the element.
  has(name) {
    return this.nameOf(name) !== null;
  }

  // The name of an element as this page writes it, the lower number of an edge first. Null if there is none.
  nameOf(name) {
    if (!this.place(name)) return null;
    const { kind, numbers: [a, b] } = parseName(name);
    return kind === "edge" ? edgeName(a, b) : `${kind[0]}${a}`;
  }

  // Where an element is: { kind, points, at }: the points of its outline and its centre. Null if there is none.
  place(name) {
    const parsed = parseName(name);
    if (!parsed) return null;
    const [a, b] = parsed.numbers;
    if (parsed.kind === "vertex") {
      const at = this.vertices[a];
      return at ? { kind: "vertex", points: [at], at } : null;
    }
    if (parsed.kind === "edge") {
      if (this.edges.find(a, b) < 0) return null;
      const points = [this.vertices[a], this.vertices[b]];
      return { kind: "edge", points, at: mix(...points, 0.5) };
    }
    const face = this.faces[a];
    if (!face) return null;
    if (!this.facePlaces.has(a)) {
      const points = face.map((v) => this.vertices[v]);
      this.facePlaces.set(a, { kind: "face", points, at: average(points) });
    }
    return this.facePlaces.get(a);
  }

  // Whether no face is between a point of the mesh and an eye. The faces at the point are not between.
  isFree(point, eye) {
    const way = minus(eye, point);
    const { triangles, vertices } = this;
    for (let i = 0; i < triangles.length; i += 4) {
      const a = vertices[triangles[i]];
      const hit = meeting(point, way, a, minus(vertices[triangles[i + 1]], a), minus(vertices[triangles[i + 2]], a));
      if (hit && hit.t > 2e-3 && hit.t < 1) return false;
    }
    return true;
  }

  // The sum of the unit normals of the triangles at a point of the mesh.
  normalAt(point) {
    const { triangles, vertices } = this;
    let sum = [0, 0, 0];
    for (let i = 0; i < triangles.length; i += 4) {
      const [a, b, c] = [vertices[triangles[i]], vertices[triangles[i + 1]], vertices[triangles[i + 2]]];
      const normal = unit(cross(minus(b, a), minus(c, a)));
      const hit = meeting(point, normal, a, minus(b, a), minus(c, a));
      if (hit && Math.abs(hit.t) < 1e-3 * this.radius) sum = plus(sum, normal);
    }
    return sum;
  }

  // The corner of a face at a vertex, moved a little into the face.
  corner(face, vertex) {
    const at = this.vertices[vertex];
    const place = this.place(`f${face}`);
    if (!at || !place) return null;
    const inside = mix(at, place.at, 0.25);
    return { kind: "corner", points: [inside], at: inside };
  }

  // The side of an edge as a face runs along it from a vertex, moved a little into the face.
  side(face, from) {
    const corners = this.faces[face];
    const i = corners ? corners.indexOf(from) : -1;
    if (i < 0) return null;
    return this.arrow(from, corners[(i + 1) % corners.length], this.place(`f${face}`).at);
  }

  // An arrow from one vertex to another, moved towards a point.
  arrow(from, to, towards) {
    const [a, b] = [this.vertices[from], this.vertices[to]];
    if (!a || !b) return null;
    const points = [mix(a, b, 0.12), mix(a, b, 0.88)].map((point) => mix(point, towards, 0.1));
    return { kind: "side", points, at: mix(...points, 0.5) };
  }
}

// The edges of faces, in the order in which the faces have them: like a Map from the name of an edge, the lower number
// first, to { name, ends, faces }. The numbers are in arrays, because a large mesh has hundreds of thousands of edges.
class Edges {
  constructor(faces) {
    const sides = faces.reduce((count, face) => count + (face?.length ?? 0), 0);
    let slots = 16;
    while (slots < 2 * sides) slots *= 2;
    // The number of an edge and 1 at a place that follows from its ends, or at the next free one (linear probing).
    this.table = new Int32Array(slots);
    // Two ends of each edge.
    this.ends = new Uint32Array(2 * sides);
    this.size = 0;
    // The face of each side, and a chain of the sides of each edge: the last one, and the one before each. -1 ends it.
    this.face = new Uint32Array(sides);
    this.last = new Int32Array(sides).fill(-1);
    this.before = new Int32Array(sides);
    let side = 0;
    faces.forEach((face, f) => {
      if (!face) return;
      for (let i = 0; i < face.length; i += 1) {
        const edge = this.add(face[i], face[i + 1 < face.length ? i + 1 : 0]);
        this.face[side] = f;
        this.before[side] = this.last[edge];
        this.last[edge] = side;
        side += 1;
      }
    });
  }

  // The place of an edge in the table, or the free place where it belongs.
  slot(low, high) {
    const mask = this.table.length - 1;
    let slot = Math.imul(Math.imul(low, 0x9e3779b1) ^ high, 0x85ebca6b);
    slot = (slot ^ (slot >>> 15)) & mask;
    for (;;) {
      const edge = this.table[slot] - 1;
      if (edge < 0 || (this.ends[2 * edge] === low && this.ends[2 * edge + 1] === high)) return slot;
      slot = (slot + 1) & mask;
    }
  }

  add(a, b) {
    const [low, high] = a < b ? [a, b] : [b, a];
    const slot = this.slot(low, high);
    if (this.table[slot] === 0) {
      this.ends[2 * this.size] = low;
      this.ends[2 * this.size + 1] = high;
      this.size += 1;
      this.table[slot] = this.size;
    }
    return this.table[slot] - 1;
  }

  // The number of the edge between two vertices, or -1.
  find(a, b) {
    return this.table[this.slot(Math.min(a, b), Math.max(a, b))] - 1;
  }

  // The name of the first edge whose ends, the lower one first, meet a condition. Null if there is none.
  nameWhere(isWanted) {
    for (let edge = 0; edge < this.size; edge += 1) {
      if (isWanted(this.ends[2 * edge], this.ends[2 * edge + 1])) return this.name(edge);
    }
    return null;
  }

  // The names of the edges that another mesh does not have.
  missingIn(other) {
    const names = [];
    for (let edge = 0; edge < this.size; edge += 1) {
      if (other.find(this.ends[2 * edge], this.ends[2 * edge + 1]) < 0) names.push(this.name(edge));
    }
    return names;
  }

  name(edge) {
    return `v${this.ends[2 * edge]}-v${this.ends[2 * edge + 1]}`;
  }

  at(edge) {
    const faces = [];
    for (let side = this.last[edge]; side >= 0; side = this.before[side]) faces.push(this.face[side]);
    return { name: this.name(edge), ends: [this.ends[2 * edge], this.ends[2 * edge + 1]], faces: faces.reverse() };
  }

  number(name) {
    const parsed = parseName(name);
    return parsed?.kind === "edge" ? this.find(...parsed.numbers) : -1;
  }

  has(name) {
    return this.number(name) >= 0;
  }

  get(name) {
    const edge = this.number(name);
    return edge < 0 ? undefined : this.at(edge);
  }

  * keys() {
    for (let edge = 0; edge < this.size; edge += 1) yield this.name(edge);
  }

  // All edges as objects, which are made when they are asked for first.
  values() {
    this.list ??= Array.from({ length: this.size }, (_, edge) => this.at(edge));
    return this.list.values();
  }
}

export function edgeName(a, b) {
  return a < b ? `v${a}-v${b}` : `v${b}-v${a}`;
}

// Reads v3, v0-v1 or f2, also in a longer name such as e4 = v0-v1. Null if the text is not the name of an element.
export function parseName(text) {
  const name = text.split(" = ").pop().trim();
  const edge = /^v(\d{1,9})-v(\d{1,9})$/.exec(name);
  if (edge) return { kind: "edge", numbers: [Number(edge[1]), Number(edge[2])] };
  const one = /^([vf])(\d{1,9})$/.exec(name);
  return one && { kind: one[1] === "v" ? "vertex" : "face", numbers: [Number(one[2])] };
}

// Cuts a polygon into triangles that do not overlap, if it has no hole and does not cross itself: ears are cut off
// (Meisters, 1975). O(n²), so a polygon of many corners becomes a fan.
function cut(points) {
  const n = points.length;
  if (n === 3) return [[0, 1, 2]];
  if (n > 64) return Array.from({ length: n - 2 }, (_, i) => [0, i + 1, i + 2]);
  const normal = areaOf(points);
  const rest = points.map((_, i) => i);
  const triangles = [];
  while (rest.length > 3) {
    const isEar = (i) => {
      const [a, b, c] = [rest.at(i - 1), rest[i], rest[(i + 1) % rest.length]];
      const [p, q, r] = [points[a], points[b], points[c]];
      if (dot(cross(minus(q, p), minus(r, q)), normal) <= 0) return false;
      const isInside = (s) => [[p, q], [q, r], [r, p]].every(([from, to]) =>
        dot(cross(minus(to, from), minus(points[s], from)), normal) >= 0);
      return !rest.some((s) => s !== a && s !== b && s !== c && isInside(s));
    };
    const found = rest.findIndex((_, i) => isEar(i));
    const ear = Math.max(found, 0);
    triangles.push([rest.at(ear - 1), rest[ear], rest[(ear + 1) % rest.length]]);
    rest.splice(ear, 1);
  }
  return [...triangles, rest];
}

// Where a line meets the triangle at `a` with two sides: { t } along the line, or null (Möller and Trumbore, 1997).
// The border of the triangle belongs to it.
function meeting(point, way, a, ab, ac) {
  const across = cross(way, ac);
  const volume = dot(ab, across);
  if (Math.abs(volume) < 1e-12) return null;
  const from = minus(point, a);
  const u = dot(from, across) / volume;
  const aside = cross(from, ab);
  const v = dot(way, aside) / volume;
  if (u < -1e-6 || v < -1e-6 || u + v > 1 + 1e-6) return null;
  return { t: dot(ac, aside) / volume };
}

// The vector of a polygon's area (Newell): normal to it.
export function areaOf(points) {
  const [x, y, z] = points[0] ?? [0, 0, 0];
  const sum = [0, 0, 0];
  for (let i = 1; i + 1 < points.length; i += 1) {
    const [p, q] = [points[i], points[i + 1]];
    const [ax, ay, az, bx, by, bz] = [p[0] - x, p[1] - y, p[2] - z, q[0] - x, q[1] - y, q[2] - z];
    sum[0] += ay * bz - az * by;
    sum[1] += az * bx - ax * bz;
    sum[2] += ax * by - ay * bx;
  }
  return sum;
}

export const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => scale(a, 1 / (Math.hypot(...a) || 1));
export const length = (a) => Math.hypot(...a);
export const mix = (a, b, t) => [0, 1, 2].map((axis) => a[axis] * (1 - t) + b[axis] * t);
export const average = (points) => scale(points.reduce(plus, [0, 0, 0]), 1 / points.length);
