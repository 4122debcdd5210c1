// The cards: one for each structure, with the steps of its query, and its tables.

import { el, button, count } from "./dom.js";
import { writeSentence } from "./edit-steps.js";
import { rowNumber } from "./timeline.js";

// Maximum number of results that a card lists: the last ones.
const MOST_RESULTS = 100;

// Where headings are parted if there is little room.
const PARTED = { opposite: "oppo\u00adsite", triangle: "tri\u00adangle" };

// The rows that a card shows, by their names: { element, fields, values by column }. `moved` has the rows that an
// edit moved, and the names of their elements.
export class Rows extends Map {
  constructor(moved = []) {
    super();
    this.moved = moved;
    const elements = new Map(moved);
    // The name of the element in a row of vertices or faces.
    this.elementOf = (row) => elements.get(row) ?? row;
    // The name of a row, and of its element if this has another name.
    this.nameOf = (row) => (elements.has(row) ? `${row} = ${elements.get(row)}` : row);
  }
}

export class Card {
  constructor(structure, events) {
    this.structure = structure;
    this.heading = el("h3", {}, button(structure, () => events.focus(structure)));
    this.state = el("span", { class: "state" });
    this.reason = el("p", { class: "refusal" });
    this.code = el("ol", { class: "code" });
    this.now = el("p", { class: "now" });
    this.results = el("p", { class: "results" });
    this.tables = el("div", { class: "tables", tabindex: "0", "aria-label": `tables of ${structure}` });
    this.element = el("section", { class: "card", "data-structure": structure, style: `--colour: var(--${structure}, var(--other))` },
      el("header", {}, this.heading, this.state), this.reason, this.code, this.now, this.results, this.tables);
    this.tables.addEventListener("click", (event) => {
      const row = event.target.closest("tr[data-row]");
      if (row) events.clickRow(structure, row.dataset.row);
      if (row && event.target.closest("td")) events.clickCell(structure, event.target.closest("td"));
    });
    this.tables.addEventListener("keydown", (event) => {
      const row = event.target.closest("tr[data-row]");
      if (!row || event.key !== "Enter") return;
      events.clickRow(structure, row.dataset.row);
      if (event.target.closest("td")) events.clickCell(structure, event.target.closest("td"));
    });
    this.rows = new Rows();
    this.changes = new Map();
    // The cells of a row of a stored table: "halves h5" -> cells.
    this.cells = new Map();
    // The tables with their rows in the order of their numbers: { body, lines }.
    this.bodies = [];
  }

  // Shows the tables. `changes` has the rows that the last edit changed: "halves h5" -> change.
  show({ records, moved, refusal, state, changes }) {
    this.reason.textContent = refusal ?? "";
    this.reason.hidden = !refusal;
    this.state.textContent = state ?? "";
    this.element.classList.toggle("stopped", Boolean(state));
    // The same tables need not be made again.
    if (this.records === records && this.changes.size === 0 && changes.size === 0) return;
    this.records = records;
    this.changes = changes;
    this.rows = new Rows(moved);
    this.cells.clear();
    this.bodies = [];
    this.tables.replaceChildren(...(records ?? []).map((table) => this.table(table)));
    this.tables.hidden = !records;
    this.markChanges();
    this.arrange([...this.changes.keys()]);
    if (this.changes.size) this.tables.scrollTop = 0;
  }

  table({ element, columns, total, rows }) {
    const head = columns.map((column, i) =>
      el("th", { title: column.about, scope: "col", class: isSpare(element, columns, rows, i) && "spare" },
        el("span", {}, (PARTED[column.name] ?? column.name) + (column.derived ? "†" : ""))));
    const body = [];
    let before = -1;
    for (const row of rows) {
      const number = rowNumber(row.name);
      if (number > before + 1) body.push(gap(columns.length, number - before - 1));
      before = number;
      body.push(this.row(element, columns, row, rows));
    }
    if (before + 1 < total) body.push(gap(columns.length, total - before - 1));
    const lines = el("tbody", {}, body);
    this.bodies.push({ body: lines, lines: body });
    return el("table", { class: columns.length < 3 && "narrow" },
      el("caption", {}, count(total, element)),
      el("thead", {}, el("tr", {}, el("th", {}), head)),
      lines);
  }

