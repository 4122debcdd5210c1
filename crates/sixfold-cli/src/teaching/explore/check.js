// The panel of checks: which structures hold the mesh, its faults, and their repair.

import { button, count, el } from "./dom.js";

const diagnoses = new WeakMap();

// Asks for the verdicts and facts of the mesh.
export async function check(engine, shown) {
  const { subject } = shown;
  if (!diagnoses.has(subject)) {
    const { verdicts, faults } = await engine.ask(subject, { ask: "verdicts" });
    const { facts } = await engine.ask(subject, { ask: "facts" });
    const weld = await askWeld(engine, subject, 0);
    diagnoses.set(subject, { verdicts, faults, facts, tolerance: 0, weld });
  }
  shown.checked = diagnoses.get(subject);
}

// The names of a place of a fault.
export function namesOf(place) {
  const [kind, value] = Object.entries(place)[0];
  const list = [value].flat();
  if (kind === "edge") return [list.map((v) => `v${v}`).join("-")];
  return list.map((number) => `${kind[0]}${number}`);
}

export function checkPanel(explorer) {
  if (!explorer.checked) return [];
  const { verdicts, faults, facts } = explorer.checked;
  const repair = (structure) => button("repair", () => explorer.run(() => askRepair(explorer, structure)), { "data-repair": structure });
  return [
    el("div", { class: "grow columns" }, el("section", {},
      explorer.notes.length ? el("details", { open: true }, el("summary", {}, "reading the mesh"), explorer.notes.map((note) => el("p", {}, note))) : null,
      el("table", { class: "list", id: "verdicts" }, verdicts.map(({ backend, holds, reason }) => el("tr", { "data-structure": backend },
        el("th", { scope: "row" }, backend), el("td", { class: holds ? "good" : "refusal" }, holds ? "✓ holds the mesh" : `✗ ${reason} `, holds ? null : repair(backend))))),
      repairTable(explorer)),
      el("section", {}, el("h3", {}, faults.length ? "Faults and boundaries" : "No faults"),
      el("ul", { id: "faults" }, faults.map((fault) => faultItem(explorer, fault))),
      loopList(explorer),
      factsList(facts)),
    weldPart(explorer)),
  ];
}

function faultItem(explorer, { title, count: number, places, repairs }) {
  const shown = places.slice(0, 20);
  const links = shown.map((place) => {
    const names = namesOf(place);
    return button(names.join(" "), () => explorer.run(() => explorer.mark(names)), { class: "link" });
  });
  const all = button("mark all", () => explorer.run(() => explorer.mark(places.flatMap(namesOf))), { class: "link" });
  return el("li", {}, `${number.toLocaleString("en")} ${title}: `, links, number > shown.length ? " … " : " ", all,
    repairs.length ? el("span", { class: "hint" }, ` repaired by: ${repairs.join(", ")}`) : null);
}

// The boundary loops of the mesh, each with a button that marks it.
function loopList(explorer) {
  const loops = explorer.model.boundaryLoops();
  if (loops.length === 0) return null;
  const mark = (names) => () => explorer.run(() => explorer.mark(names));
  const shown = loops.slice(0, 20).map((loop) => button(count(loop.length, "edge"), mark(loop), { class: "link", "data-loop": "" }));
  return el("p", { id: "loops" }, `${count(loops.length, "boundary loop")}: `, shown, loops.length > shown.length ? " … " : " ",
    button("mark all", mark(loops.flat()), { class: "link" }));
}

function factsList(facts) {
  const { vertices, edges, faces, euler_characteristic: euler, orientable, consistently_oriented: isConsistent } = facts;
  const rows = [
    ["V − E + F", `${[vertices, edges, faces].map((value) => value.toLocaleString("en")).join(" − ").replace(/− (\S+)$/, "+ $1")} = ${euler}`],
    ["components", facts.components],
    ["boundary", facts.closed ? "closed" : count(facts.boundary_edges, "edge")],
    ["orientation", orientable ? (isConsistent ? "consistently oriented" : "orientable, but not all faces agree") : "not orientable"],
  ];
  if (Number.isInteger(facts.genus)) rows.push(["genus", facts.genus]);
  return el("div", {}, el("h3", {}, "The mesh"), el("table", { class: "list", id: "facts" },
    rows.map(([name, value]) => el("tr", {}, el("th", { scope: "row" }, name), el("td", {}, String(value))))));
}

