// The panel of checks: which structures hold the mesh, its faults, and their repair.

import { button, count, el } from "./dom.js";

const diagnoses = new WeakMap();

// Asks for the verdicts and facts of the mesh.
export async function check(engine, shown) {
  const { subject } = shown;
  if (!diagnoses.has(subject)) {
    const { verdicts, faults } = await engine.ask(subject, { ask: "verdicts" });
    const { facts } = await engine.ask(subject, { ask: "facts" });
    diagnoses.set(subject, { verdicts, faults, facts });
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
      factsList(facts))),
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