  row(element, columns, { name, fields }, rows) {
    const line = el("tr", { "data-row": name }, el("th", { scope: "row" }, this.rows.nameOf(name)));
    if (fields.length === 0) {
      line.append(el("td", { colSpan: columns.length, class: "deleted" }, "deleted"));
    }
    fields.forEach((field, i) => {
      const { table, derived } = columns[i];
      const kind = derived ? "derived" : isSpare(element, columns, rows, i) && "spare";
      const cell = el("td", { class: kind, title: field.length > 12 && field }, shortened(field));
      line.append(cell);
      // A field that is not stored is not read.
      if (!derived) this.keep(`${table} ${name}`, cell);
    });
    if (fields.length === 0) for (const { table } of columns) this.keep(`${table} ${name}`, line.lastChild);
    const values = Object.fromEntries(columns.map((column, i) => [column.name, fields[i]]));
    this.rows.set(name, { element, fields, values });
    return line;
  }

  keep(key, cell) {
    if (!this.cells.has(key)) this.cells.set(key, []);
    this.cells.get(key).push(cell);
  }

  // Marks what the last edit changed, with the values before.
  markChanges() {
    this.shownAs = new Map();
    this.deletedIn = new Map();
    const last = [...this.changes].reverse().sort(([, a], [, b]) => Number(a.written) - Number(b.written));
    for (const [key, { before }] of last) if (before) this.deletedIn.set(this.cells.get(key)?.[0], key);
    for (const [key, change] of this.changes) this.showChange(key, change, true);
    for (const { body } of this.bodies) body.parentElement.classList.toggle("moved", body.querySelector(".spare.changed") !== null);
  }

  // Shows a row before an edit, or after it with what it changed.
  showChange(key, { before, after }, isAfter) {
    const cells = this.cells.get(key);
    if (!cells || this.shownAs.get(key) === isAfter) return;
    this.shownAs.set(key, isAfter);
    const kind = !before ? "made" : !after ? "removed" : null;
    cells.forEach((cell, i) => {
      // The one cell of a deleted row stands for all its tables: it has the values of the first that is written.
      if (cell.classList.contains("deleted") && (!before || this.deletedIn.get(cell) !== key)) return;
      const [old, now] = [before?.[i], after?.[i]].map((value) => (value === undefined ? value : shortened(value)));
      cell.classList.toggle("changed", isAfter && (kind !== null || old !== now));
      if (kind) cell.classList.toggle(kind, isAfter);
      if (!isAfter) cell.textContent = !before ? "–" : after ? old : before.join(", ");
      else if (kind === "removed") cell.textContent = `deleted, was ${before.join(", ")}`;
      else if (kind === "made" || old === now) cell.textContent = now ?? "";
      else cell.replaceChildren(el("s", {}, old), " ", now);
    });
  }

  // Puts the rows of some keys before the others of their tables, in the order of the keys. The others keep theirs.
  arrange(keys) {
    const first = new Set(keys.flatMap((key) => this.cells.get(key)?.[0].parentElement ?? []));
    const focused = this.tables.contains(document.activeElement) ? document.activeElement : null;
    for (const { body, lines } of this.bodies) {
      const own = [...first].filter((line) => line.parentElement === body);
      body.querySelector(".last-first")?.classList.remove("last-first");
      own.at(-1)?.classList.add("last-first");
      body.parentElement.classList.toggle("touched", this.changes.size > 0 && own.length > 0);
      let at = body.firstElementChild;
      for (const line of [...own, ...lines.filter((other) => !first.has(other))]) {
        if (line === at) at = at.nextElementSibling;
        else body.insertBefore(line, at);
      }
    }
    // An element that moves loses the focus.
    if (focused !== document.activeElement) focused?.focus({ preventScroll: true });
  }

  // Shows the steps of a query or walk, or the writes of an edit; without one, none.
  follow(timeline, steps) {
    this.timeline = timeline;
    this.steps = steps;
    this.now.replaceChildren();
    const lines = timeline ? timeline.answer.algorithm : [];
    this.code.replaceChildren(...lines.map((line) => el("li", { title: line }, line)));
    this.code.hidden = lines.length === 0;
    this.now.hidden = !timeline && !steps?.length;
    this.results.hidden = !timeline;
    this.first = new Map();
    for (const key of timeline ? this.cells.keys() : []) {
      const [table, row] = key.split(/ (?=\S+$)/);
      this.first.set(key, timeline.firstRead(table, row));
    }
    // The rows that are read, in the order of their first reads.
    this.readKeys = [...this.first.keys()].filter((key) => this.first.get(key) < Infinity)
      .sort((a, b) => this.first.get(a) - this.first.get(b));
    this.arranged = null;
    if (!timeline && this.changes.size === 0) this.arrange([]);
    this.lit = new Map();
    for (const cells of this.cells.values()) for (const cell of cells) cell.classList.remove("read-now", "read");
  }

