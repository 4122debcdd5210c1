// The explorer: what is shown, and how it changes. Panels and cards call its methods.

import { check } from "./check.js";
import { editSteps } from "./edit-steps.js";
import { EngineFailure } from "./engine.js";
import { askMemory } from "./measure.js";
import { Model, edgeName, parseName } from "./mesh.js";
import { relationFor } from "./query.js";
import { defaultView, groups, meshState, pastOf, withEdit } from "./state.js";
import { newCourse } from "./store.js";
import { refine } from "./subdivide.js";
import { Timeline, rowNumber } from "./timeline.js";
import { walkFor } from "./walk.js";

// Larger tables show only the rows of the query or edit, and some rows beside them.
const WHOLE_TABLE = 200;
const MOST_ROWS = 400;

export class Explorer {
  constructor(engine, structures, schemes) {
    this.engine = engine;
    this.structures = structures;
    this.schemes = schemes;
    this.past = [];
    this.future = [];
    this.view = defaultView();
    // Other elements that are chosen, for edits that need several.
    this.picked = [];
    // Elements that are marked on the mesh, such as those with a fault.
    this.marked = [];
    this.timelines = new Map();
    // The answers to the lessons.
    this.course = newCourse();
    this.listeners = [];
  }

  // Calls `listener` after each change: with "all" if the mesh or what is shown of it changed, else "time".
  onChange(listener) {
    this.listeners.push(listener);
  }

  tell(what) {
    for (const listener of this.listeners) listener(what);
  }

  // Runs an action. If it fails, nothing is changed, and the page shows why. Actions that overlap run in their order.
  run(action) {
    const turn = (this.running ?? Promise.resolve()).then(async () => {
      this.busy = true;
      this.tell("busy");
      try {
        await action();
        this.message = null;
      } catch (error) {
        this.message = error instanceof EngineFailure
          ? `The engine failed: ${error.message}. This is a fault of Sixfold. Please report it with the state (Share, Save the state) and this request: ${error.request?.slice(0, 400)}. The page goes on from the last good state.`
          : error.message;
      }
      this.busy = false;
      this.tell("busy");
    });
    this.running = turn;
    return turn;
  }

  // Shows another mesh, or the mesh after edits. The caller tells the listeners.
  async show(state, view = this.view, lastEdit = null) {
    const begun = { ...this.view };
    const shown = await this.compute(state, { ...view }, lastEdit);
    // What was changed while the engine worked stays.
    for (const key of ["lesson", "quiz", "focus", "walk"]) {
      if (this.view[key] !== begun[key]) shown.view[key] = this.view[key];
    }
    // A reader who predicts goes on with the next mesh.
    shown.view.quiz ||= this.view.quiz;
    const picked = this.picked.filter((name) => shown.model.has(name));
    Object.assign(this, shown, { picked, marked: [], isRefused: false });
    // An edit is shown as it is at its end.
    this.view.time = this.view.tab === "edit" ? this.length : Math.min(this.view.time, this.length);
  }

  // Shows another mesh; the one before comes back with undo.
  async advance(state, view, lastEdit) {
    const before = this.state;
    await this.show(state, view, lastEdit);
    this.past.push(before);
    this.future = [];
  }

  async go(state, view) {
    await this.advance(state, view);
    this.tell("all");
  }

  // Shows a situation from a link, a file or a lesson.
  async open({ state, view }) {
    const { held, refused, leftOut } = await this.replayed(state);
    const before = this.state ? [...this.past, this.state] : [];
    const tab = refused ? "edit" : view.tab;
    await this.show(held, { ...defaultView(), ...view, tab }, refused);
    this.past = [...before, ...pastOf(held)];
    this.future = [];
    this.picked = [];
    if (refused) this.markRefused(refused);
    this.tell("all");
    if (leftOut.length) throw new Error(`no structure accepts these edits, which were left out: ${leftOut.join("; ")}`);
  }

