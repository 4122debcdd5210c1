// Prints the requests of the explorer for what the lessons show: node lessons.mjs LESSONS.json
import { readFileSync } from "node:fs";

const lessons = JSON.parse(readFileSync(process.argv[2], "utf8"));
const situations = lessons.flatMap(({ parts }) => parts.map((part) => part.command?.situation).filter((shown) => shown));
if (situations.length === 0) throw new Error("no lesson shows anything");

// What the tab of a situation asks.
function asked({ tab, relation, element, walk, scheme, level }, edits) {
  const query = { relation: relation ?? "vertex_vertices", element: element ?? "v0" };
  if (tab === "walk") return [{ walk: { walk, expect: query } }];
  if (tab === "edit") return edits.map((edit) => ({ edit }));
  if (tab === "check") return ["verdicts", "facts", "repair"];
  if (tab === "subdivide") return [{ subdivide: { scheme, levels: level } }, { stencil: { scheme, level, point: 0 } }];
  return [{ trace: query }];
}

for (const { subject, edits, view } of situations) {
  const print = (request) => console.log(JSON.stringify(request));
  print({ ...subject, ask: { tables: {} } });
  const isEdit = view.tab === "edit";
  for (const [i, ask] of asked(view, edits).entries()) print({ ...subject, edits: isEdit ? edits.slice(0, i) : edits, ask });
  print({ ...subject, edits, ask: "geometry" });
}
