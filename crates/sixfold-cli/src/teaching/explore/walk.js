// The panel of walks: a walk that the student writes, in the words of one structure.

import { button, count, el, select, withCode } from "./dom.js";
import { elementField, relations, wordsOf } from "./query.js";

// A walk around v0 on each structure, as far as its fields lead.
const AROUND = {
  "polygon-soup": "yield face(c0)",
  "indexed-face-set": "yield vertex(c0)",
  "face-vertex": "yield face(first(v0))",
  "winged-edge": `e = edge(v0)
repeat {
  if start(e) = v0 { yield end(e); e = left_prev(e) }
  else { yield start(e); e = right_prev(e) }
}`,
  "half-edge": `h = leaving(v0)
repeat {
  yield target(h)
  h = next(twin(h))
}`,
  "corner-table": `c = next(corner(v0))
repeat {
  yield vertex(c)
  c = prev(opposite(c))
}`,
};

// The walk around an element on a structure.
const around = (structure, element) =>
  (AROUND[structure] ?? "").replaceAll("v0", /^v\d+$/.test(element) ? element : "v0");

// The walk to run: that around an element on another structure becomes that on this one.
export function walkFor(walk, structure, element) {
  const isShown = walk.trim() !== "" && Object.values(AROUND).includes(walk.replace(/\bv\d+/g, "v0"));
  return isShown ? around(structure, element) : walk;
}

export function walkPanel(explorer) {
  const { walk, focus, relation, element } = explorer.view;
  const text = el("textarea", { rows: 5, "aria-label": "Walk", spellcheck: "false", id: "walk-text" });
  text.value = walk;
  text.addEventListener("input", () => { explorer.view.walk = text.value; });
  const run = () => explorer.run(() => explorer.look({ walk: text.value }));
  const solution = around(focus, element);
  const isSolution = relation === "vertex_vertices" && solution.includes("repeat");
  const hint = el("p", { class: "hint", id: "walk-hint", role: "status" });
  const show = () => explorer.run(() => explorer.look({ walk: solution }));
  const columns = (explorer.base.records.get(focus)?.records ?? []).flatMap((table) => table.columns);
  const isOnly = ({ table }) => columns.filter((column) => column.table === table).length === 1;
  const words = columns.flatMap((column) => (isOnly(column) ? [column.name, column.table] : [column.name]));
  const answer = explorer.timelines.get(focus)?.answer;
  const result = explorer.failed
    ? el("p", { class: "refusal", id: "walk-result" }, explorer.failed)
    : walkResult(answer);
  return [
    relations(explorer),
    el("div", { class: "grow" },
      el("p", {}, elementField(explorer)),
      el("p", {}, "Write a walk in the words of ",
        select(explorer.structures, focus, (name) => explorer.run(() => explorer.look({ focus: name })), { "aria-label": "Structure" }),
        ` that yields ${wordsOf(relation)} ${element}, and nothing else: `, button("Run", run, { class: "main", id: "run-walk" })),
      text,
      walk.trim() === "" ? null : result,
      el("p", { class: "buttons" },
        button("Hint", () => { hint.replaceChildren(...withCode(`Begin with \`${solution.split("\n")[0]}\`.`)); }, { id: "hint" }),
        button(isSolution ? "Show a solution" : `Show a walk from ${element} as far as the fields lead`, show, { id: "solution" })),
      hint,
      el("p", { class: "hint" }, "Fields: ", [...new Set(words)].map((name) => name.replace(/[ -]/g, "_")).join(", "),
        ...withCode(". Statements: `h = VALUE`, `yield VALUE`, `repeat { … }`, `if VALUE = VALUE { … } else { … }`; a value is a name, a row such as `v3`, `none`, or `next(h)`."))),
  ];
}

function walkResult(answer) {
  if (!answer) return null;
  const { stopped, expected } = answer;
  const parts = [`${count(answer.reads, "read")}, ${count(answer.cache_lines, "cache line")}, ${count(answer.bytes, "byte")}. `];
  if (stopped) parts.push(`The walk stopped: ${stopped}. `);
  if (expected) parts.push(expected.verdict);
  const isRight = expected && [expected.missing, expected.extra, expected.repeated].every((names) => names.length === 0);
  return el("p", { id: "walk-result", class: isRight && !stopped ? "good" : "refusal" }, parts.join(""));
}
