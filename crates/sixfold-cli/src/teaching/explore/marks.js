// What is marked on the mesh: the chosen element, the row that is read, results, faults, changes and weights.

import { Rows } from "./cards.js";
import { namesOf } from "./check.js";
import { editSteps, isBeforeEdit } from "./edit-steps.js";
import { plus, scale, minus, mix } from "./mesh.js";
import { placeOfRow, styleOf } from "./places.js";
import { fraction, levelMark } from "./subdivide.js";

// Maximum number of results that are marked: the last ones.
const MOST_MARKS = 200;

// Maximum number of places of a fault that are marked without being asked for.
const MOST_FAULTS = 100;

// More faults are marked without their names.
const MOST_LABELS = 16;

// The marks of what the explorer shows. `rowsOf(structure)` are the rows of a card by their names.
export function marks(explorer, rowsOf, colour) {
  const { view, picked, marked, lastEdit } = explorer;
  const model = drawnModel(explorer);
  if (view.tab === "subdivide" && view.level > 0) return stencilMarks(explorer, colour);
  const list = [];
  const add = (name, shade, label = name) => {
    const place = model.place(name) ?? cornerOfSoup(model, name);
    if (place) list.push({ place, colour: shade, label, style: styleOf(place) });
  };
  if (view.tab === "edit" && lastEdit) {
    const { created = [], removed = [] } = [...lastEdit.answers.values()][0] ?? {};
    for (const name of isBeforeEdit(explorer) ? [...removed, ...lastEdit.deleted ?? []] : created) add(name, colour("--changed"));
    list.push(...writeMarks(explorer, rowsOf(view.focus), colour));
  }
  if (view.tab === "query" || view.tab === "walk") list.push(...stepMarks(explorer, rowsOf(view.focus), colour));
  const faults = marked.length || view.tab !== "check" || explorer.isPredicting ? marked : faultNames(explorer);
  for (const name of faults) add(name, colour("--fault"), faults.length <= MOST_LABELS ? name : null);
  for (const name of picked) add(name, colour("--picked"));
  if (view.tab !== "check") {
    const place = model.place(view.element);
    if (place) list.push({ place, colour: colour("--chosen"), label: view.element + (view.tab === "subdivide" ? levelMark(0) : ""), style: place.kind === "vertex" ? "ring" : styleOf(place), isAtHand: !list.some((one) => one.isAtHand) });
  }
  return list;
}

// The corner of a number such as c5: a polygon soup has those of one face after those of another. Null if it is none.
function cornerOfSoup(model, name) {
  if (!/^c\d+$/.test(name)) return null;
  let left = Number(name.slice(1));
  for (const [f, face] of model.faces.entries()) {
    if (!face) continue;
    if (left < face.length) return model.corner(f, face[left]);
    left -= face.length;
  }
  return null;
}

// The mesh that is drawn: that of a level, or the one before an edit while its writes are shown.
export function drawnModel(explorer) {
  const { view, model, refined, lastEdit } = explorer;
  if (view.tab === "subdivide" && refined) return refined.models[view.level];
  return (isBeforeEdit(explorer) && lastEdit?.before) || model;
}

// The row that is written, on the mesh before the edit.
function writeMarks(explorer, rows, colour) {
  const { view, lastEdit } = explorer;
  const write = isBeforeEdit(explorer) && editSteps(explorer, view.focus)?.at(view.time);
  if (!write) return [];
  const answer = lastEdit.answers.get(view.focus);
  const place = placeOfRow(drawnModel(explorer), rowsBefore(rows, answer), write.row);
  if (!place) return [];
  return [{ place, colour: colour(`--${view.focus}`) || colour("--other"), label: write.row, style: styleOf(place), isAtHand: true }];
}

