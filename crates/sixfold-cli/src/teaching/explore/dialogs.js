// The dialogs: choosing a mesh, sharing what is shown, and help.

import { button, download, el, find } from "./dom.js";
import { defaultView, fromText, meshOfFile, meshState, toLink, toText } from "./state.js";

// Larger files are not read: the mesh would not fit.
const MOST_BYTES = 100e6;

// Counts of a shape are small at first, so that its tables can be read.
const SMALL = 6;

// The shapes in groups; those that are in none are listed at the end.
const GROUPS = [
  ["Solids", ["tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron", "prism", "antiprism"]],
  ["Grids", ["grid", "triangle-grid", "mixed-grid", "grid-with-hole", "grid-with-holes"]],
  ["Tilings", ["triangle-tiling", "hexagon-tiling"]],
  ["Tori, spheres and a strip", ["torus", "triangle-torus", "genus", "uv-sphere", "geodesic", "moebius"]],
  ["Curved patches", ["bezier-patch", "b-spline-patch"]],
];

// Small meshes that some structures cannot hold.
const FAULTS = [
  ["three faces at an edge", [[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0]], [[0, 1, 2], [1, 0, 3], [1, 0, 4]]],
  ["two fans at a vertex", [[0, 0, 0], [1, 1, 0], [-1, 1, 0], [1, -1, 0], [-1, -1, 0]], [[0, 1, 2], [0, 4, 3]]],
  ["two faces that disagree on a side", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, -1, 0]], [[0, 1, 2], [0, 1, 3]]],
  ["a vertex without a face", [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2]]],
  ["a face twice", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 2], [0, 2, 3]]],
];

export function openDialog(title, content) {
  find("dialog-title").textContent = title;
  find("dialog-body").replaceChildren(...content);
  find("dialog").showModal();
}

const close = () => find("dialog").close();

// Opens a mesh, or a state that was saved.
export async function openFile(explorer, file) {
  if (file.size > MOST_BYTES) {
    throw new Error(`${file.name} has ${Math.round(file.size / 1e6)} MB, and this page reads at most ${MOST_BYTES / 1e6} MB: make it smaller with \`sixfold decimate\`, or use \`sixfold tables\` and \`sixfold trace\``);
  }
  const bytes = new Uint8Array(await file.arrayBuffer());
  if (/\.json$/i.test(file.name)) return explorer.open(fromText(new TextDecoder().decode(bytes)));
  const state = meshState({ mesh: await meshOfFile(file.name, bytes) }, file.name);
  const { lesson } = explorer.view;
  await explorer.go(state, { ...defaultView(), lesson });
}

export function meshDialog(explorer, shapes) {
  const choose = (subject, name) => {
    close();
    explorer.run(() => explorer.go(meshState(subject, name), { ...defaultView(), lesson: explorer.view.lesson }));
  };
  const { subject } = explorer;
  const triangulate = el("input", { type: "checkbox", checked: subject.triangulate === true, id: "triangulate", onchange: (event) => {
    close();
    explorer.run(() => explorer.withSubject({ ...subject, triangulate: event.target.checked }));
  } });
  const entry = ({ name, summary, parameters }) => {
    const fields = parameters.map((parameter) => el("label", { title: parameter.meaning }, `${parameter.name} `,
      el("input", { type: "number", class: "number", value: String(parameter.is_integer ? Math.min(parameter.default, Math.max(parameter.min, SMALL)) : parameter.default), min: parameter.min, max: parameter.max, step: parameter.is_integer ? 1 : "any", "data-parameter": parameter.name })));
    const make = () => {
      const values = fields.map((field) => field.lastChild).filter((field) => field.value !== "");
      const chosen = Object.fromEntries(values.map((field) => [field.dataset.parameter, Number(field.value)]));
      choose({ mesh: { shape: { name, parameters: chosen } } }, name);
    };
    return el("li", {}, button(name, make, { "data-shape": name }), " ", fields, el("span", { class: "hint" }, ` ${summary}`));
  };
  const fault = ([name, positions, faces]) =>
    el("li", {}, button(name, () => choose({ mesh: { polygons: { positions, faces } } }, name), { "data-fault": name }));
  const group = (title, entries) => el("section", {}, el("h3", {}, title), el("ul", { class: "shapes" }, entries));
  openDialog("Mesh", [
    el("p", {}, button("Open a file …", () => { close(); find("file").click(); }, { class: "main" }),
      el("span", { class: "hint" }, " or drop a file on the page: OBJ, OFF, PLY, STL, glTF, or a state that was saved. It stays on this machine.")),
    el("p", {}, el("label", {}, triangulate, " cut polygons into triangles")),
    el("div", { class: "groups" }, [...grouped(shapes).map(([title, list]) => group(title, list.map(entry))), group("Faults", FAULTS.map(fault))]),
  ]);
}

