// The writes of an edit on one structure in time: each row that is written takes one unit.

export class EditSteps {
  // `answer` is that of the engine for an edit on a structure.
  constructor({ rows }) {
    this.writes = rows.filter(({ written }) => written);
    this.length = this.writes.length;
    this.numbers = new Map(this.writes.map(({ table, row }, i) => [`${table} ${row}`, i]));
    // Rows that are not written change with their table, such as those of a column that the edit adds, or at the end.
    for (const { table, row, written } of rows) {
      const first = this.writes.findIndex((write) => write.table === table);
      if (!written) this.numbers.set(`${table} ${row}`, first < 0 ? this.length - 1 : first);
    }
  }

  // The row that is written last up to a time: { table, row, columns, before, after }, or null.
  at(time) {
    return this.writes[Math.min(time, this.length) - 1] ?? null;
  }

  // Whether a row has its value after the edit at a time.
  isWritten(key, time) {
    return (this.numbers.get(key) ?? -1) < time;
  }
}

const known = new WeakMap();

// The writes of the last edit on a structure, if the tab of edits is open. Null if there are none.
export function editSteps({ view, lastEdit }, structure) {
  const answer = view.tab === "edit" ? lastEdit?.answers.get(structure) : null;
  if (!answer) return null;
  if (!known.has(answer)) known.set(answer, new EditSteps(answer));
  return known.get(answer);
}

// Whether the mesh before the last edit is shown: until the last row of the structure in front is written.
export const isBeforeEdit = (explorer) => explorer.view.tab === "edit" && explorer.view.time < explorer.length;

// What a write does, in words.
export function writeSentence(write) {
  if (!write) return ["before the edit"];
  const { table, row, columns, before, after } = write;
  const name = ` ${table} ${row}`;
  if (!before && !after) return ["makes", name, ", which is empty"];
  if (!before) return ["makes", name, `: ${columns.map((column, i) => `${column} ${after[i]}`).join(", ")}`];
  if (!after) return ["deletes", name, `, which was ${before.join(", ")}`];
  const changes = columns.flatMap((column, i) => (before[i] === after[i] ? [] : [`${column} ${before[i]} → ${after[i]}`]));
  return ["writes", name, `: ${changes.join(", ") || "the same as before"}`];
}