async function askWeld(engine, subject, tolerance) {
  return (await engine.ask(subject, { ask: { weld: { tolerance } } })).weld;
}

// The largest tolerance of the slider, as a part of the radius of the mesh, and its steps: each ten of them are a tenth.
const MOST_TOLERANCE = 0.1;
const TOLERANCE_STEPS = 50;
// Maximum number of corners in the drawing, and the width of one.
const MOST_DRAWN = 40;
const CORNER_WIDTH = 24;

// The corners of all faces as a polygon soup stores them, and the vertices that they become.
function weldPart(explorer) {
  const { checked, subject, engine, model } = explorer;
  const toleranceAt = (step) => (step === 0 ? 0 : Number((MOST_TOLERANCE * model.radius * 10 ** ((step - TOLERANCE_STEPS) / 10)).toPrecision(2)));
  const stepOf = (tolerance) => (tolerance === 0 ? 0 : TOLERANCE_STEPS + Math.round(10 * Math.log10(tolerance / (MOST_TOLERANCE * model.radius))));
  const value = el("output", { id: "tolerance-value" }, String(checked.tolerance));
  const slider = el("input", { type: "range", id: "tolerance", min: "0", max: String(TOLERANCE_STEPS), value: String(stepOf(checked.tolerance)), "aria-label": "Tolerance" });
  const result = el("div", {}, weldResult(explorer));
  slider.addEventListener("input", () => { value.textContent = String(toleranceAt(Number(slider.value))); });
  slider.addEventListener("change", () => explorer.run(async () => {
    const tolerance = toleranceAt(Number(slider.value));
    const weld = await askWeld(engine, subject, tolerance);
    Object.assign(checked, { tolerance, weld });
    result.replaceChildren(...weldResult(explorer));
    explorer.mark([]);
  }));
  return el("section", { id: "weld" },
    el("h3", {}, "The soup as stored and welded"),
    el("p", { class: "hint" }, "A polygon soup stores the position of each corner of each face. Welding makes one vertex of the corners whose distance is at most the tolerance; 0 welds equal positions."),
    el("p", { class: "buttons" }, el("label", {}, "tolerance ", slider), value, el("span", { class: "hint" }, "units of the coordinates")),
    result);
}

// What welding does, as sentences and as a drawing.
function weldResult(explorer) {
  const { checked: { weld }, model } = explorer;
  const own = new Set(model.faces.flatMap((face) => face ?? []));
  const joined = own.size - weld.vertices;
  const changed = `${count(weld.faces_changed, "face")} ${weld.faces_changed === 1 ? "changes" : "change"} (fewer corners, or lost)`;
  return [
    el("p", { id: "weld-counts" }, el("b", {}, `${count(weld.corners, "corner")} → ${count(weld.vertices, "vertex")}`),
      joined > 0 ? el("span", { class: "refusal" }, `: ${own.size.toLocaleString("en")} different vertices become ${weld.vertices.toLocaleString("en")}, and ${changed}; a corner moves by up to ${Number(weld.largest_shift.toPrecision(3))}`)
        : `, and ${changed}`),
    weldDrawing(explorer, weld.map),
  ];
}