// The rows of a card with the values before an edit.
function rowsBefore(rows, { rows: changes }) {
  const before = new Rows(rows.moved);
  for (const [name, row] of rows) before.set(name, row);
  for (const change of changes) {
    const row = before.get(change.row);
    if (!row || !change.before) continue;
    const values = { ...row.values, ...Object.fromEntries(change.columns.map((column, i) => [column, change.before[i]])) };
    before.set(change.row, { ...row, values, fields: Object.values(values).filter((value) => value !== undefined) });
  }
  return before;
}

// The elements for which structures refuse the mesh. If it is most of its elements, none stands out.
function faultNames({ checked, model }) {
  const kinds = new Set(checked?.verdicts.flatMap(({ faults }) => faults));
  const all = { face: model.faceCount, edge: model.edges.size, vertex: model.vertexCount };
  const isMost = ({ places }) => places.length > 3 && places.length > all[Object.keys(places[0])[0]] / 2;
  const faults = checked?.faults.filter((fault) => kinds.has(fault.kind) && !isMost(fault)) ?? [];
  return faults.flatMap(({ places }) => places.slice(0, MOST_FAULTS).flatMap(namesOf));
}

// The results so far, the row that is read, and an arrow from the row that was read before.
function stepMarks({ view, model, timelines }, rows, colour) {
  const timeline = timelines.get(view.focus);
  if (!timeline) return [];
  const list = [];
  for (const result of timeline.resultsAt(view.time).slice(-MOST_MARKS)) {
    const place = model.place(result) ?? placeOfRow(model, rows, result);
    if (place) list.push({ place, colour: colour("--result"), label: result.split(" = ").pop(), style: styleOf(place) });
  }
  const read = timeline.readAt(view.time);
  const place = read && placeOfRow(model, rows, read.row);
  if (!place) return list;
  const own = colour(`--${view.focus}`) || colour("--other");
  const before = timeline.readAt(timeline.starts[read.number]);
  const from = before && placeOfRow(model, rows, before.row);
  if (from && before.row !== read.row) {
    const points = [from.at, mix(from.at, place.at, 0.9)];
    list.push({ place: { kind: "move", points, at: place.at }, colour: own, style: "arrow" });
  }
  list.push(...fieldMarks(model, rows, read.row, place, own));
  list.push({ place, colour: own, label: rows.nameOf(read.row), style: styleOf(place), isAtHand: true });
  return list;
}

// Thin arrows for the fields of a row that name other rows, such as its next and its twin: a side as an arrow along it,
// an edge or a corner as an arrow to it.
function fieldMarks(model, rows, name, own, colour) {
  const found = new Map();
  for (const [field, value] of Object.entries(rows.get(name)?.values ?? {})) {
    if (value === name || !rows.has(value)) continue;
    const place = placeOfRow(model, rows, value);
    if (!place || !["side", "edge", "corner"].includes(place.kind)) continue;
    if (found.has(value)) found.get(value).label += `, ${field}`;
    else found.set(value, { place: place.kind === "side" ? place : towards(own, place), colour, label: field, style: "thin" });
  }
  return [...found.values()];
}

// An arrow from one place to another one, with its label near its head.
function towards(from, to) {
  const points = [mix(from.at, to.at, 0.12), mix(from.at, to.at, 0.92)];
  return { kind: "move", points, at: mix(from.at, to.at, 0.7) };
}

// The chosen point of a level, and arrows from its parents with their weights.
function stencilMarks({ view, refined, stencil }, colour) {
  if (!refined || !stencil) return [];
  const [before, now] = [refined.models[view.level - 1], refined.models[view.level]];
  const at = now.vertices[Number(stencil.point.slice(1))];
  const list = [];
  for (const { vertex, weight } of stencil.parents) {
    const place = before.place(vertex);
    const points = [place.at, plus(at, scale(minus(place.at, at), 0.12))];
    list.push({ place: { kind: "move", points, at: place.at }, colour: colour("--result"), label: `${vertex}${levelMark(view.level - 1)} · ${fraction(weight)}`, style: "arrow" });
  }
  list.push({ place: { kind: "vertex", points: [at], at }, colour: colour("--chosen"), label: stencil.point + levelMark(view.level), style: "ring" });
  return list;
}
