// Prints random requests, the same in every run: node random.mjs COUNT
// They go in order to one engine: about half of them name the mesh of an earlier request as "last".
const COUNT = Number(process.argv[2]);

// Returns a whole number from 0 to below `end` (the generator mulberry32).
let state = 6;
function below(end) {
  state = (state + 0x6d2b79f5) | 0;
  let mixed = Math.imul(state ^ (state >>> 15), 1 | state);
  mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
  return ((mixed ^ (mixed >>> 14)) >>> 0) % end;
}
const from = (first, last) => first + below(last - first + 1);
const pick = (list) => list[below(list.length)];
const chance = (percent) => below(100) < percent;
const times = (count, make) => Array.from({ length: count }, make);

// A third of the coordinates are not short.
const coordinate = () => (chance(33) ? from(-9999, 9999) / 7000 : from(-4, 4) / 2);
const position = () => times(3, coordinate);

// Each function of SHAPES, POLYGONS and FILES returns the field `mesh`, and roughly how many vertices and faces there are.
const grid = () => ({ m: from(3, 6), n: from(3, 5) });
const SHAPES = {
  tetrahedron: () => ({}),
  cube: () => ({}),
  octahedron: () => ({}),
  dodecahedron: () => ({}),
  icosahedron: () => ({}),
  prism: () => ({ n: from(3, 9) }),
  antiprism: () => ({ n: from(3, 9) }),
  grid,
  "triangle-grid": grid,
  "mixed-grid": grid,
  "grid-with-hole": grid,
  "hexagon-tiling": grid,
  torus: grid,
  "triangle-torus": grid,
  moebius: () => ({}),
  "uv-sphere": grid,
  geodesic: () => ({ frequency: from(1, 3) }),
  genus: () => ({ g: from(0, 1) }),
  "bezier-patch": () => ({}),
  blobs: () => ({ faces: 600 }),
  torsu: () => ({}),
};

function shape() {
  const name = pick(Object.keys(SHAPES));
  return { mesh: { shape: { name, parameters: SHAPES[name]() } }, vertices: 20, faces: 20 };
}

// Most faces are those of a strip of quadrilaterals or triangles; a few have random corners.
function strip() {
  const columns = from(2, 5);
  const positions = times(2 * columns + (chance(25) ? 1 : 0), position);
  const faces = [];
  for (let i = 0; i + 1 < columns; i += 1) {
    const [a, b, c, d] = [2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2];
    faces.push(...(chance(50) ? [[a, b, c, d]] : [[a, b, c], [a, c, d]]));
  }
  const corner = () => below(positions.length);
  // A face that names a vertex twice is an error of polygons, and is left out of a file.
  const corners = () => (chance(10) ? times(3, corner) : [...new Set(times(5, corner)), 0, 1, 2].slice(0, 3));
  const isFaulty = chance(40);
  if (isFaulty) faces.push(...times(from(1, 3), corners));
  if (isFaulty && chance(30)) faces.push([...pick(faces)].reverse());
  if (chance(30)) positions[corner()] = [...pick(positions)];
  return { positions, faces };
}

function polygons() {
  const { positions, faces } = strip();
  if (chance(20)) positions[below(positions.length)] = null;
  if (chance(20)) faces[below(faces.length)] = null;
  return { mesh: { polygons: { positions, faces } }, vertices: positions.length, faces: faces.length };
}

