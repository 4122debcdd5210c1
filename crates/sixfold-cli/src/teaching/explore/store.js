// What the page keeps in the local storage of the browser: the answers to the lessons, and the mesh with its edits.

import { toText } from "./state.js";

const KEY = "sixfold-explorer";
const WAIT_MS = 300;
const FILE_VERSION = 1;

// The answers of a reader. `answers` has for each question { lesson, given, tries, hint, shown, right }: the last answer before it
// was right or the solution was shown. `sections` has for each lesson how much of it is open.
export const newCourse = () => ({ name: "", answers: {}, sections: {} });

export class Store {
  // `own` is what the page shows by itself: a page that was made for another mesh shows this mesh.
  constructor(explorer, own) {
    this.explorer = explorer;
    this.own = JSON.stringify(own ?? null);
  }

  // Begins to keep what is shown.
  keep() {
    this.explorer.onChange(() => {
      clearTimeout(this.waiting);
      this.waiting = setTimeout(() => this.save(), WAIT_MS);
    });
    // Another page of the same folder has kept answers: they are taken over, so that neither page loses those of the other.
    window.addEventListener("storage", (event) => {
      if (event.key === KEY) Object.assign(this.explorer.course, this.read().course);
    });
  }

  // What was kept: { course, state }, the state as text, or null if this page shows another mesh by itself.
  read() {
    try {
      const kept = JSON.parse(localStorage.getItem(KEY) ?? "{}");
      return { course: courseOf(kept.course), state: kept.own === this.own && typeof kept.state === "string" ? kept.state : null };
    } catch {
      return { course: newCourse(), state: null };
    }
  }

  save() {
    const { explorer, own } = this;
    if (!explorer.state) return;
    const { course } = explorer;
    const state = toText(explorer.state, explorer.view);
    if (this.write({ own, course, state })) return;
    const keepsAnswers = this.write({ own, course });
    if (this.isSaid) return;
    this.isSaid = true;
    explorer.message = keepsAnswers
      ? "This mesh is too large for the local storage of the browser: after a reload, the page shows its first mesh. Share, Save the state keeps it."
      : "The local storage of the browser is full or not allowed: your answers are kept only while this page is open. Lessons, Save my answers writes them into a file.";
    explorer.tell("busy");
  }

  write(kept) {
    try {
      localStorage.setItem(KEY, JSON.stringify(kept));
      return true;
    } catch {
      return false;
    }
  }

  // Forgets the answers and the mesh.
  forget() {
    clearTimeout(this.waiting);
    try {
      localStorage.removeItem(KEY);
    } catch {
      // Nothing was kept.
    }
    this.explorer.course = newCourse();
  }
}

// Reads what was kept: anything may stand there.
function courseOf(kept) {
  const course = newCourse();
  if (typeof kept?.name === "string") course.name = kept.name;
  for (const [lesson, open] of Object.entries(kept?.sections ?? {})) if (Number.isInteger(open)) course.sections[lesson] = open;
  for (const [id, answer] of Object.entries(kept?.answers ?? {})) {
    if (typeof answer?.lesson !== "string" || !Array.isArray(answer.given) || !Number.isInteger(answer.tries)) continue;
    const { lesson, given, tries } = answer;
    course.answers[id] = { lesson, given, tries, hint: answer.hint === true, shown: answer.shown === true, right: answer.right === true };
  }
  return course;
}

// The answers as a file, which `sixfold lessons --check` grades. The first line has a hash of all others.
export function answersText({ name, answers }, version) {
  const list = Object.entries(answers).filter(([, { tries, shown }]) => tries > 0 || shown)
    .map(([id, { lesson, given, tries, hint, shown }]) => JSON.stringify({ lesson, id, given, tries, hint, shown }));
  const body = `"version": ${JSON.stringify(version)}, "name": ${JSON.stringify(name)}, "answers": [\n${list.join(",\n")}\n]}\n`;
  return `{"sixfold_answers": ${FILE_VERSION}, "digest": "${digest(body)}",\n${body}`;
}

// A hash of 64 bits of a text (FNV-1a; Fowler, Noll and Vo, 1991), in hexadecimal digits.
export function digest(text) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of new TextEncoder().encode(text)) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
  return hash.toString(16).padStart(16, "0");
}
