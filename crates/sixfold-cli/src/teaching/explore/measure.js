// The panel of measurements: the time of a query on each structure, in this browser.

import { button, el } from "./dom.js";
import { relations } from "./query.js";

const ROUNDS = 9;
// Milliseconds of one sample: much longer than the steps of the clock of a browser.
const SAMPLE_MS = 12;
const MOST_QUERIES = 4e6;

export function measurePanel(explorer) {
  const { view: { relation }, state } = explorer;
  const measured = explorer.measured?.relation === relation && explorer.measured.subject === explorer.subject ? explorer.measured : null;
  return [
    relations(explorer),
    el("div", { class: "grow" },
      el("p", {}, "The time of ", el("b", {}, relation), " from one element to the next, on ", state.name, ". ",
        button("Measure", () => explorer.run(() => measure(explorer)), { class: "main", id: "measure" }),
        el("span", { id: "measuring", role: "status" })),
      measured ? results(measured) : null,
      matrix(explorer),
      el("p", { class: "hint" }, `${ROUNDS} rounds, each structure once in each round, in random order; the median of each structure. `,
        "These times are those of WebAssembly in this browser on this machine. Compiled programs are faster, and other ratios are possible: ",
        el("code", {}, `sixfold study MESH --operations ${relation}`), " measures them.")),
  ];
}

function results({ times, refused }) {
  const fastest = Math.min(...times.map(({ ns }) => ns));
  const slowest = Math.max(...times.map(({ ns }) => ns));
  // Bars are logarithmic: the slowest can take a thousand times as long as the fastest.
  const width = (ns) => 4 + 92 * (slowest > fastest ? Math.log(ns / fastest) / Math.log(slowest / fastest) : 0);
  const rows = [...times].sort((a, b) => a.ns - b.ns).map(({ structure, ns, low, high }) =>
    el("tr", { "data-structure": structure, style: `--colour: var(--${structure}, var(--other))` },
      el("th", { scope: "row" }, structure),
      el("td", { class: "count" }, timeText(ns)),
      el("td", { class: "count" }, `${(ns / fastest).toPrecision(3)}×`),
      el("td", { class: "hint" }, `${timeText(low)} to ${timeText(high)}`),
      el("td", { class: "wide" }, el("span", { class: "bar", style: `width: ${width(ns)}%` }))));
  return el("table", { class: "list bars", id: "times" },
    el("tr", {}, ["structure", "a query", "ratio", "half of the rounds", "time, logarithmic"].map((text) => el("th", {}, text))),
    rows, refused.map(({ backend, reason }) => el("tr", {}, el("th", { scope: "row" }, backend), el("td", { colSpan: 4, class: "refusal" }, reason))));
}

// All relations that were measured on this mesh, by mesh.
const measurements = new WeakMap();

// The times of all relations measured so far, if there are several: the fastest structure of each is bold.
function matrix({ subject, structures }) {
  const done = [...measurements.get(subject) ?? []];
  if (done.length < 2) return null;
  const cell = (structure, times) => {
    const found = times.find((one) => one.structure === structure);
    const isFastest = found && found.ns === Math.min(...times.map(({ ns }) => ns));
    return el("td", { class: isFastest && "fastest" }, found ? timeText(found.ns) : "–");
  };
  const short = (relation) => relation.split("_").map((word) => word[0].toUpperCase()).join("");
  return el("table", { class: "list matrix", id: "measured" },
    el("caption", {}, "measured on this mesh"),
    el("tr", {}, el("th", {}, "structure"), done.map(([relation]) => el("th", { title: relation }, short(relation)))),
    structures.map((structure) => el("tr", {}, el("th", { scope: "row" }, structure), done.map(([, times]) => cell(structure, times)))));
}

function timeText(ns) {
  const [value, unit] = ns < 1e3 ? [ns, "ns"] : ns < 1e6 ? [ns / 1e3, "µs"] : [ns / 1e6, "ms"];
  return `${value.toPrecision(3)} ${unit}`;
}

async function measure(explorer) {
  const { engine, structures, subject, view: { relation } } = explorer;
  const report = (text) => { document.getElementById("measuring").textContent = ` ${text}`; };
  const refused = [];
  const counts = new Map();
  for (const structure of structures) {
    report(`preparing ${structure} …`);
    const count = await queriesFor(engine, subject, structure, relation, refused);
    if (count) counts.set(structure, count);
  }
  const samples = new Map([...counts.keys()].map((structure) => [structure, []]));
  for (let round = 1; round <= ROUNDS; round += 1) {
    report(`round ${round} of ${ROUNDS} …`);
    for (const structure of shuffled([...counts.keys()])) {
      const count = counts.get(structure);
      const { ms } = await sweep(engine, subject, structure, relation, count);
      samples.get(structure).push((ms * 1e6) / count);
    }
  }
  const times = [...samples].map(([structure, values]) => {
    const sorted = values.sort((a, b) => a - b);
    const at = (part) => sorted[Math.round(part * (sorted.length - 1))];
    return { structure, ns: at(0.5), low: at(0.25), high: at(0.75) };
  });
  if (!measurements.has(subject)) measurements.set(subject, new Map());
  measurements.get(subject).set(relation, times);
  explorer.measured = { relation, subject, times, refused };
  explorer.tell("all");
}

// The number of queries that take about as long as a sample; null for a structure that cannot hold the mesh.
async function queriesFor(engine, subject, structure, relation, refused) {
  for (let count = 1; ; count *= 4) {
    const { response, ms } = await sweep(engine, subject, structure, relation, count);
    if (response.refused.length) {
      refused.push(response.refused[0]);
      return null;
    }
    // The first call also builds the structure.
    if (count > 1 && (ms >= SAMPLE_MS / 4 || count >= MOST_QUERIES / 4)) {
      return Math.max(1, Math.min(MOST_QUERIES, Math.round((count * SAMPLE_MS) / Math.max(ms, 0.1))));
    }
  }
}

async function sweep(engine, subject, structure, relation, queries) {
  const response = await engine.ask(subject, { structures: [structure], ask: { sweep: { relation, queries } } });
  return { response, ms: engine.ms };
}

function shuffled(list) {
  for (let i = list.length - 1; i > 0; i -= 1) {
    const j = Math.floor(Math.random() * (i + 1));
    [list[i], list[j]] = [list[j], list[i]];
  }
  return list;
}
