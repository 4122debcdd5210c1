// The counters of all structures, which race each other.

import { el, find } from "./dom.js";

export class Race {
  constructor(explorer) {
    this.explorer = explorer;
    this.rows = new Map(explorer.structures.map((name) => {
      const [bar, ...counts] = [el("span", { class: "bar" }), el("td"), el("td"), el("td")];
      const row = el("tr", { "data-structure": name, style: `--colour: var(--${name}, var(--other))` },
        el("th", { scope: "row" }, name), el("td", { class: "wide" }, bar), counts);
      return [name, { row, bar, counts }];
    }));
    find("race").tBodies[0].append(...[...this.rows.values()].map(({ row }) => row));
    explorer.onChange((what) => what !== "busy" && this.update());
  }

  update() {
    const { timelines, view } = this.explorer;
    const most = Math.max(1, ...[...timelines.values()].map((timeline) => timeline.reads[timeline.length]));
    find("race").classList.toggle("empty", timelines.size === 0);
    for (const [name, { row, bar, counts }] of this.rows) {
      const timeline = timelines.get(name);
      row.classList.toggle("absent", !timeline);
      const time = Math.min(view.time, timeline?.length ?? 0);
      const isDone = timeline && view.time >= timeline.length;
      row.classList.toggle("done", Boolean(isDone));
      bar.style.width = timeline ? `${(100 * timeline.reads[time]) / most}%` : "0";
      const values = timeline ? [timeline.reads[time], timeline.lines[time], timeline.bytes[time]] : ["–", "–", "–"];
      values.forEach((value, i) => { counts[i].textContent = value.toLocaleString("en"); });
    }
  }
}
