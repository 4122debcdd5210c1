// The panel of subdivision: level by level, with the weights of a chosen point.

import { button, count, el, select } from "./dom.js";
import { EngineFailure } from "./engine.js";
import { Model, parseName } from "./mesh.js";

const MOST_LEVELS = 6;
// Larger levels have no picture.
const MOST_PICTURED = 9000;

// The levels of each mesh, by scheme and number of levels.
const refinements = new WeakMap();

// Asks for the levels, and for the weights of the chosen point.
export async function refine(engine, shown) {
  const { subject, view: { scheme, level, point } } = shown;
  const key = `${scheme} ${level}`;
  shown.refined = shown.stencil = null;
  try {
    if (refinements.get(subject)?.key !== key) {
      const { levels } = await engine.ask(subject, { ask: { subdivide: { scheme, levels: level } } });
      refinements.set(subject, { key, levels, models: levels.map((one) => new Model(one)) });
    }
    shown.refined = refinements.get(subject);
    const number = point === null ? null : parseName(point)?.numbers[0];
    if (level === 0 || number === null || !shown.refined.levels[level].vertices[number]) return;
    const { parents } = await engine.ask(subject, { ask: { stencil: { scheme, level, point: number } } });
    shown.stencil = { point, parents };
  } catch (error) {
    if (error instanceof EngineFailure) throw error;
    shown.failed = error.message;
  }
}

export function subdividePanel(explorer) {
  const { scheme, level, point } = explorer.view;
  const look = (change) => explorer.run(() => explorer.look(change));
  const models = explorer.refined?.models ?? [];
  const shown = models[level];
  return [
    el("div", { class: "grow columns" }, el("section", {},
      el("p", {}, el("label", {}, "scheme ", select(explorer.schemes, scheme, (name) => look({ scheme: name, point: null }), { id: "scheme" })),
        " ", el("label", {}, "level ", el("input", {
          type: "range", min: 0, max: MOST_LEVELS, value: String(level), id: "level",
          onchange: (event) => look({ level: Number(event.target.value), point: null }),
        })), ` ${level}`,
        button("use this level as the mesh", () => explorer.run(() =>
          explorer.replace(explorer.refined.levels[level], `${scheme} level ${level}`, { tab: "query" })), { disabled: !shown })),
      creaseForm(explorer),
      explorer.failed ? el("p", { class: "refusal" }, explorer.failed) : null,
      shown ? levelTable(models) : null),
      el("section", {}, level > 0 && shown ? pointField(shown, point, look) : null,
      stencilTable(explorer.stencil, level) ?? el("p", { class: "hint" }, point === null
        ? "Click a point of a level above 0: the points of the level before that it is made of are shown with their weights."
        : "")),
      pictures(models, level, look)),
  ];
}

// A picture of each level, which chooses it. The page draws them, as it draws the mesh.
function pictures(models, level, look) {
  const shown = models.map((model, i) => [model, i]).filter(([model]) => model.faceCount <= MOST_PICTURED);
  return el("section", { class: "pictures", "aria-label": "Levels" }, shown.map(([, i]) =>
    button([el("canvas", { "data-picture": String(i) }), `level ${i}`], () => look({ level: i, point: null }),
      { "aria-pressed": String(i === level), "data-level": String(i) })));
}

// The level as a mark after the name of an element: v6 of level 0 and v6 of level 1 are two points.
export const levelMark = (level) => [...String(level)].map((digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]).join("");

function levelTable(models) {
  return el("table", { class: "list", id: "levels" },
    el("tr", {}, ["level", "vertices", "edges", "faces", "V\u00a0−\u00a0E\u00a0+\u00a0F", "vertices by valence"].map((text) => el("th", {}, text))),
    models.map((model, i) => {
      const [v, e, f] = [model.vertexCount, model.edges.size, model.faceCount];
      return el("tr", {}, [i, v, e, f, v - e + f].map((value) => el("td", { class: "count" }, value.toLocaleString("en"))),
        el("td", {}, histogram(model)));
    }));
}

