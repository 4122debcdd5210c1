// The cards: one for each structure, with the steps of its query, and its tables.

import { el, button, count } from "./dom.js";
import { rowNumber } from "./timeline.js";

// Maximum number of results that a card lists: the last ones.
const MOST_RESULTS = 100;

// The rows that a card shows, by their names: { element, fields, values by column }. `moved` has the rows that an
// edit moved, and the names of their elements.
export class Rows extends Map {
  constructor(moved = []) {
    super();
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
    });
    this.tables.addEventListener("keydown", (event) => {
      const row = event.target.closest("tr[data-row]");
      if (row && event.key === "Enter") events.clickRow(structure, row.dataset.row);
    });
    this.rows = new Rows();
    this.changes = new Map();
    // The cells of a row of a stored table: "halves h5" -> cells.
    this.cells = new Map();
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
    const scrolled = [...this.tables.children].map((table) => table.scrollTop);
    this.tables.replaceChildren(...(records ?? []).map((table) => this.table(table)));
    this.tables.hidden = !records;
    [...this.tables.children].forEach((table, i) => { table.scrollTop = scrolled[i] ?? 0; });
    this.markChanges();
    for (const key of [...this.changes.keys()].reverse()) this.scrollTo(key);
  }

  table({ element, columns, total, rows }) {
    const head = columns.map((column) =>
      el("th", { title: column.about, scope: "col" }, column.name + (column.derived ? "†" : "")));
    const body = [];
    let before = -1;
    for (const row of rows) {
      const number = rowNumber(row.name);
      if (number > before + 1) body.push(gap(columns.length, number - before - 1));
      before = number;
      body.push(this.row(element, columns, row));
    }
    if (before + 1 < total) body.push(gap(columns.length, total - before - 1));
    return el("div", { class: "scroll" }, el("table", {},
      el("caption", {}, count(total, element)),
      el("thead", {}, el("tr", {}, el("th", {}), head)),
      el("tbody", {}, body)));
  }

  row(element, columns, { name, fields }) {
    const line = el("tr", { "data-row": name }, el("th", { scope: "row" }, this.rows.nameOf(name)));
    if (fields.length === 0) {
      line.append(el("td", { colSpan: columns.length, class: "deleted" }, "deleted"));
    }
    fields.forEach((field, i) => {
      const { table, derived } = columns[i];
      const cell = el("td", { class: derived && "derived", title: field.length > 12 && field }, shortened(field));
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
    for (const [key, change] of this.changes) {
      const cells = this.cells.get(key);
      if (!cells) continue;
      const kind = !change.before ? "made" : !change.after ? "removed" : null;
      if (kind) {
        for (const cell of cells) cell.classList.add("changed", kind);
        if (kind === "removed") cells[0].textContent = `deleted, was ${change.before.join(", ")}`;
        continue;
      }
      change.after.forEach((value, i) => {
        if (!cells[i] || value === change.before[i]) return;
        cells[i].classList.add("changed");
        cells[i].replaceChildren(el("s", {}, change.before[i]), " ", value);
      });
    }
  }

  // Shows the steps of a query or walk; without one, none.
  follow(timeline) {
    this.timeline = timeline;
    const lines = timeline ? timeline.answer.algorithm : [];
    this.code.replaceChildren(...lines.map((line) => el("li", {}, line)));
    this.code.hidden = lines.length === 0;
    this.now.hidden = this.results.hidden = !timeline;
    this.first = new Map();
    for (const key of timeline ? this.cells.keys() : []) {
      const [table, row] = key.split(/ (?=\S+$)/);
      this.first.set(key, timeline.firstRead(table, row));
    }
    this.lit = new Map();
    for (const cells of this.cells.values()) for (const cell of cells) cell.classList.remove("read-now", "read");
  }

  // Shows one time.
  at(time) {
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
    const line = found?.step.line ?? null;
    [...this.code.children].forEach((item, i) => item.classList.toggle("marked", i === line));
    this.now.replaceChildren(...sentence(found, this.rows, this.records ?? []));
    const results = this.timeline.resultsAt(time);
    const isDone = time >= this.timeline.length;
    const listed = results.length > MOST_RESULTS ? `… ${results.slice(-MOST_RESULTS).join(", ")}` : results.join(", ");
    this.results.textContent = results.length || isDone ? `${isDone ? "all results" : "results"}: ${listed || "none"}` : "";
    this.current = key;
  }

  // Scrolls the tables to the row of the last step: after all cards have changed, so that the page is laid out once.
  reveal() {
    if (this.timeline) this.scrollTo(this.current);
  }

  // Scrolls the tables so that a row can be seen. Only the tables move, not the page.
  scrollTo(key) {
    const cells = this.cells.get(key);
    if (!cells) return;
    const table = cells[0].closest(".scroll");
    const [box, inside] = [table.getBoundingClientRect(), cells[0].getBoundingClientRect()];
    if (inside.top < box.top + 40 || inside.bottom > box.bottom - 8) {
      table.scrollTop += inside.top - box.top - box.height / 2;
    }
    const [wide, row] = [this.tables.getBoundingClientRect(), cells[0].parentElement.firstChild.getBoundingClientRect()];
    const end = cells.at(-1).getBoundingClientRect().right;
    if (end > wide.right || row.left < wide.left) this.tables.scrollLeft += row.left - wide.left - 4;
  }
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
