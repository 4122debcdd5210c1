// What is marked on the mesh: the chosen element, the row that is read, results, faults, changes and weights.

import { namesOf } from "./check.js";
import { plus, scale, minus, mix } from "./mesh.js";
import { placeOfRow, styleOf } from "./places.js";
import { fraction } from "./subdivide.js";

// Maximum number of results that are marked: the last ones.
const MOST_MARKS = 200;

// Maximum number of places of a fault that are marked without being asked for.
const MOST_FAULTS = 100;

// The marks of what the explorer shows. `rowsOf(structure)` are the rows of a card by their names.
export function marks(explorer, rowsOf, colour) {
  const { view, model, picked, marked, lastEdit } = explorer;
  if (view.tab === "subdivide" && view.level > 0) return stencilMarks(explorer, colour);
  const list = [];
  const add = (name, shade, label = name) => {
    const place = model.place(name);
    if (place) list.push({ place, colour: shade, label, style: styleOf(place) });
  };
  if (view.tab === "edit" && lastEdit) {
    for (const name of [...lastEdit.answers.values()][0]?.created ?? []) add(name, colour("--changed"));
  }
  if (view.tab === "query" || view.tab === "walk") list.push(...stepMarks(explorer, rowsOf(view.focus), colour));
  for (const name of marked.length || view.tab !== "check" ? marked : faultNames(explorer.checked)) add(name, colour("--fault"));
  for (const name of picked) add(name, colour("--picked"));
  if (view.tab !== "check") {
    const place = model.place(view.element);
    if (place) list.push({ place, colour: colour("--chosen"), label: view.element, style: place.kind === "vertex" ? "ring" : styleOf(place), isAtHand: !list.some((one) => one.isAtHand) });
  }
  return list;
}

// The elements for which structures refuse the mesh.
function faultNames(checked) {
  const kinds = new Set(checked?.verdicts.flatMap(({ faults }) => faults));
  const faults = checked?.faults.filter(({ kind }) => kinds.has(kind)) ?? [];
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
    list.push({ place: { kind: "move", points, at: place.at }, colour: colour("--result"), label: `${vertex} · ${fraction(weight)}`, style: "arrow" });
  }
  list.push({ place: { kind: "vertex", points: [at], at }, colour: colour("--chosen"), label: stencil.point, style: "ring" });
  return list;
}