function grouped(shapes) {
  const others = shapes.filter(({ name }) => !GROUPS.some(([, names]) => names.includes(name)));
  const groups = GROUPS.map(([title, names]) => [title, shapes.filter(({ name }) => names.includes(name))]);
  return [...groups, ["From programs", others]].filter(([, list]) => list.length);
}

export async function shareDialog(explorer) {
  const { state, view } = explorer;
  const link = await toLink(state, view);
  const save = () => download("sixfold-explorer.json", toText(state, view), "application/json");
  const address = link && location.href.split("#")[0] + link;
  const field = el("input", { value: address ?? "", readonly: "", "aria-label": "Link", id: "link", size: 40 });
  const copy = async () => {
    field.select();
    await navigator.clipboard?.writeText(address).catch(() => document.execCommand("copy"));
    copied.textContent = " copied";
  };
  const copied = el("span", { role: "status" });
  openDialog("Share what is shown", [
    link ? el("p", {}, "A link with the mesh, the edits and the step, for a page on a server or this file on this machine: ", field, button("Copy", copy, { class: "main" }), copied)
      : el("p", {}, "This mesh is too large for a link. Save the state, and send the file."),
    el("p", {}, button("Save the state", save, { id: "save", class: !link && "main" }), " as a file. Drop the file on this page to open it."),
  ]);
}

export function helpDialog(version) {
  const keys = [
    ["Space", "play or pause"], ["← →", "one step back or forward"], ["Home End", "to the beginning, to the end"],
    ["R", "to the next result of the structure in front"], ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
    ["drag, two fingers, Shift+drag", "turn, zoom, move the mesh"], ["wheel, + −", "zoom"],
    ["arrow keys on the mesh, 0", "turn, reset the view"],
  ];
  openDialog("Help", [
    el("p", {}, "Six data structures hold the same mesh. Choose an element and a relation: each structure finds the answer in its own tables. The row that is read is lit, the rows read so far come first in their tables, and the counters show the cost. The mesh turns to the element at hand; thin arrows are the fields of its row that lead on. The programs are those of Sixfold: this page runs its code."),
    el("p", {}, "A field with a † is not stored: it follows from the number of the row, or from other fields. Click the name of a structure to see its steps on the mesh. The buttons above the cards choose which structures are shown: two have room for their tables."),
    el("p", {}, el("b", {}, "Query"), " steps through one of nine relations. ", el("b", {}, "Edit"), " changes the mesh, and plays the rows that are rewritten from before to after; a structure that refuses an edit stays as it was until you undo it. ", el("b", {}, "Your walk"), " runs what you write. ", el("b", {}, "Subdivide"), " shows levels, and the weights of a point; v6¹ is the point v6 of level 1. ", el("b", {}, "Check"), " shows who refuses the mesh, and repairs it. ", el("b", {}, "Measure"), " times queries in this browser. With ", el("b", {}, "predict first"), ", you say what a query reads, what an edit changes, what a step of subdivision makes and who refuses the mesh, before it is shown."),
    el("table", { class: "list" }, keys.map(([key, what]) => el("tr", {}, el("th", { scope: "row" }, key), el("td", {}, what)))),
    el("p", { class: "hint" }, `Sixfold ${version}. No data leaves this page.`),
  ]);
}
