// The lessons: their texts, tasks and questions beside the explorer. A lesson opens section by section: each ends with a question.

import { answerField, answerText, isRight } from "./answer.js";
import { button, count, download, el, withCode } from "./dom.js";
import { fromText } from "./state.js";
import { answersText } from "./store.js";

// The sections of a lesson: its parts up to each question, and what comes after the last one.
export function sectionsOf({ parts }) {
  const sections = [[]];
  for (const part of parts) {
    sections.at(-1).push(part);
    if (part.question) sections.push([]);
  }
  return sections.filter((section) => section.length);
}

const questionsOf = ({ parts }) => parts.filter((part) => part.question);

// Whether a question needs no more answer.
const isDone = (answer) => Boolean(answer && (answer.right || answer.shown));

// The list of lessons, or the lesson that is open.
export function lessonView(explorer, lessons, page) {
  const lesson = lessons.find(({ name }) => name === explorer.view.lesson);
  return lesson ? openLesson(explorer, lessons, lesson) : listOfLessons(explorer, lessons, page);
}

function open(explorer, lesson) {
  explorer.set({ lesson: lesson?.name ?? "" });
  explorer.tell("lesson");
  if (lesson) showFirst(explorer, sectionsOf(lesson)[0]);
}

function listOfLessons(explorer, lessons, { version, store }) {
  const { course } = explorer;
  const entry = (lesson) => {
    const all = questionsOf(lesson);
    const done = all.filter(({ id }) => isDone(course.answers[id])).length;
    return el("li", {}, button(lesson.title, () => open(explorer, lesson), { class: "link", "data-lesson": lesson.name }),
      done ? el("span", { class: done === all.length ? "good" : "hint" }, ` ${done === all.length ? "✓ " : ""}${done} of ${all.length}`) : null);
  };
  const name = el("input", { value: course.name, size: 18, id: "student", autocomplete: "name", onchange: () => {
    course.name = name.value.trim();
    explorer.tell("lesson");
  } });
  const save = () => download(`answers${course.name ? `-${course.name.replace(/[^\p{L}\p{N}]+/gu, "-")}` : ""}.json`, answersText(course, version), "application/json");
  const forget = button("Forget my answers and my mesh", () => {
    if (forget.dataset.sure) {
      store.forget();
      explorer.tell("lesson-again");
      return;
    }
    forget.dataset.sure = "yes";
    forget.textContent = "Press again to forget them";
  }, { id: "forget" });
  return [el("h2", {}, "Lessons"),
    el("ol", {}, lessons.map(entry)),
    el("p", {}, el("label", {}, "your name ", name), " ", button("Save my answers", save, { id: "save-answers" })),
    el("p", { class: "hint" }, "The browser keeps your answers and your mesh on this machine. The file of answers is for your teacher: it has your answers, how often you tried, and whether you read a hint or a solution. ", forget)];
}

function openLesson(explorer, lessons, lesson) {
  const { course } = explorer;
  const sections = sectionsOf(lesson);
  const opened = Math.min(course.sections[lesson.name] ?? 0, sections.length - 1);
  const next = lessons[lessons.indexOf(lesson) + 1];
  const questions = questionsOf(lesson);
  const done = questions.filter(({ id }) => isDone(course.answers[id]));
  const openMore = (number) => {
    course.sections[lesson.name] = number;
    explorer.tell("lesson-again");
  };
  const forward = () => {
    openMore(opened + 1);
    document.getElementById("lesson").querySelector(".section:last-of-type")?.scrollIntoView({ block: "start" });
    showFirst(explorer, sections[opened + 1]);
  };
  const last = sections[opened].at(-1);
  const canGo = !last.question || isDone(course.answers[last.id]);
  const isEnd = opened === sections.length - 1;
  return [
    el("p", {}, button("all lessons", () => open(explorer, null), { class: "link" })),
    el("h2", {}, lesson.title),
    el("p", { class: "hint", id: "progress" }, `${done.length} of ${count(questions.length, "question")} answered, ${done.filter(({ id }) => course.answers[id].right).length} right`),
    ...sections.slice(0, opened + 1).map((section) => el("div", { class: "section" }, section.map((part) => partView(explorer, lesson, part)))),
    el("p", { class: "buttons" },
      isEnd ? null : button("Next", forward, { id: "lesson-next", class: canGo ? "main" : null, disabled: !canGo }),
      isEnd && canGo && next ? button(`Next lesson: ${next.title}`, () => open(explorer, next), { id: "next-lesson", class: "main" }) : null,
      isEnd ? null : button("open the whole lesson", () => openMore(sections.length - 1), { class: "link", id: "open-all" })),
  ];
}