  // Runs the edits of a state, and notes which structures refuse them. An edit that all refuse is left out; if it is
  // the last one, it is shown as refused.
  async replayed(state) {
    const { subject, edits } = state;
    const whole = { held: { ...state, stopped: {} }, refused: null, leftOut: [] };
    if (edits.length === 0) return whole;
    const bare = await this.engine.ask(subject, { ask: { tables: { rows: [0, 0] } } });
    const edited = await this.engine.ask(subject, { edits, ask: { tables: { rows: [0, 0] } } });
    const holding = bare.answers.map(({ backend }) => backend);
    if (holding.length > 0 && edited.answers.length === holding.length) return whole;
    const leftOut = [];
    let held = { ...state, edits: [], stopped: {} };
    let refused = null;
    for (const edit of edits) {
      const structures = holding.filter((structure) => held.stopped[structure] === undefined);
      const done = await this.askEdit(held, structures, edit);
      if (refused) leftOut.push(refused.edit);
      refused = done.answers.size === 0 ? done : null;
      if (!refused) held = withEdit(held, edit, structures.filter((structure) => !done.answers.has(structure)));
    }
    return { held, refused, leftOut };
  }

  markRefused({ edit }) {
    this.marked = [edit.split(" ")[1]].filter((name) => name && this.model.has(name));
    this.isRefused = true;
  }

  undo() {
    return this.travel(this.past, this.future);
  }

  redo() {
    return this.travel(this.future, this.past);
  }

  // Shows the last state of one list, and puts the state before at the end of the other.
  async travel(from, to) {
    if (from.length === 0) return;
    const now = this.state;
    await this.show(from.at(-1));
    from.pop();
    to.push(now);
    this.tell("all");
  }

  // Changes what is shown of the mesh, such as { element: "v3" }.
  async look(change) {
    const view = { ...this.view, time: 0, ...change };
    await this.show(this.state, view, this.lastEdit);
    this.tell("all");
  }

  // Changes what needs no answer of the engine: the time, the structure in front.
  set(change) {
    Object.assign(this.view, change);
    this.tell("time");
  }

  // Chooses the structure in front. An edit that is shown at its end stays there: each structure writes other rows.
  bringToFront(structure) {
    const isAtEnd = this.view.time >= this.length;
    this.view.focus = structure;
    if (this.view.tab === "edit") this.view.time = isAtEnd ? this.length : Math.min(this.view.time, this.length);
  }

  // Whether the reader predicts first, and what is shown is not known yet. `revealed` is the state for which it is.
  get isPredicting() {
    return this.view.quiz && this.revealed !== this.state;
  }

  get length() {
    if (this.view.tab === "edit") return editSteps(this, this.view.focus)?.length ?? 0;
    return Math.max(0, ...[...this.timelines.values()].map((timeline) => timeline.length));
  }

  // Asks the engine for all that is shown.
  async compute(state, view, lastEdit) {
    const asked = groups(state, this.structures);
    const base = state === this.state ? this.base : await this.baseOf(state, asked);
    const shown = { state, view, base, model: base.model, geometry: base.geometry, notes: base.notes };
    Object.assign(shown, { records: new Map(base.records), refusals: new Map(base.refusals) });
    Object.assign(shown, { timelines: new Map(), lastEdit: null, failed: null });
    view.element = shown.model.nameOf(view.element) ?? elementLike(shown.model, view.element);
    if (!this.structures.includes(view.focus)) view.focus = defaultView().focus;
    view.relation = relationFor(view.relation, parseName(view.element).kind);
    if (view.tab === "query") await this.trace(shown, asked);
    if (view.tab === "walk") await this.walk(shown, asked);
    if (view.tab === "edit") shown.lastEdit = lastEdit ?? await this.lastEditOf(state, base);
    shown.subject = subjectOf(state, base.geometry);
    if (view.tab === "subdivide") await refine(this.engine, shown);
    if (view.tab === "check") await check(this.engine, shown);
    if (view.tab === "measure") await askMemory(this.engine, shown);
    await this.largeTables(shown, asked);
    return shown;
  }

