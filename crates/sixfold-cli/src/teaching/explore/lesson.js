// The lessons: their texts, questions and commands beside the explorer.

import { button, el, withCode } from "./dom.js";
import { fromText } from "./state.js";

// The list of lessons, or the lesson that is open.
export function lessonView(explorer, lessons) {
  const open = (name) => () => {
    explorer.set({ lesson: name });
    explorer.tell("lesson");
  };
  const at = lessons.findIndex(({ name }) => name === explorer.view.lesson);
  if (at < 0) {
    return [el("h2", {}, "Lessons"),
      el("ol", {}, lessons.map(({ name, title }) => el("li", {}, button(title, open(name), { class: "link", "data-lesson": name }))))];
  }
  const next = lessons[at + 1];
  return [
    button("all lessons", open(""), { class: "link" }),
    el("h2", {}, lessons[at].title),
    lessons[at].parts.map((part) => partView(explorer, part)),
    next ? button(`next: ${next.title}`, open(next.name), { class: "link" }) : null,
  ].flat().filter((part) => part);
}

function partView(explorer, part) {
  if (part.text) return el("p", {}, withCode(part.text));
  if (part.kept) return kept(part.kept);
  if (part.file) {
    return el("details", {}, el("summary", {}, "the file ", el("code", {}, part.file.name)), el("pre", {}, part.file.content));
  }
  if (part.question) {
    return el("div", { class: "question" }, el("p", {}, el("b", {}, withCode(part.question))),
      el("details", {}, el("summary", {}, "answer"), el("p", {}, withCode(part.answer))));
  }
  const { line, output, situation } = part.command;
  const show = () => explorer.run(() => {
    const { state, view } = fromText(JSON.stringify(situation));
    return explorer.open({ state, view: { ...view, lesson: explorer.view.lesson } });
  });
  return el("div", { class: "command" },
    el("p", {}, el("code", {}, line), situation ? button("show in the explorer", show, { class: "main show" }) : null),
    output ? el("details", { open: !situation }, el("summary", {}, "output"), el("pre", {}, output)) : null,
    output === null ? el("p", { class: "hint" }, "This command measures time: run it in a terminal.") : null);
}

// A heading, a list, a table, or a block between backticks.
function kept(text) {
  const lines = text.split("\n");
  if (text.startsWith("```")) return el("pre", {}, lines.slice(1, -1).join("\n"));
  if (text.startsWith("#")) return el("h3", {}, text.replace(/^#+ /, ""));
  if (text.startsWith("|")) {
    const rows = lines.filter((line) => !/^\|[-: |]+\|$/.test(line)).map((line) => line.split("|").slice(1, -1));
    return el("table", { class: "list" }, rows.map((cells, i) =>
      el("tr", {}, cells.map((cell) => el(i ? "td" : "th", {}, withCode(cell.trim()))))));
  }
  const items = text.split(/\n?(?:^|\n)(?:-|\d+\.) /).filter((item) => item.trim());
  return el(/^\d/.test(text) ? "ol" : "ul", {}, items.map((item) => el("li", {}, withCode(item.replace(/\s*\n\s*/g, " ")))));
}
