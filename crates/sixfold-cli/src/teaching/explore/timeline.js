// The steps of a query or walk on one structure in time: each row that is read, and each result, takes one unit.

const LINE_BYTES = 64;

export class Timeline {
  // `answer` is a trace or a walk of the engine.
  constructor(answer) {
    this.answer = answer;
    this.steps = answer.steps;
    // For each step the time when it begins.
    this.starts = [];
    let time = 0;
    for (const step of this.steps) {
      this.starts.push(time);
      time += step.step === "read" ? step.rows : 1;
    }
    this.length = time;
    this.count();
  }

  // What the reads up to each time cost, as the engine counts it at the end.
  count() {
    const [reads, lines, bytes] = [0, 0, 0].map(() => new Uint32Array(this.length + 1));
    // The rows and the cache lines that were read, for each table: a byte for each, up to the last one.
    const seen = new Map();
    for (const step of this.steps) {
      if (step.step !== "read") continue;
      const table = seen.get(step.table) ?? { end: 0, bytes: step.bytes };
      seen.set(step.table, table);
      table.end = Math.max(table.end, rowNumber(step.row) + step.rows);
    }
    for (const table of seen.values()) {
      table.rows = new Uint8Array(table.end);
      table.lines = new Uint8Array(lineOf(table.end - 1, table.bytes, true) + 1);
    }
    let [time, readCount, lineCount, byteCount] = [0, 0, 0, 0];
    for (const step of this.steps) {
      const isRead = step.step === "read";
      const table = isRead ? seen.get(step.table) : null;
      const first = isRead ? rowNumber(step.row) : 0;
      for (let k = 0; k < (isRead ? step.rows : 1); k += 1) {
        if (isRead) {
          readCount += 1;
          const row = first + k;
          if (table.rows[row] === 0) {
            table.rows[row] = 1;
            byteCount += step.bytes;
            const last = lineOf(row, step.bytes, true);
            for (let line = lineOf(row, step.bytes, false); line <= last; line += 1) {
              if (table.lines[line] === 1) continue;
              table.lines[line] = 1;
              lineCount += 1;
            }
          }
        }
        time += 1;
        reads[time] = readCount;
        lines[time] = lineCount;
        bytes[time] = byteCount;
      }
    }
    Object.assign(this, { reads, lines, bytes });
  }

  // The step that runs up to a time: { step, offset }, offset in the rows of a scan. Null at time 0.
  at(time) {
    const now = Math.min(time, this.length);
    if (now === 0) return null;
    let [low, high] = [0, this.starts.length - 1];
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.starts[middle] < now) low = middle;
      else high = middle - 1;
    }
    return { number: low, step: this.steps[low], offset: now - 1 - this.starts[low] };
  }

  // The last read up to a time: { step, row, number }, or null.
  readAt(time) {
    let found = this.at(time);
    while (found && found.step.step !== "read") found = this.at(this.starts[found.number]);
    return found && { step: found.step, number: found.number, row: rowAt(found.step, found.offset) };
  }

  // The results up to a time.
  resultsAt(time) {
    const results = [];
    for (let i = 0; i < this.steps.length && this.starts[i] < time; i += 1) {
      if (this.steps[i].step === "yield") results.push(this.steps[i].result);
    }
    return results;
  }

  // The time of the next result after a time, or the end.
  nextResult(time) {
    const next = this.steps.findIndex((step, i) => step.step === "yield" && this.starts[i] >= time);
    return next < 0 ? this.length : this.starts[next] + 1;
  }

  // The first read after a time: { step, row, time }, or null. Results in between belong to the read before.
  nextRead(time) {
    for (let now = time + 1; now <= this.length; now += 1) {
      const { step, offset } = this.at(now);
      if (step.step === "read") return { step, row: rowAt(step, offset), time: now };
    }
    return null;
  }

  // The time when a row of a table is read first, or Infinity.
  firstRead(table, row) {
    const number = rowNumber(row);
    const found = this.steps.findIndex((step) => {
      const offset = step.step === "read" && step.table === table && step.row[0] === row[0]
        ? number - rowNumber(step.row) : -1;
      return offset >= 0 && offset < step.rows;
    });
    return found < 0 ? Infinity : this.starts[found] + number - rowNumber(this.steps[found].row) + 1;
  }

  // The names of the rows that are read, without those between the ends of a long scan.
  rowNames(most) {
    const names = new Set();
    for (const step of this.steps) {
      if (step.step !== "read") continue;
      for (let k = 0; k < step.rows && names.size < most; k += 1) {
        if (k === 3 && step.rows > 6) k = step.rows - 3;
        names.add(rowAt(step, k));
      }
    }
    return names;
  }
}

// The cache line of the first or the last byte of a row.
const lineOf = (row, bytes, isLast) => Math.floor((row * bytes + (isLast ? Math.max(bytes, 1) - 1 : 0)) / LINE_BYTES);

export const rowNumber = (name) => Number(name.slice(1));
const rowAt = (step, offset) => `${step.row[0]}${rowNumber(step.row) + offset}`;