// Shows what the first command of a section shows.
function showFirst(explorer, section) {
  const shown = section.find((part) => part.command?.situation);
  if (shown) showSituation(explorer, shown.command.situation);
}

function showSituation(explorer, situation) {
  explorer.run(() => {
    const { state, view } = fromText(JSON.stringify(situation));
    const { lesson, only } = explorer.view;
    return explorer.open({ state, view: { ...view, lesson, only } });
  });
}

function partView(explorer, lesson, part) {
  if (part.text) return el("p", {}, withCode(part.text));
  if (part.kept) return kept(part.kept);
  if (part.file) {
    return el("details", {}, el("summary", {}, "the file ", el("code", {}, part.file.name)), el("pre", {}, part.file.content));
  }
  if (part.question) return questionView(explorer, lesson, part);
  const { line, output, situation } = part.command;
  return el("div", { class: "command" },
    el("p", {}, el("code", {}, line), situation ? button("show in the explorer", () => showSituation(explorer, situation), { class: "show" }) : null),
    output ? el("details", { open: !situation }, el("summary", {}, "output"), el("pre", {}, output)) : null,
    output === null ? el("p", { class: "hint" }, "This command measures time: run it in a terminal.") : null);
}

// A question: first its fields, then, when it is answered or the solution was asked for, the solution.
function questionView(explorer, lesson, part) {
  const { course } = explorer;
  const { id, question, hint, answer: solution } = part;
  const asks = part.asks ?? [];
  const known = course.answers[id];
  const element = el("div", { class: "question", "data-question": id }, el("p", {}, el("b", {}, withCode(question))));
  if (isDone(known)) {
    const given = asks.map(({ label, truth }, i) => el("li", {}, `${label}: ${answerText(truth)} `,
      isRight(truth, known.given[i]) ? el("span", { class: "good" }, "✓") : known.given[i] === undefined ? null : el("span", { class: "refusal" }, `you: ${answerText(known.given[i])}`)));
    element.append(asks.length ? el("ul", {}, given) : el("p", { class: "hint" }, known.given[0] ? `You: ${known.given[0]}` : ""), el("p", { class: "solution" }, withCode(solution)));
    return element;
  }
  const fields = asks.length
    ? asks.map((asked) => answerField(asked, explorer.structures))
    : [ownWords()];
  if (known) fields.forEach((field, i) => known.given[i] !== undefined && known.given[i] !== null && field.show(known.given[i]));
  const say = el("p", { role: "status", class: "feedback" });
  const note = (change) => {
    course.answers[id] = { lesson: lesson.name, given: [], tries: 0, hint: false, shown: false, right: false, ...course.answers[id], ...change };
    explorer.tell("kept");
  };
  const check = () => {
    const given = fields.map((field) => field.read());
    if (given.includes(null)) {
      say.textContent = asks.length > 1 ? "Answer each of them, numbers as digits." : "Give an answer first: a number, a choice, or a sentence.";
      return;
    }
    const tries = (course.answers[id]?.tries ?? 0) + 1;
    const wrong = asks.filter(({ truth }, i) => !isRight(truth, given[i]));
    note({ given, tries, right: asks.length > 0 && wrong.length === 0, shown: asks.length === 0 });
    if (wrong.length === 0) explorer.tell("lesson-again");
    else say.textContent = `Not yet: ${wrong.map(({ label }) => label).join(", ")}.${hint && !course.answers[id].hint ? " Try again, or read the hint." : ""}`;
  };
  const showHint = () => {
    note({ hint: true });
    say.replaceChildren("Hint: ", ...withCode(hint));
  };
  const show = () => {
    note({ shown: true });
    explorer.tell("lesson-again");
  };
  element.append(...fields.map((field) => el("p", {}, field.element)), el("p", { class: "buttons" },
    button(asks.length ? "Check" : "Compare with the solution", check, { class: "main", "data-check": id }),
    hint ? button("Hint", showHint, { "data-hint": id }) : null,
    asks.length ? button("Show the solution", show, { "data-solve": id }) : null), say);
  element.addEventListener("keydown", (event) => event.key === "Enter" && event.target.matches("input.number") && check());
  return element;
}

// The field for a sentence.
function ownWords() {
  const field = el("textarea", { rows: 2, "aria-label": "Your answer", maxLength: 2000 });
  return { element: field, read: () => field.value.trim() || null, show: (value) => { field.value = value; } };
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
