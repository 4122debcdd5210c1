// What the page shows, as data: it goes into a link or a file, and comes back.

import { fromBase64, gunzip, gzip, toBase64 } from "./engine.js";

// Longer links are cut off by some programs that people send links with.
const MOST_LINK_LETTERS = 8000;
const VERSION = 1;
const TABS = ["query", "edit", "walk", "subdivide", "check", "measure"];

// The mesh, and the edits since. `subject` has the fields of a request that name the mesh. `stopped` has for each
// structure that refused an edit the number of this edit: it stays as it was before, until the edit is undone.
export function meshState(subject, name) {
  return { subject, name, edits: [], stopped: {} };
}

// The state after one more edit, which the structures `refusing` refuse.
export function withEdit(state, edit, refusing) {
  const stopped = { ...state.stopped };
  for (const structure of refusing) stopped[structure] = state.edits.length;
  return { ...state, edits: [...state.edits, edit], stopped };
}

// The states before each edit of a state.
export function pastOf(state) {
  return state.edits.map((_, i) => {
    const stopped = Object.entries(state.stopped).filter(([, edit]) => edit < i);
    return { ...state, edits: state.edits.slice(0, i), stopped: Object.fromEntries(stopped) };
  });
}

// What the page shows of a mesh at first.
export function defaultView() {
  return {
    tab: "query",
    element: "v0",
    relation: "vertex_vertices",
    focus: "half-edge",
    // The structures that are shown, with commas between their names; all if it is empty.
    only: "",
    time: 0,
    walk: "",
    scheme: "loop",
    level: 1,
    point: null,
    lesson: null,
    quiz: false,
  };
}

// The structures that have run the same edits, with these edits: most structures have run all.
export function groups(state, structures) {
  const groups = new Map();
  for (const structure of structures) {
    const count = state.stopped[structure] ?? state.edits.length;
    if (!groups.has(count)) groups.set(count, { structures: [], edits: state.edits.slice(0, count) });
    groups.get(count).structures.push(structure);
  }
  return [...groups.values()].sort((a, b) => b.edits.length - a.edits.length);
}

// Writes the state as text for a file. Which structures refuse an edit follows from the edits.
export function toText({ subject, name, edits }, view) {
  return JSON.stringify({ sixfold: VERSION, subject, name, edits, view });
}

// Reads the state from text. Throws an Error if the text is not a state.
export function fromText(text) {
  let read;
  try {
    read = JSON.parse(text);
  } catch {
    throw new Error("this is not a state of the explorer: it is not JSON");
  }
  const isState = read?.sixfold !== undefined && typeof read.subject?.mesh === "object" && read.subject.mesh !== null;
  if (!isState) throw new Error("this is not a state of the explorer: it has no field `sixfold`, or no mesh");
  if (read.sixfold !== VERSION) {
    throw new Error(`this state has version ${read.sixfold}, and this page reads version ${VERSION}: use the page that wrote it`);
  }
  const { mesh, triangulate, creases } = read.subject;
  const subject = { mesh };
  if (triangulate === true) subject.triangulate = true;
  if (typeof creases === "string") subject.creases = creases;
  const edits = Array.isArray(read.edits) ? read.edits.map(String) : [];
  const view = defaultView();
  for (const [key, value] of Object.entries(read.view ?? {})) {
    if (Object.hasOwn(view, key) && isLike(view[key], value)) view[key] = value;
  }
  if (!TABS.includes(view.tab)) view.tab = TABS[0];
  if (!/^v\d{1,9}$/.test(view.point ?? "")) view.point = null;
  return { state: { ...meshState(subject, String(read.name ?? "mesh")), edits }, view };
}

// Whether a value can take the place of a default: null stands for a text that is missing.
function isLike(value, other) {
  if (typeof value === "number") return Number.isInteger(other) && other >= 0;
  return typeof other === (value === null ? "string" : typeof value);
}

// The part of a link after #, or null if it would be too long.
export async function toLink(state, view) {
  const packed = await gzip(new TextEncoder().encode(toText(state, view)));
  const text = toBase64(packed).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return text.length <= MOST_LINK_LETTERS ? `#s=${text}` : null;
}

// Reads the part of a link after #. Returns null if it has no state. Throws an Error if the state is damaged.
export async function fromLink(hash) {
  if (!hash.startsWith("#s=")) return null;
  let text;
  try {
    const packed = fromBase64(hash.slice(3).replaceAll("-", "+").replaceAll("_", "/"));
    text = new TextDecoder().decode(await gunzip(packed));
  } catch {
    throw new Error("the state in this link is damaged: the link may have been cut off");
  }
  return fromText(text);
}

// Reads a dropped file: the field `mesh` of a request.
export async function meshOfFile(name, bytes) {
  try {
    const text = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
    if (!text.includes("\0")) return { file: { name, text } };
  } catch {
    // Not text.
  }
  return { file: { name, base64: toBase64(bytes) } };
}