// How many vertices have each valence. Irregular ones have another colour.
function histogram(model) {
  const counts = new Map();
  for (const one of model.valences) {
    if (!one) continue;
    const bin = counts.get(one.valence) ?? { all: 0, irregular: 0 };
    bin.all += 1;
    bin.irregular += one.isIrregular ? 1 : 0;
    counts.set(one.valence, bin);
  }
  const most = Math.max(1, ...[...counts.values()].map(({ all }) => all));
  const columns = [...counts].sort(([a], [b]) => a - b).map(([valence, { all, irregular }]) =>
    el("span", { class: irregular === all && "irregular", title: `${count(all, "vertex")} of valence ${valence}, ${irregular.toLocaleString("en")} of them irregular` },
      el("b", {}, all.toLocaleString("en")), el("i", { style: `height: ${Math.max(2, Math.round((40 * all) / most))}px` }), `${valence}`));
  return el("div", { class: "histogram" }, columns);
}

function pointField(shown, point, look) {
  const take = (event) => {
    const name = event.target.value.trim().replace(/[^v\d]+$/, "");
    look({ point: shown.place(name)?.kind === "vertex" ? name : null });
  };
  return el("p", {}, el("label", {}, "point of this level ", el("input", { value: point ?? "", size: 7, id: "point", placeholder: "v8", spellcheck: "false", onchange: take })));
}

function stencilTable(stencil, level) {
  if (!stencil) return null;
  const { point, parents } = stencil;
  const sum = parents.reduce((total, { weight }) => total + weight, 0);
  return el("table", { class: "list", id: "stencil" },
    el("caption", {}, `${point}${levelMark(level)} = ${count(parents.length, "point")} of level ${level - 1}, weights ${fraction(sum)}`),
    parents.map(({ vertex, weight }) => el("tr", {}, el("th", { scope: "row" }, vertex + levelMark(level - 1)), el("td", { class: "count" }, fraction(weight)))));
}

// The denominators of weights: those of regular vertices, and of vertices of other valences with rational weights.
const DENOMINATORS = [...Array.from({ length: 64 }, (_, i) => i + 1), 96, 128, 144, 192, 256, 384, 512, 576, 1024];

// A weight as a fraction, if it is one of single precision, else as a number.
export function fraction(weight) {
  for (const below of DENOMINATORS) {
    const above = Math.round(weight * below);
    if (above !== 0 && Math.abs(weight - above / below) < 2e-7) return below === 1 ? `${above}` : `${above}/${below}`;
  }
  return weight.toFixed(4);
}

// Sharp edges and corners of the control mesh.
function creaseForm(explorer) {
  const { subject, geometry, view: { element } } = explorer;
  const { kind, numbers } = parseName(element);
  const lines = (subject.creases ?? "").split("\n").filter((line) => line.trim());
  const form = [lines.length ? count(lines.length, "sharp element") : "no sharp elements added"];
  // The engine counts vertices without gaps, so names and numbers are the same only in a mesh without gaps.
  if (kind !== "face" && !geometry.vertices.includes(null)) {
    const value = el("select", { "aria-label": "Sharpness" }, ["1", "2", "3", "inf"].map((text) => el("option", {}, text)));
    const key = kind === "edge" ? `edge ${numbers.join(" ")}` : `corner ${numbers[0]}`;
    const add = () => explorer.run(async () => {
      const others = lines.filter((line) => !line.startsWith(`${key} `));
      await explorer.withSubject({ ...subject, creases: [...others, `${key} ${value.value}`].join("\n") });
    });
    form.push(` · ${element} of level 0: sharpness `, value, button("make sharp", add));
  }
  if (lines.length) form.push(button("none sharp", () => explorer.run(() => explorer.withSubject({ ...subject, creases: undefined }))));
  return el("p", { class: "buttons" }, form);
}
