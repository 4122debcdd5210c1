// The panel of queries: the chosen element, and Weiler's nine relations.

import { button, el } from "./dom.js";

const KINDS = ["vertex", "edge", "face"];
const SHORT = { vertex: "V", edge: "E", face: "F" };
const PLURAL = { vertex: "vertices", edge: "edges", face: "faces" };

// A relation in words: `the faces around`.
export function wordsOf(relation) {
  const [from, to] = relation.split("_");
  const between = { vertex: "around", edge: "at", face: "of" }[from];
  return `the ${to} ${from === "vertex" && to === "vertices" ? "beside" : between}`;
}

// The field with the chosen element.
export function elementField(explorer) {
  const field = el("input", { value: explorer.view.element, size: 9, "aria-label": "Element", id: "element", spellcheck: "false" });
  const take = () => explorer.run(async () => {
    const name = explorer.model.nameOf(field.value);
    if (!name) throw new Error(`the mesh has no element ${field.value}: write v3 for a vertex, v0-v1 for an edge, f2 for a face`);
    await explorer.choose(name);
  });
  field.addEventListener("change", take);
  return el("label", {}, "element ", field);
}

// The relation that starts from a kind of element, and ends as another one does.
export function relationFor(relation, kind) {
  const end = relation.split("_")[1];
  return `${kind}_${Object.values(PLURAL).includes(end) ? end : PLURAL.vertex}`;
}

// Weiler's nine relations (Weiler, 1985): rows start from a kind of element, columns end at one.
export function relations(explorer) {
  const { relation } = explorer.view;
  const cell = (from, to) => {
    const name = `${from}_${PLURAL[to]}`;
    const choose = () => explorer.run(() => explorer.chooseRelation(name));
    return el("td", {}, button(`${SHORT[from]}${SHORT[to]}`, choose, {
      title: `${wordsOf(name)} ${from === "edge" ? "an" : "a"} ${from} (${name})`,
      "aria-label": `${wordsOf(name)} ${from === "edge" ? "an" : "a"} ${from}, ${SHORT[from]}${SHORT[to]}`,
      "data-relation": name,
      "aria-pressed": String(name === relation),
    }));
  };
  return el("table", { class: "relations", "aria-label": "Relation" },
    KINDS.map((from) => el("tr", {}, KINDS.map((to) => cell(from, to)))));
}

export function queryPanel(explorer) {
  const { relation, element } = explorer.view;
  return [
    relations(explorer),
    el("div", { class: "grow" },
      el("p", {}, elementField(explorer)),
      el("p", {}, el("b", {}, wordsOf(relation)), ` ${element} (${relation}). Click an element on the mesh, choose a relation, and step: `,
        "each structure reads the rows that it needs.")),
  ];
}
