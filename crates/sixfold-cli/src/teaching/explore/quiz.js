// The quiz: the next row is hidden until the student has clicked it.

import { el, find } from "./dom.js";

export class Quiz {
  constructor(explorer) {
    this.explorer = explorer;
    explorer.onChange((what) => {
      if (what === "all") this.begin();
    });
  }

  turn(isOn) {
    this.explorer.set({ quiz: isOn, time: 0 });
    this.begin();
  }

  begin() {
    this.right = this.wrong = this.tries = 0;
    const { quiz, tab } = this.explorer.view;
    const isOn = quiz && (tab === "query" || tab === "walk");
    this.show(isOn ? this.question() : null);
    // The rows can be reached by keys.
    for (const row of document.querySelectorAll("#cards tr[data-row]")) row.tabIndex = isOn ? 0 : -1;
  }

  get timeline() {
    return this.explorer.timelines.get(this.explorer.view.focus);
  }

  question() {
    const { view } = this.explorer;
    if (!this.timeline) return `choose a query that ${view.focus} answers`;
    if (!this.timeline.nextRead(view.time)) return this.result();
    return `Which row does ${view.focus} read ${view.time ? "next" : "first"}? Click it in its tables.`;
  }

  result() {
    return `Done: ${this.right} right at once, ${this.wrong} wrong.`;
  }

  // A row was clicked.
  answer(structure, row) {
    const { view } = this.explorer;
    if (!view.quiz || structure !== view.focus || !this.timeline) return;
    const next = this.timeline.nextRead(view.time);
    if (!next) return;
    if (row !== next.row) {
      this.tries += 1;
      this.wrong += 1;
      const hint = this.tries > 1 ? ` Hint: ${next.step.reason.text}.` : "";
      this.show(`Not ${row}.${hint}`);
      return;
    }
    if (this.tries === 0) this.right += 1;
    this.tries = 0;
    // The results that follow come with the row.
    const after = this.timeline.nextRead(next.time);
    this.explorer.set({ time: after ? after.time - 1 : this.timeline.length });
    this.show(`Right: ${row}, ${next.step.reason.text}. ${this.question()}`);
  }

  show(text) {
    this.line ??= find("panel").parentElement.insertBefore(el("p", { id: "quiz-line", role: "status" }), find("cards"));
    this.line.hidden = !text;
    this.line.textContent = text ?? "";
  }
}