  // Shows one time; `isEnd` if it is the end for the structure in front.
  at(time, isEnd) {
    if (this.steps) this.atWrite(isEnd ? this.steps.length : time, isEnd);
    if (!this.timeline) return;
    const found = this.timeline.at(time);
    const read = this.timeline.readAt(time);
    const key = read && `${read.step.table} ${read.row}`;
    for (const [name, cells] of this.cells) {
      const want = name === key ? "read-now" : this.first.get(name) <= time ? "read" : "";
      if ((this.lit.get(name) ?? "") === want) continue;
      this.lit.set(name, want);
      for (const cell of cells) {
        cell.classList.toggle("read-now", want === "read-now");
        cell.classList.toggle("read", want === "read");
      }
    }
    const known = this.readKeys.filter((name) => this.first.get(name) <= time);
    if (known.length !== this.arranged) this.arrange(known);
    this.arranged = known.length;
    const line = found?.step.line ?? null;
    [...this.code.children].forEach((item, i) => item.classList.toggle("marked", i === line));
    this.now.replaceChildren(...sentence(found, this.rows, this.records ?? []));
    const results = this.timeline.resultsAt(time);
    const isDone = time >= this.timeline.length;
    const listed = results.length > MOST_RESULTS ? `… ${results.slice(-MOST_RESULTS).join(", ")}` : results.join(", ");
    this.results.textContent = results.length || isDone ? `${isDone ? "all results" : "results"}: ${listed || "none"}` : "";
    this.current = key;
  }

  // Shows the rows of an edit at one time. The row at hand is lit until the end.
  atWrite(time, isEnd) {
    for (const [key, change] of this.changes) this.showChange(key, change, this.steps.isWritten(key, time));
    const write = this.steps.at(time);
    const key = write && !isEnd ? `${write.table} ${write.row}` : null;
    if (this.current !== key) {
      for (const cell of this.cells.get(this.current) ?? []) cell.classList.remove("read-now");
      for (const cell of this.cells.get(key) ?? []) cell.classList.add("read-now");
    }
    this.current = key;
    this.now.replaceChildren(...writeSentence(write));
  }

  // Scrolls the tables to the row of the last step: after all cards have changed, so that the page is laid out once.
  reveal() {
    if (!this.timeline && !this.steps) return;
    this.scrollTo(this.current);
    if (this.timeline) this.showLine();
  }

  // Scrolls the tables so that a row can be seen. Only the tables move, not the page.
  scrollTo(key) {
    const row = this.cells.get(key)?.[0].parentElement;
    if (!row) return;
    const head = row.closest("table").tHead.getBoundingClientRect().height;
    const [box, inside] = [this.tables.getBoundingClientRect(), row.getBoundingClientRect()];
    if (inside.top < box.top + head) this.tables.scrollTop += inside.top - box.top - head - 20;
    else if (inside.bottom > box.bottom - 4) this.tables.scrollTop += inside.bottom - box.bottom + Math.min(60, box.height / 3);
  }

  // Scrolls the program to its line at hand, where only some of its lines have room.
  showLine() {
    const line = this.code.querySelector(".marked");
    this.code.scrollTop = line ? line.offsetTop - this.code.offsetTop - line.offsetHeight : 0;
  }
}

// Whether a column can be left out where there is no room: the coordinates of vertices, if their table also has a stored
// column that connects elements.
function isSpare(element, columns, rows, i) {
  const isPosition = rows.some(({ fields }) => fields[i]?.startsWith("("));
  return element === "vertex" && isPosition && columns.some((column, k) => k !== i && !column.derived);
}

// A field whose coordinates have four digits at most.
function shortened(field) {
  if (!field.startsWith("(")) return field;
  return field.replace(/-?[\d.]+(e-?\d+)?/g, (number) => String(Number(Number(number).toPrecision(4))));
}

function gap(columns, rows) {
  return el("tr", { class: "gap" }, el("td", { colSpan: columns + 1 }, `… ${count(rows, "row")}`));
}

// What a step does, in words.
function sentence(found, rows, records) {
  if (!found) return ["not started"];
  const { step, offset } = found;
  if (step.step === "yield") return ["yields ", el("b", {}, step.result)];
  const row = `${step.row[0]}${rowNumber(step.row) + offset}`;
  const fields = step.fields.map(([name, value]) => `${name} ${value}`).join(", ");
  // A scan goes on after each result: the place is that in the table, not in the rows since the last result.
  const table = records.find(({ columns }) => columns.some((column) => column.table === step.table));
  const part = step.rows > 1 && table ? ` (row ${(rowNumber(row) + 1).toLocaleString("en")} of ${table.total.toLocaleString("en")})` : "";
  return ["reads ", el("b", {}, `${step.table} ${rows.nameOf(row)}`), `: ${step.reason.text}${part}`, fields ? ` → ${fields}` : ""];
}