  // What does not depend on the view: the geometry, the first rows of all tables, and who refuses the mesh.
  async baseOf(state, asked) {
    const [records, refusals, notes, holdingTriangles] = [new Map(), new Map(), new Set(), new Set()];
    for (const { structures, edits } of asked) {
      const ask = { tables: { rows: [0, WHOLE_TABLE - 1] } };
      const response = await this.engine.ask(state.subject, { structures, edits, ask });
      for (const answer of response.answers) records.set(answer.backend, answer);
      for (const { backend, reason } of response.refused) refusals.set(backend, reason);
      // They cannot hold the mesh as it is.
      for (const structure of response.holding_triangles ?? []) holdingTriangles.add(structure);
      for (const note of response.notes ?? []) notes.add(note);
    }
    // A soup has no vertices of its own: those without a face are lost, and those at one place are one.
    const holding = asked[0].structures.filter((structure) => records.has(structure));
    const hasVertices = (structure) => records.get(structure).records.some(({ element }) => element === "vertex");
    const structure = holding.find(hasVertices) ?? holding[0];
    if (!structure) throw new Error([...refusals.values()][0] ?? "no structure holds this mesh");
    const request = { structures: [structure], edits: asked[0].edits, ask: "geometry" };
    const [geometry] = (await this.engine.ask(state.subject, request)).answers;
    return { records, refusals, holdingTriangles, notes: [...notes], geometry, model: new Model(geometry) };
  }

  async trace(shown, asked) {
    const { state, view: { relation, element } } = shown;
    for (const { structures, edits } of asked) {
      const ask = { trace: { relation, element } };
      const response = await this.engine.ask(state.subject, { structures, edits, ask });
      for (const answer of response.answers) shown.timelines.set(answer.backend, new Timeline(answer));
      for (const { backend, reason } of response.refused) shown.refusals.set(backend, reason);
    }
  }

  // Runs the walk of the student on the structure in front. A walk that is wrong is shown as such.
  async walk(shown, asked) {
    const { state, view: { focus, relation, element } } = shown;
    const walk = walkFor(shown.view.walk, focus, element);
    shown.view.walk = walk;
    if (walk.trim() === "") return;
    const edits = asked.find(({ structures }) => structures.includes(focus))?.edits ?? [];
    const ask = { walk: { walk: walk.replace(/\n(?!\s*else\b)/g, ";\n"), expect: { relation, element } } };
    try {
      const response = await this.engine.ask(state.subject, { structures: [focus], edits, ask });
      for (const answer of response.answers) shown.timelines.set(answer.backend, new Timeline(answer));
      shown.failed = response.refused[0]?.reason ?? null;
    } catch (error) {
      if (error instanceof EngineFailure) throw error;
      shown.failed = error.message;
    }
  }

  // What the last edit did, asked again.
  async lastEditOf(state, base) {
    if (state.edits.length === 0) return null;
    const last = state.edits.length - 1;
    const structures = this.structures.filter((structure) => (state.stopped[structure] ?? last) >= last);
    const before = { ...state, edits: state.edits.slice(0, last) };
    const done = await this.askEdit(before, structures, state.edits[last]);
    const hasVertices = (structure) => base.records.get(structure)?.records.some(({ element }) => element === "vertex");
    const holding = [...done.answers.keys()];
    const request = { structures: [holding.find(hasVertices) ?? holding[0]], edits: before.edits, ask: "geometry" };
    const [geometry] = holding.length ? (await this.engine.ask(state.subject, request)).answers : [];
    return { ...done, before: geometry ? new Model(geometry) : null };
  }

  // Runs an edit in the engine. Returns { edit, answers, refusals } by structure.
  async askEdit(state, structures, edit) {
    const response = await this.engine.ask(state.subject, { structures, edits: state.edits, ask: { edit } });
    const [answers, refusals] = [new Map(), new Map()];
    for (const answer of response.answers) {
      if (answer.refusal) refusals.set(answer.backend, answer.refusal);
      else answers.set(answer.backend, answer);
    }
    for (const { backend, reason } of response.refused) refusals.set(backend, reason);
    return { edit, answers, refusals };
  }