const lines = (list, begin = "", add = 0) => list.map((numbers) => `${begin}${numbers.map((n) => n + add).join(" ")}\n`).join("");
const counted = (faces) => faces.map((face) => [face.length, ...face]);
const FORMATS = {
  obj: ({ positions, faces }) =>
    lines(positions, "v ") + lines(faces, "f ", 1) + (chance(30) ? `t crease 2/1/0 ${faces[0][0]} ${faces[0][1]} 1.5\n` : ""),
  off: ({ positions, faces }) => `OFF\n${positions.length} ${faces.length} 0\n${lines(positions)}${lines(counted(faces))}`,
  ply: ({ positions, faces }) =>
    `ply\nformat ascii 1.0\nelement vertex ${positions.length}\nproperty float x\nproperty double y\nproperty float z\n` +
    `element face ${faces.length}\nproperty list uchar int vertex_indices\nend_header\n${lines(positions)}${lines(counted(faces))}`,
  stl: ({ positions, faces }) => {
    const facet = ([a, b, c]) => `facet normal 0 0 0\nouter loop\n${lines([a, b, c].map((v) => positions[v]), "vertex ")}endloop\nendfacet\n`;
    return `solid strip\n${faces.map(facet).join("")}endsolid strip\n`;
  },
  gltf: ({ positions, faces }) => {
    const numbers = Float32Array.from(positions.flat());
    const corners = Uint32Array.from(faces.flatMap((face) => face.slice(2).flatMap((c, i) => [face[0], face[i + 1], c])));
    const bytes = Buffer.concat([Buffer.from(numbers.buffer), Buffer.from(corners.buffer)]);
    const of = (axis, compare) => compare(...positions.map((position) => Math.fround(position[axis])));
    const [min, max] = [Math.min, Math.max].map((compare) => [0, 1, 2].map((axis) => of(axis, compare)));
    return JSON.stringify({
      asset: { version: "2.0" },
      scene: 0,
      scenes: [{ nodes: [0] }],
      nodes: [{ mesh: 0, scale: [2, 1, 1], rotation: [0, 0, 0.6, 0.8] }],
      meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
      accessors: [
        { bufferView: 0, componentType: 5126, count: positions.length, type: "VEC3", min, max },
        { bufferView: 1, componentType: 5125, count: corners.length, type: "SCALAR" },
      ],
      bufferViews: [
        { buffer: 0, byteLength: numbers.byteLength },
        { buffer: 0, byteOffset: numbers.byteLength, byteLength: corners.byteLength },
      ],
      buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString("base64")}` }],
    });
  },
};

function file() {
  const surface = strip();
  const format = pick(Object.keys(FORMATS));
  let text = FORMATS[format](surface);
  if (chance(15)) text = text.slice(0, below(text.length));
  const name = `strip.${format}`;
  const content = chance(50) ? { name, text } : { name, base64: Buffer.from(text).toString("base64") };
  return { mesh: { file: content }, vertices: surface.positions.length, faces: surface.faces.length };
}

// The names can be those of elements that do not exist. Most edges are those of the strip and of the first face.
const v = ({ vertices }) => `v${below(chance(10) ? vertices + 1 : 6)}`;
const f = ({ faces }) => `f${below(chance(10) ? faces + 1 : 3)}`;
const e = (mesh) => {
  const a = below(chance(20) ? mesh.vertices : 5);
  return `v${a}-v${chance(80) ? a + from(1, 2) : below(mesh.vertices)}`;
};
const at = () => (chance(40) ? ` ${position().join(",")}` : "");
const EDITS = [
  (mesh) => `set_position ${v(mesh)} ${position().join(",")}`,
  () => `add_vertex ${position().join(",")}`,
  (mesh) => `add_face ${times(from(3, 4), () => v(mesh)).join(" ")}`,
  (mesh) => `remove_face ${f(mesh)}`,
  (mesh) => `remove_vertex ${v(mesh)}`,
  () => "remove_isolated_vertices",
  (mesh) => `split_edge ${e(mesh)}${at()}`,
  (mesh) => `bisect_edge ${e(mesh)}${at()}`,
  (mesh) => `poke_face ${f(mesh)}${at()}`,
  (mesh) => `split_face ${f(mesh)} ${v(mesh)} ${v(mesh)}`,
  (mesh) => `dissolve_edge ${e(mesh)}`,
  (mesh) => `flip_edge ${e(mesh)}`,
  (mesh) => {
    const edge = e(mesh);
    return `collapse_edge ${edge} ${edge.split("-")[0]}${at()}`;
  },
  (mesh) => `split_vertex ${v(mesh)} ${v(mesh)} ${chance(30) ? "none" : v(mesh)}`,
  () => "compact",
];
const BAD_EDIT = "flip v0";
const edit = (mesh) => pick(EDITS)(mesh);

const query = (mesh) => {
  const [kind, element] = pick([["vertex", v(mesh)], ["edge", e(mesh)], ["face", f(mesh)]]);
  return { relation: `${kind}_${pick(["vertices", "edges", "faces"])}`, element };
};
const WALKS = [
  (mesh) => `h = leaving(${v(mesh)}); repeat { yield target(h); h = next(twin(h)) }`,
  (mesh) => `h = half_edge(${f(mesh)}); repeat { yield origin(h); h = next(h) }`,
  (mesh) => `e = edge(${v(mesh)}); yield e`,
  () => `c = c${below(12)}; yield vertex(c); yield face(c)`,
];
const rowName = () => `${pick(["v", "h", "c", "e", "f", "s"])}${below(40)}`;
const SCHEMES = ["catmull-clark", "loop", "sqrt3", "butterfly", "doo-sabin", "midpoint", "bilinear"];

// Questions about a mesh after edits, and about one without.
const EDITED = {
  tables: () => ({ tables: pick([{}, { rows: [below(5), from(4, 30)] }, { names: times(from(1, 9), rowName) }]) }),
  trace: (mesh) => ({ trace: query(mesh) }),
  edit: (mesh) => ({ edit: chance(3) ? BAD_EDIT : edit(mesh) }),
  walk: (mesh) => ({ walk: { walk: pick(WALKS)(mesh), ...(chance(50) ? { expect: query(mesh) } : {}) } }),
  geometry: () => "geometry",
};
const UNEDITED = {
  facts: () => "facts",
  verdicts: () => "verdicts",
  repair: () => "repair",
  sweep: (mesh) => ({ sweep: { relation: query(mesh).relation, queries: below(100) } }),
  subdivide: () => ({ subdivide: { scheme: pick(SCHEMES), levels: from(0, 2) } }),
  stencil: () => ({ stencil: { scheme: pick(SCHEMES), level: 1, point: below(40) } }),
};
const STRUCTURES = ["polygon-soup", "indexed-face-set", "face-vertex", "winged-edge", "half-edge", "corner-table"];

let mesh = null;
let edits = [];
let asked = null;
for (let number = 0; number < COUNT; number += 1) {
  const request = {};
  if (mesh === null || chance(25)) {
    mesh = pick([shape, shape, polygons, file])();
    edits = [];
    request.mesh = mesh.mesh;
    if (chance(50)) request.triangulate = true;
    if (chance(10)) request.creases = `edge 0 1 ${pick(["inf", "1.5"])}\n`;
  } else {
    request.mesh = chance(70) ? "last" : mesh.mesh;
    // Accepts the edit of the request before, adds an edit, or takes some back.
    if (asked?.edit && chance(60)) edits.push(asked.edit);
    else if (chance(30)) edits.push(edit(mesh));
    else if (chance(20)) edits = edits.slice(0, below(edits.length + 1));
  }
  const questions = chance(25) ? UNEDITED : EDITED;
  if (questions === EDITED || chance(5)) request.edits = [...edits];
  if (chance(20)) request.structures = STRUCTURES.filter(() => chance(50));
  asked = pick(Object.values(questions))(mesh);
  request.ask = asked;
  // An edit that cannot be read would make errors of all later requests.
  if (asked.edit === BAD_EDIT) asked = null;
  console.log(JSON.stringify(request));
}
