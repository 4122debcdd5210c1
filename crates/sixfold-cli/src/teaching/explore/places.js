// Where the rows of tables and the results of queries are on the mesh.

import { mix, minus, plus, length } from "./mesh.js";

const isVertex = (field) => /^v\d+$/.test(field);
const isFace = (field) => /^f\d+$/.test(field);
const numberOf = (name) => Number(name.slice(1));

// Where a row is. `rows` are the rows that a card shows. What a row stands for follows from its fields: two vertices
// are an edge, a vertex and a face a corner, and so on. Null if it is not known.
export function placeOfRow(model, rows, name) {
  const own = model.place(rows.elementOf(name));
  if (own) return own;
  const row = rows.get(name);
  if (!row || row.fields.length === 0) return null;
  const vertices = row.fields.filter(isVertex).map(rows.elementOf).map(numberOf);
  const face = row.fields.filter(isFace).map(rows.elementOf).map(numberOf)[0];
  if (vertices.length >= 2) return model.place(`v${vertices[0]}-v${vertices[1]}`);
  if (vertices.length === 1 && row.element.includes("edge")) return sideOf(model, rows, row, vertices[0], face);
  if (vertices.length === 1 && face !== undefined) return model.corner(face, vertices[0]);
  if (face === undefined) return null;
  const position = row.fields.map(readPosition).find((point) => point);
  return position ? cornerAt(model, face, position) : model.place(`f${face}`);
}

// The side of a half-edge. Without a face, it runs on the other side of its twin's edge.
function sideOf(model, rows, row, origin, face) {
  if (face !== undefined) return model.side(face, origin);
  const twin = rows.get(row.values.twin);
  const [to] = (twin?.fields ?? []).filter(isVertex).map(rows.elementOf).map(numberOf);
  const [across] = (twin?.fields ?? []).filter(isFace).map(rows.elementOf).map(numberOf);
  if (to === undefined) return model.place(`v${origin}`);
  const inner = across === undefined ? null : model.place(`f${across}`);
  const middle = mix(model.vertices[origin] ?? [0, 0, 0], model.vertices[to] ?? [0, 0, 0], 0.5);
  const outside = inner ? plus(middle, minus(middle, inner.at)) : middle;
  return model.arrow(origin, to, outside);
}

// The corner of a face whose vertex is at a position.
function cornerAt(model, face, position) {
  const corners = model.faces[face];
  if (!corners) return null;
  const distance = (v) => length(minus(model.vertices[v], position));
  const nearest = corners.reduce((best, v) => (distance(v) < distance(best) ? v : best));
  return model.corner(face, nearest);
}

// Reads (1, 0.5, -1).
function readPosition(field) {
  const numbers = /^\(([^()]*)\)$/.exec(field)?.[1].split(",").map(Number);
  return numbers?.length === 3 && numbers.every(Number.isFinite) ? numbers : null;
}

// How a place is drawn.
export const styleOf = (place) =>
  ({ vertex: "dot", corner: "dot", edge: "line", side: "arrow", face: "fill", move: "arrow" })[place.kind];
