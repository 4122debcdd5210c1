// Playing the steps: the buttons, the keys and the clock.

import { find } from "./dom.js";

// Steps each second at speed 1.
const STEPS = 1;

export class Player {
  constructor(explorer) {
    this.explorer = explorer;
    this.isPlaying = false;
    const on = (id, action) => find(id).addEventListener("click", () => { this.pause(); action(); });
    on("first", () => this.to(0));
    on("back", () => this.to(explorer.view.time - 1));
    on("next", () => this.forward());
    on("last", () => this.to(explorer.length));
    on("to-result", () => this.toResult());
    find("play").addEventListener("click", () => this.toggle());
    find("time").addEventListener("input", (event) => { this.pause(); this.to(Number(event.target.value)); });
    explorer.onChange((what) => this.update(what));
    document.addEventListener("keydown", (event) => this.key(event));
  }

  get isQuiz() {
    return this.explorer.isPredicting && this.explorer.view.tab !== "edit";
  }

  to(time) {
    this.explorer.set({ time: Math.max(0, Math.min(this.explorer.length, time)) });
  }

  // When the reader predicts, the next step comes after the right answer.
  forward() {
    if (!this.isQuiz) this.to(this.explorer.view.time + 1);
  }

  toResult() {
    const { timelines, view } = this.explorer;
    const timeline = timelines.get(view.focus) ?? [...timelines.values()][0];
    if (timeline && !this.isQuiz) this.to(timeline.nextResult(view.time));
  }

  toggle() {
    if (this.isPlaying) return this.pause();
    if (this.isQuiz || this.explorer.length === 0) return;
    if (this.explorer.view.time >= this.explorer.length) this.to(0);
    this.isPlaying = true;
    this.begun = null;
    this.update("time");
    requestAnimationFrame((now) => this.tick(now));
  }

  pause() {
    this.isPlaying = false;
    this.update("time");
  }

  tick(now) {
    if (!this.isPlaying || this.isQuiz) return this.pause();
    this.begun ??= { now, time: this.explorer.view.time, speed: find("speed").value };
    if (this.begun.speed !== find("speed").value) this.begun = null;
    else {
      const time = this.begun.time + Math.floor(((now - this.begun.now) / 1000) * STEPS * Number(this.begun.speed));
      if (time !== this.explorer.view.time) this.to(time);
      if (time >= this.explorer.length) return this.pause();
    }
    requestAnimationFrame((later) => this.tick(later));
  }

  update(what) {
    const { view, length } = this.explorer;
    if (what === "all" && this.isPlaying) this.isPlaying = false;
    find("time").max = length;
    find("time").value = view.time;
    find("clock").textContent = length ? `step ${view.time.toLocaleString("en")} of ${length.toLocaleString("en")}` : "no steps";
    find("play").textContent = this.isPlaying ? "⏸ Pause" : "▶ Play";
    for (const id of ["play", "next", "to-result", "last"]) find(id).disabled = length === 0 || this.isQuiz;
    for (const id of ["first", "back"]) find(id).disabled = view.time === 0;
    find("time").disabled = length === 0 || this.isQuiz;
    find("quiz").checked = view.quiz;
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const others = "input:not(#time):not([type=checkbox]), textarea, select, dialog, .tables, [role=tab]";
    if (event.target.closest(others) || this.explorer.length === 0) return;
    const isButton = event.target.closest("button, a, summary, label");
    const actions = {
      " ": () => this.toggle(),
      ArrowRight: () => { this.pause(); this.forward(); },
      ArrowLeft: () => { this.pause(); this.to(this.explorer.view.time - 1); },
      Home: () => this.to(0),
      End: () => !this.isQuiz && this.to(this.explorer.length),
      r: () => this.toResult(),
    };
    const action = actions[event.key === "R" ? "r" : event.key];
    if (!action || (event.key === " " && isButton)) return;
    event.preventDefault();
    action();
  }
}