  // Runs an edit on all structures that hold the mesh and have not stopped.
  // If the reader predicts first, the edit waits for that.
  async edit(text) {
    const { state } = this;
    if (this.isPredicting) {
      this.pending = text;
      await this.look({ tab: "edit" });
      return;
    }
    const structures = this.structures.filter((structure) =>
      state.stopped[structure] === undefined && this.records.has(structure));
    const done = await this.askEdit(state, structures, text);
    if (done.answers.size === 0) {
      await this.show(state, { ...this.view, tab: "edit", time: 0 }, done);
      this.markRefused(done);
      this.tell("all");
      return;
    }
    const refusing = structures.filter((structure) => !done.answers.has(structure));
    const edit = [...done.answers.values()][0].edit;
    this.picked = [];
    const { model, view: { element } } = this;
    done.before = model;
    await this.advance(withEdit(state, edit, refusing), { ...this.view, tab: "edit", time: 0 }, done);
    this.nameEdges(model, element);
    this.tell("all");
  }

  // Notes which edges the last edit made and deleted. If it replaced the edge that was chosen by another one, as a
  // flip does, the other one is chosen.
  nameEdges(before, chosen) {
    const { model, lastEdit, view } = this;
    const made = model.edges.missingIn(before.edges);
    const deleted = before.edges.missingIn(model.edges);
    Object.assign(lastEdit, { made, deleted });
    if (made.length === 1 && deleted.length === 1 && deleted[0] === chosen) [view.element] = made;
  }

  // For tables that are too large to be shown: the rows that matter.
  async largeTables(shown, asked) {
    for (const { structures, edits } of asked) {
      for (const structure of structures) {
        const tables = shown.records.get(structure)?.records;
        if (!tables?.some((table) => table.total > WHOLE_TABLE)) continue;
        const names = [...namesToShow(shown, structure)];
        const ask = { tables: { names } };
        const response = await this.engine.ask(shown.state.subject, { structures: [structure], edits, ask });
        shown.records.set(structure, response.answers[0]);
      }
    }
  }

  // Replaces the mesh by another one, as geometry. Creases are kept only if the vertices have the numbers that they
  // had: the name of the mesh says if they are lost.
  async replace(geometry, what, { hasNumbers, ...change }) {
    const { creases } = this.state.subject;
    const lost = creases && !hasNumbers ? ", without its sharp edges" : "";
    const subject = polygonsOf(geometry, hasNumbers ? creases : null);
    await this.go(meshState(subject, `${this.state.name}, ${what}${lost}`), { ...this.view, time: 0, ...change });
  }

  // Shows the mesh with other fields of the request, such as `triangulate`.
  async withSubject(subject, change = {}) {
    await this.go(meshState(subject, this.state.name), { ...this.view, time: 0, ...change });
  }

  // Stops what the engine computes, and starts it again.
  stop() {
    return this.engine.restart();
  }

  // Chooses an element; `more` adds it to the elements that an edit needs.
  async choose(name, more = false) {
    if (more && name !== this.view.element) {
      const has = this.picked.includes(name);
      this.picked = has ? this.picked.filter((other) => other !== name) : [...this.picked, name];
      this.tell("all");
      return;
    }
    this.picked = [];
    await this.look({ element: name, relation: relationFor(this.view.relation, parseName(name).kind) });
  }

  // Chooses a relation, and an element that it starts from.
  async chooseRelation(relation) {
    const kind = relation.split("_")[0];
    const { element } = this.view;
    const isKind = parseName(element).kind === kind;
    await this.look({ relation, element: isKind ? element : elementLike(this.model, element, kind) });
  }

  // The structures whose cards are shown, in their order.
  get shown() {
    const names = this.view.only.split(",");
    const shown = this.structures.filter((name) => names.includes(name));
    return shown.length ? shown : this.structures;
  }

