// The panel of measurements: the time of a query on each structure, in this browser, and the memory of each structure.

import { button, count, el } from "./dom.js";
import { relations } from "./query.js";

const ROUNDS = 9;
// Milliseconds of one sample: much longer than the steps of the clock of a browser.
const SAMPLE_MS = 12;
const MOST_QUERIES = 4e6;

export function measurePanel(explorer) {
  const { view: { relation }, state } = explorer;
  const measured = explorer.measured?.relation === relation && explorer.measured.subject === explorer.subject ? explorer.measured : null;
  return [
    el("div", { class: "grow columns" }, el("section", {},
      el("h3", {}, "Time"),
      el("div", { class: "beside" }, relations(explorer),
        el("p", {}, "The time of ", el("b", {}, relation), " from one element to the next, on ", state.name, ". ",
          button("Measure", () => explorer.run(() => measure(explorer)), { class: "main", id: "measure" }),
          el("span", { id: "measuring", role: "status" }))),
      measured ? results(measured) : null,
      matrix(explorer),
      el("p", { class: "hint" }, `${ROUNDS} rounds, each structure once in each round, in random order; the median of each structure. `,
        "These times are those of WebAssembly in this browser on this machine. Compiled programs are faster, and other ratios are possible: ",
        el("code", {}, `sixfold study MESH --operations ${relation}`), " measures them.")),
    memoryPart(explorer)),
  ];
}

// The answers about memory, by mesh.
const memories = new WeakMap();

// Asks for the memory of each structure.
export async function askMemory(engine, shown) {
  const { subject } = shown;
  if (!memories.has(subject)) {
    const { answers, refused } = await engine.ask(subject, { ask: "memory" });
    memories.set(subject, { answers, refused });
  }
  shown.memory = memories.get(subject);
}

// The structures whose tables are open: they stay open when the panel is made again.
const openTables = new Set();

function memoryPart(explorer) {
  if (!explorer.memory) return null;
  const { model, memory: { answers, refused }, records } = explorer;
  const most = Math.max(...answers.map(({ bytes }) => bytes));
  const rows = [...answers].sort((a, b) => a.bytes - b.bytes).map((answer) => {
    const { backend: structure, bytes, formula, symbols, tables } = answer;
    const toggle = (event) => (event.target.open ? openTables.add(structure) : openTables.delete(structure));
    const perVertex = model.vertexCount ? `, ${Number((bytes / model.vertexCount).toPrecision(3)).toLocaleString("en")} per vertex` : "";
    return el("details", { "data-structure": structure, style: `--colour: var(--${structure}, var(--other))`, open: openTables.has(structure), ontoggle: toggle },
      el("summary", { "data-memory": structure },
        el("span", { class: "name" }, structure), el("span", { class: "size" }, `${count(bytes, "byte")}${perVertex}`),
        el("span", { class: "track" }, el("span", { class: "bar", style: `width: ${(100 * bytes) / most}%` })),
        el("span", { class: "formula" }, formula, " = ", inNumbers(formula, symbols))),
      memoryTable(tables, records.get(structure)?.records ?? []));
  });
  const known = new Map(answers.flatMap(({ symbols }) => symbols.map((one) => [one.symbol, one])));
  const meanings = [...known.values()].map(({ symbol, element, count: number }) => `${symbol} = ${count(number, element)}`);
  return el("section", { id: "memory" },
    el("h3", {}, "Memory"),
    el("p", { class: "hint" }, "The bytes of all tables, without edits. Open a structure to see its tables. ", `${meanings.join(", ")}.`),
    rows, refused.map(({ backend, reason }) => el("p", { "data-structure": backend, class: "refusal" }, reason)));
}

// A formula such as `16 V + 12 H + 4` with the counts of this mesh: `16 · 8 + 12 · 24 + 4`.
function inNumbers(formula, symbols) {
  const counts = new Map(symbols.map(({ symbol, count: number }) => [symbol, number]));
  return formula.replace(/ ([A-Z])\b/g, (_, symbol) => ` · ${(counts.get(symbol) ?? 0).toLocaleString("en")}`);
}

// The tables of a structure, and what is in a row of each.
function memoryTable(tables, records) {
  return el("table", { class: "list" },
    el("tr", {}, ["table", "rows", "bytes of a row", "bytes"].map((text) => el("th", {}, text))),
    tables.map(({ table, row_bytes: rowBytes, rows, rows_formula: formula, bytes }) => el("tr", { "data-table": table },
      el("th", { scope: "row" }, table),
      el("td", { class: "count" }, formula === String(rows) ? rows.toLocaleString("en") : `${formula} = ${rows.toLocaleString("en")}`),
      el("td", {}, String(rowBytes), el("div", { class: "hint" }, fieldsOf(table, rowBytes, records))),
      el("td", { class: "count" }, bytes.toLocaleString("en")))));
}

// What the bytes of a row are: its stored fields, numbers of 4 bytes each but for the three coordinates of a position.
function fieldsOf(table, rowBytes, records) {
  const columns = records.flatMap((record) => record.columns).filter((column) => column.table === table && !column.derived);
  const names = columns.map(({ name, about }) => el("span", { title: about }, name));
  const listed = names.flatMap((name, i) => (i ? [", ", name] : [name]));
  if (columns.length === 1 && columns[0].name === "position") return ["3 coordinates of 4 bytes: ", ...listed];
  if (columns.length === 0) return rowBytes === 4 ? "a number of 4 bytes: where the row begins in another table" : "";
  if (4 * columns.length === rowBytes) return [`${count(columns.length, "field")} of 4 bytes: `, ...listed];
  return listed;
}

function results({ times, refused }) {
  const fastest = Math.min(...times.map(({ ns }) => ns));
  const slowest = Math.max(...times.map(({ ns }) => ns));
  // Bars are logarithmic: the slowest can take a thousand times as long as the fastest.
  const width = (ns) => 4 + 92 * (slowest > fastest ? Math.log(ns / fastest) / Math.log(slowest / fastest) : 0);
  const rows = [...times].sort((a, b) => a.ns - b.ns).map(({ structure, ns, low, high }) =>
    el("tr", { "data-structure": structure, style: `--colour: var(--${structure}, var(--other))` },
      el("th", { scope: "row" }, structure),
      el("td", { class: "count", title: `half of the rounds: ${timeText(low)} to ${timeText(high)}` }, timeText(ns)),
      el("td", { class: "count" }, `${(ns / fastest).toPrecision(3)}×`),
      el("td", { class: "wide" }, el("span", { class: "bar", style: `width: ${width(ns)}%` }))));
  return el("table", { class: "list bars", id: "times" },
    el("tr", {}, ["structure", "a query", "ratio", "time, logarithmic"].map((text) => el("th", {}, text))),
    rows, refused.map(({ backend, reason }) => el("tr", {}, el("th", { scope: "row" }, backend), el("td", { colSpan: 3, class: "refusal" }, reason))));
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
