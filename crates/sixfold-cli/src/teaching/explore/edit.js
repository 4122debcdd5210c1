// The panel of edits: the edits of the chosen elements, faults made on purpose, and what the last edit did.

import { button, el } from "./dom.js";
import { areaOf, length, minus, parseName, plus, scale } from "./mesh.js";
import { elementField } from "./query.js";

// The edits of an element, and of others that were chosen with it: the words on the button, and the edit as text.
export function editsOf(element, picked) {
  const { kind, numbers: [a, b] } = parseName(element);
  const vertices = picked.filter((name) => parseName(name).kind === "vertex");
  const edits = {
    vertex: [["remove the vertex", `remove_vertex ${element}`]],
    edge: [
      ["flip", `flip_edge ${element}`],
      ["split", `split_edge ${element}`],
      ["bisect", `bisect_edge ${element}`],
      ["dissolve", `dissolve_edge ${element}`],
      [`collapse to v${a}`, `collapse_edge ${element} v${a}`],
      [`collapse to v${b}`, `collapse_edge ${element} v${b}`],
    ],
    face: [["poke", `poke_face ${element}`], ["remove the face", `remove_face ${element}`]],
  }[kind];
  if (kind === "face" && vertices.length === 2) {
    edits.push([`split from ${vertices[0]} to ${vertices[1]}`, `split_face ${element} ${vertices.join(" ")}`]);
  }
  if (kind === "vertex" && vertices.length === 2) {
    edits.push([`split between ${vertices[0]} and ${vertices[1]}`, `split_vertex ${element} ${vertices.join(" ")}`]);
  }
  if (kind === "vertex" && vertices.length >= 2) {
    edits.push([`add a face ${[element, ...vertices].join(" ")}`, `add_face ${[element, ...vertices].join(" ")}`]);
  }
  return edits;
}

// Faults that someone makes on purpose, to see which structures refuse the mesh.
function faultsOf(explorer) {
  const { model, geometry, view: { element } } = explorer;
  const { kind, numbers } = parseName(element);
  const change = { tab: "check", hasNumbers: true };
  if (kind === "face") {
    const turn = () => {
      const faces = geometry.faces.map((face, f) => (f === numbers[0] ? [face[0], ...face.slice(1).reverse()] : face));
      return explorer.replace({ ...geometry, faces }, `${element} turned`, change);
    };
    return [["turn the face", turn]];
  }
  if (kind === "edge") {
    const add = () => {
      const { points, at } = model.place(element);
      const [across] = model.edges.get(element)?.faces ?? [];
      const area = areaOf(model.faces[across].map((v) => model.vertices[v]));
      const out = scale(area, length(minus(...points)) / (length(area) || 1));
      const vertices = [...geometry.vertices, plus(at, out)];
      const faces = [...geometry.faces, [...numbers, geometry.vertices.length]];
      return explorer.replace({ vertices, faces }, `another face at ${element}`, change);
    };
    return [["add another face at the edge", add]];
  }
  // Two faces that touch in this vertex only.
  const pinch = () => {
    const at = model.vertices[numbers[0]];
    const out = length(minus(at, model.centre)) > 0 ? scale(minus(at, model.centre), 0.6) : [0, 0, model.radius];
    const aside = scale([out[1] || 1, -out[0], out[2] / 2], 0.4);
    const n = geometry.vertices.length;
    const vertices = [...geometry.vertices, plus(at, plus(out, aside)), plus(at, minus(out, aside))];
    return explorer.replace({ vertices, faces: [...geometry.faces, [numbers[0], n, n + 1]] }, `a loose face at ${element}`, change);
  };
  return [["add a loose face at the vertex", pinch]];
}

function moveForm(explorer) {
  const { view: { element }, model } = explorer;
  const { kind, numbers } = parseName(element);
  if (kind !== "vertex") return null;
  const fields = model.vertices[numbers[0]].map((value, axis) =>
    el("input", { type: "number", step: "any", value: String(value), "aria-label": `new ${"xyz"[axis]}`, class: "number" }));
  const move = () => explorer.run(() => explorer.edit(`set_position ${element} ${fields.map((field) => Number(field.value)).join(",")}`));
  return el("span", { class: "form" }, fields, button("move", move));
}