// Corners above, vertices below, and a line from each corner to its vertex. A vertex that is clicked marks its corners.
function weldDrawing(explorer, map) {
  const ends = explorer.model.faces.flatMap((face) => face ?? []);
  const room = Math.floor(((document.getElementById("panel")?.clientWidth || 600) - 40) / CORNER_WIDTH);
  const shown = map.slice(0, Math.min(MOST_DRAWN, Math.max(6, room)));
  const cornersOf = new Map();
  map.forEach((vertex, c) => cornersOf.set(vertex, [...cornersOf.get(vertex) ?? [], c]));
  const vertices = [...new Set(shown)];
  const width = Math.max(shown.length, 12) * CORNER_WIDTH;
  const [top, bottom] = [16, 112];
  const xOf = (i, length) => ((i + 0.5) * width) / length;
  // Markup makes elements of SVG without the address of their namespace.
  const frame = el("div", { class: "weld-map" });
  frame.innerHTML = "<svg></svg>";
  const svg = frame.firstChild;
  const draw = (tag, attributes, ...children) => {
    const element = document.createElementNS(svg.namespaceURI, tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...children);
    return element;
  };
  svg.setAttribute("viewBox", `0 0 ${width} ${bottom + 18}`);
  svg.style.maxWidth = `${width * 1.3}px`;
  svg.append(...shown.map((vertex, c) => draw("line", { "data-corner": c, "data-to": vertex, x1: xOf(c, shown.length), y1: top + 4, x2: xOf(vertices.indexOf(vertex), vertices.length), y2: bottom - 12 })));
  svg.append(...shown.map((_, c) => draw("text", { x: xOf(c, shown.length), y: top - 2 }, `c${c}`)));
  svg.append(...vertices.map((vertex, i) => {
    const corners = cornersOf.get(vertex);
    const names = [...new Set(corners.map((c) => `v${ends[c]}`))];
    const label = names.length > 1 ? `${names[0]}…` : names[0];
    const choose = () => {
      for (const one of svg.querySelectorAll("[data-vertex], [data-to]")) one.classList.toggle("chosen", (one.dataset.vertex ?? one.dataset.to) === String(vertex));
      explorer.run(() => explorer.mark(corners.map((c) => `c${c}`)));
    };
    const title = `${names.join(", ")}: ${count(corners.length, "corner")}, ${corners.slice(0, 30).map((c) => `c${c}`).join(", ")}`;
    const one = draw("g", { role: "button", tabindex: "0", "data-vertex": vertex, "aria-label": title },
      draw("title", {}, title), draw("circle", { cx: xOf(i, vertices.length), cy: bottom - 8, r: 5 }), draw("text", { x: xOf(i, vertices.length), y: bottom + 12 }, label));
    one.addEventListener("click", choose);
    one.addEventListener("keydown", (event) => event.key === "Enter" && choose());
    return one;
  }));
  const left = explorer.checked.weld.corners - shown.length;
  return el("div", {}, frame, el("p", { class: "hint" }, "Corners as the soup stores them, above, and their vertices. Click a vertex to mark its corners on the mesh.",
    left > 0 ? ` ${count(left, "more corner")} ${left === 1 ? "is" : "are"} not drawn.` : ""));
}

async function askRepair(explorer, structure) {
  const { answers, refused } = await explorer.engine.ask(explorer.subject, { structures: [structure], ask: "repair" });
  if (refused.length) throw new Error(refused[0].reason);
  explorer.checked.repair = { structure, answer: answers[0] };
  explorer.tell("all");
}

function repairTable(explorer) {
  if (!explorer.checked.repair) return null;
  const { structure, answer } = explorer.checked.repair;
  const changes = (counts) => Object.entries(counts).filter(([, value]) => value > 0)
    .map(([name, value]) => `${name.replaceAll("_", " ")} ${value}`).join(", ") || "nothing to do";
  return el("div", { id: "repair" },
    el("p", {}, `The repair for ${structure}: `),
    el("ol", {}, answer.steps.map(({ step, counts, left }) =>
      el("li", {}, `${step}: ${changes(counts)}`, left.length ? ` (left: ${left.join("; ")})` : ""))),
    button("take the repaired mesh", () => explorer.run(() =>
      explorer.replace(answer, `repaired for ${structure}`, { tab: "check" })), { class: "main", id: "take-repair" }));
}