  // Shows or hides the card of a structure. One card stays.
  toggle(structure) {
    const isShown = this.shown.includes(structure);
    const shown = this.structures.filter((name) => (name === structure ? !isShown : this.shown.includes(name)));
    if (shown.length === 0) return;
    this.view.only = shown.length === this.structures.length ? "" : shown.join(",");
    if (!shown.includes(this.view.focus)) this.bringToFront(shown[0]);
    this.tell("all");
  }

  // Marks elements on the mesh.
  mark(names) {
    this.marked = names;
    this.tell("time");
  }
}

const subjects = new WeakMap();

// The mesh as it is after the edits, for what is asked of meshes without edits. The same object for the same mesh.
function subjectOf(state, geometry) {
  if (state.edits.length === 0) return state.subject;
  if (!subjects.has(geometry)) subjects.set(geometry, polygonsOf(geometry, state.subject.creases));
  return subjects.get(geometry);
}

// The fields of a request for a mesh by its vertices and faces.
function polygonsOf(geometry, creases) {
  const subject = { mesh: { polygons: { positions: geometry.vertices, faces: geometry.faces } } };
  const kept = creases && keptCreases(creases, new Model(geometry));
  if (kept) subject.creases = kept;
  return subject;
}

// The creases whose edges and vertices a mesh has. The engine leaves out numbers without a vertex, so all vertices
// after them have lower numbers.
function keptCreases(creases, model) {
  const numbers = new Map();
  model.vertices.forEach((vertex, v) => vertex && numbers.set(v, numbers.size));
  const kept = creases.split("\n").flatMap((line) => {
    const [kind, ...fields] = line.split("#")[0].trim().split(/\s+/);
    const ends = fields.slice(0, -1).map(Number);
    const isKept = kind === "edge" ? model.edges.has(edgeName(...ends)) : numbers.has(ends[0]);
    return isKept ? [`${kind} ${ends.map((v) => numbers.get(v)).join(" ")} ${fields.at(-1)}`] : [];
  });
  return kept.join("\n");
}

// The rows of a large mesh that are shown: those of the query or edit, with the rows beside them.
function namesToShow({ timelines, lastEdit }, structure) {
  const names = new Set(timelines.get(structure)?.rowNames(MOST_ROWS) ?? []);
  const edit = lastEdit?.answers.get(structure);
  for (const { row } of [...(edit?.rows ?? []), ...(edit?.only_read ?? [])]) if (names.size < MOST_ROWS) names.add(row);
  if (names.size === 0) for (const letter of "vefhcp") names.add(`${letter}0`);
  for (const name of [...names]) {
    const number = rowNumber(name);
    if (number > 0) names.add(`${name[0]}${number - 1}`);
    names.add(`${name[0]}${number + 1}`);
  }
  return names;
}

// An element of a kind that touches an element, if the mesh has both, else the first of this kind.
function elementLike(model, name, kind = parseName(name)?.kind ?? "vertex") {
  const first = (list) => list.findIndex((one) => one);
  const known = model.has(name) ? parseName(name) : null;
  const touches = (corners) => known?.kind === "face" ? false : known?.numbers.every((v) => corners.includes(v));
  if (kind === "edge" && model.edges.size) {
    const corners = new Set(known?.kind === "face" ? model.faces[known.numbers[0]] : []);
    const edge = model.edges.nameWhere((...ends) => touches(ends) || ends.every((v) => corners.has(v)));
    return edge ?? model.edges.name(0);
  }
  if (kind === "face" && model.faceCount) {
    const face = model.faces.findIndex((corners) => corners && touches(corners));
    return `f${face < 0 ? first(model.faces) : face}`;
  }
  if (known?.kind === "edge") return `v${known.numbers[0]}`;
  if (known?.kind === "face") return `v${model.faces[known.numbers[0]][0]}`;
  return `v${Math.max(0, first(model.vertices))}`;
}