export function editPanel(explorer) {
  const { view: { element }, model, picked, lastEdit } = explorer;
  const text = editField(explorer);
  if (!model.has(element)) return [el("div", { class: "grow" }, el("p", {}, "The mesh has no element to choose."), text)];
  const buttons = editsOf(element, picked).map(([words, text]) =>
    button(words, () => explorer.run(() => explorer.edit(text)), { title: text, "data-edit": text }));
  const faults = faultsOf(explorer).map(([words, make]) =>
    button(words, () => explorer.run(make), { class: "fault", title: "a fault made on purpose: see which structures refuse the mesh" }));
  return [
    el("div", { class: "grow" },
      el("p", {}, elementField(explorer), picked.length ? ` with ${picked.join(", ")}` : "",
        el("label", { title: "or click with Shift" }, " ", el("input", { type: "checkbox", id: "several", checked: explorer.several === true, onchange: (event) => { explorer.several = event.target.checked; } }), " choose several")),
      el("p", { class: "buttons", id: "edits" }, buttons, moveForm(explorer)),
      el("p", { class: "buttons" }, "a fault: ", faults),
      text,
      lastEdit ? editTable(explorer, lastEdit) : el("p", { class: "hint" }, "No edit yet.")),
  ];
}

// Edits that need no element, and a field for any edit.
function editField(explorer) {
  const compact = button("compact", () => explorer.run(() => explorer.edit("compact")), { title: "close the gaps of deleted elements" });
  const text = el("input", { size: 24, placeholder: "split_vertex v0 v1 v2", "aria-label": "Edit as text", id: "edit-text", spellcheck: "false", value: explorer.editText ?? "" });
  const run = () => explorer.run(async () => {
    explorer.editText = text.value;
    await explorer.edit(text.value.trim());
    if (!explorer.isRefused) explorer.editText = "";
  });
  text.addEventListener("keydown", (event) => event.key === "Enter" && run());
  return el("p", { class: "buttons" }, compact, "any edit: ", text, button("run", run, { id: "run-edit" }));
}

// What an edit did on each structure.
function editTable(explorer, { edit, answers, refusals, made: edgesMade, deleted: edgesDeleted }) {
  const made = [...answers.values()][0];
  const euler = ({ vertices, edges, faces }) => vertices - edges + faces;
  const change = made && `V − E + F: ${euler(made.before)}${euler(made.before) === euler(made.after) ? " stays" : ` → ${euler(made.after)}`}. `;
  const names = made && [["new", made.created], ["deleted", made.removed], ["new edges", edgesMade ?? []], ["deleted edges", edgesDeleted ?? []]].filter(([, list]) => list.length)
    .map(([word, list]) => `${word}: ${list.slice(0, 12).join(", ")}${list.length > 12 ? " …" : ""}. `);
  const cells = (structure) => {
    const answer = answers.get(structure);
    if (!answer) return el("td", { colSpan: 3, class: "refusal" }, refusals.get(structure) ??
      (explorer.base.refusals.has(structure) ? "cannot hold the mesh" : "not asked: it refused an edit before"));
    return [answer.reads, answer.writes, answer.changed].map((value) => el("td", { class: "count" }, value.toLocaleString("en")));
  };
  return el("details", { open: true, id: "edit-result" },
    el("summary", {}, el("code", {}, edit), answers.size === 0 ? ": all structures refuse it, and nothing is changed" : `: ${change}`, names ?? ""),
    el("table", { class: "list" },
      el("tr", {}, ["structure", "reads", "writes", "rows changed"].map((text) => el("th", {}, text))),
      explorer.structures.map((structure) => el("tr", { "data-structure": structure }, el("th", { scope: "row" }, structure), cells(structure)))));
}

const isChanged = ({ before, after }) => JSON.stringify(before) !== JSON.stringify(after);

// The rows that an edit changed on a structure: "halves h5" -> change.
export function changesOf(lastEdit, structure) {
  const rows = lastEdit?.answers.get(structure)?.rows ?? [];
  return new Map(rows.filter(isChanged).map((change) => [`${change.table} ${change.row}`, change]));
}
