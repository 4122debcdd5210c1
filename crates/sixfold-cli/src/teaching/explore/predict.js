// Predicting first: what a query reads, what an edit changes, what a step of subdivision makes and which structures refuse the
// mesh is asked before it is shown.

import { answerField, answerText, isRight } from "./answer.js";
import { button, count, el, find } from "./dom.js";
import { refine } from "./subdivide.js";

// Why an edit is refused: a part of the engine's text, and the words to choose from.
const REASONS = [
  [/exists already/, "the edge that it would make exists already"],
  [/only three edges|only two edges|fewer than/, "a vertex would keep too few edges"],
  [/exactly two is required|boundary/, "the edge is at the boundary"],
  [/triangle/, "a face is not a triangle"],
  [/link condition|adjacent to both/, "two edges would become one edge with too many faces"],
  [/two faces|same direction|more than one fan|already has/, "there is no room for another face"],
  [/does not support/, "the structure does not have this edit"],
  [/does not exist|no element|no vertex|no edge|no face/, "the element does not exist"],
  [/(?:)/, "another reason"],
];
const reasonOf = (refusal) => REASONS.find(([text]) => text.test(refusal))[1];

export class Predictions {
  constructor(explorer) {
    this.explorer = explorer;
    this.verdict = [];
    explorer.onChange((what) => {
      if (what === "all") this.begin();
    });
  }

  turn(isOn) {
    const { explorer } = this;
    explorer.set({ quiz: isOn, time: isOn ? 0 : explorer.view.time });
    this.key = null;
    this.verdict = [];
    explorer.pending = null;
    explorer.tell("all");
  }

  // Asks anew if something else is shown than before.
  begin() {
    const { explorer } = this;
    const { quiz, tab, relation, element, focus, scheme, level } = explorer.view;
    const key = JSON.stringify([quiz, tab, relation, element, focus, scheme, level, explorer.pending]);
    if (key !== this.key || explorer.state !== this.state) {
      const isSameTab = tab === this.tab && quiz;
      Object.assign(this, { key, tab, right: 0, wrong: 0, tries: 0, said: null, isChecked: false, guesses: new Set(), form: null });
      if (explorer.state !== this.state && this.state && tab !== "edit") explorer.pending = null;
      this.state = explorer.state;
      if (!isSameTab || !["edit", "subdivide"].includes(tab)) this.verdict = [];
      if (explorer.revealed !== explorer.state || tab !== "check") explorer.revealed = null;
    }
    this.show();
  }

  get timeline() {
    return this.explorer.timelines.get(this.explorer.view.focus);
  }

  show() {
    const { explorer } = this;
    const { quiz, tab } = explorer.view;
    const content = quiz ? { query: () => this.ofQuery(), walk: () => this.ofQuery(), edit: () => this.ofEdit(), subdivide: () => this.ofLevel(), check: () => this.ofMesh() }[tab]?.() : null;
    const box = find("predict");
    box.hidden = !content;
    box.replaceChildren(...(content ?? []).filter((part) => part));
    const isEdit = quiz && tab === "edit" && Boolean(explorer.pending);
    const isQuery = explorer.isPredicting && (tab === "query" || tab === "walk");
    // Rows and cells can be reached by keys.
    for (const row of document.querySelectorAll("#cards tr[data-row]")) row.tabIndex = isQuery ? 0 : -1;
    for (const cell of document.querySelectorAll("#cards tr[data-row] td")) {
      const isOpen = isEdit && cell.closest(".card").dataset.structure === explorer.view.focus && !cell.classList.contains("derived");
      if (isOpen) cell.tabIndex = 0;
      else cell.removeAttribute("tabindex");
      cell.classList.toggle("guess", isOpen && this.guesses.has(cell));
    }
  }

  // The form of a prediction: fields, and buttons to check it, for a hint, and to see it without an answer.
  ask(task, asks, { check, hint, show, words = "Check" }) {
    this.form ??= asks.map((asked) => answerField(asked, this.explorer.structures));
    const { form } = this;
    const read = () => {
      const given = form.map((field) => field.read());
      const open = asks.filter(({ isOptional }, i) => given[i] === null && !isOptional);
      if (open.length) this.say(`Answer this first: ${open.map(({ label }) => label).join(", ")}.`);
      return open.length ? null : given;
    };
    const onCheck = () => {
      const given = read();
      if (given) check(given);
    };
    const box = el("div", { class: "ask", onkeydown: (event) => event.key === "Enter" && event.target.matches("input.number") && onCheck() },
      el("p", {}, el("b", {}, task)),
      el("p", { class: "buttons" }, form.map((field) => field.element)),
      el("p", { class: "buttons" }, button(words, onCheck, { class: "main", id: "predict-check" }),
        button("Hint", () => this.say(hint()), { id: "predict-hint" }),
        button("Show without an answer", show, { id: "predict-show" })),
      el("p", { id: "predict-say", role: "status" }, this.said ?? ""));
    return box;
  }

  say(text) {
    this.said = text;
    const line = find("predict-say");
    if (line) line.textContent = text;
  }

  verdictList() {
    return this.verdict.length ? el("ul", { id: "verdict", role: "status" }, this.verdict.map(([good, text]) => el("li", { class: good ? "good" : "refusal" }, `${good ? "✓" : "✗"} ${text}`))) : null;
  }

  // Compares answers with what is true.
  compare(asks, given) {
    this.verdict = asks.flatMap(({ label, truth }, i) => {
      if (truth === null || given[i] === null) return [];
      const good = isRight(truth, given[i]);
      return [[good, good ? `${label}: ${answerText(truth)}` : `${label}: you ${answerText(given[i])}, it is ${answerText(truth)}`]];
    });
  }

  // How many rows a query reads, and which ones.
  ofQuery() {
    const { explorer, timeline } = this;
    const { focus, time } = explorer.view;
    if (!timeline) return [el("p", {}, explorer.view.tab === "walk" ? "Run your walk, and then predict what it reads." : `Choose a query that ${focus} answers.`)];
    const line = el("p", { id: "quiz-line", role: "status" }, this.line ?? this.question());
    this.line = null;
    if (!explorer.isPredicting) return [this.verdictList()];
    const asks = [{ label: "rows read", truth: timeline.reads[timeline.length] }];
    const box = this.isChecked ? this.verdictList() : this.ask(`How many rows does ${focus} read? Count a row each time that it is read.`, asks, {
      check: (given) => {
        this.compare(asks, given);
        this.isChecked = true;
        this.show();
      },
      hint: () => `Follow the program in the card of ${focus}. It yields ${count(timeline.resultsAt(timeline.length).length, "result")}.`,
      show: () => this.reveal(),
    });
    return [box, time === 0 || timeline.nextRead(time) || this.isChecked ? line : null,
      this.isChecked ? el("p", { class: "buttons" }, button("Show the steps", () => this.reveal(), { id: "predict-show" })) : null];
  }

  reveal() {
    const { explorer } = this;
    explorer.revealed = explorer.state;
    explorer.tell("time");
    this.show();
  }

  question() {
    const { view } = this.explorer;
    if (!this.timeline.nextRead(view.time)) return `Done: ${this.right} right at once, ${this.wrong} wrong.`;
    return `Which row does ${view.focus} read ${view.time ? "next" : "first"}? Click it in its tables.`;
  }

  // A row was clicked.
  answer(structure, row) {
    const { explorer, timeline } = this;
    const { view } = explorer;
    if (!explorer.isPredicting || structure !== view.focus || !timeline) return;
    const next = timeline.nextRead(view.time);
    if (!next) return;
    if (row !== next.row) {
      this.tries += 1;
      this.wrong += 1;
      this.line = `Not ${row}.${this.tries > 1 ? ` Hint: ${next.step.reason.text}.` : ""}`;
      this.show();
      return;
    }
    if (this.tries === 0) this.right += 1;
    this.tries = 0;
    // The results that follow come with the row.
    const after = timeline.nextRead(next.time);
    explorer.set({ time: after ? after.time - 1 : timeline.length });
    this.line = `Right: ${row}, ${next.step.reason.text}. ${this.question()}`;
    this.show();
  }

  // What an edit does on the structure in front.
  ofEdit() {
    const { explorer } = this;
    const { pending, view: { focus } } = explorer;
    if (!pending) return [this.verdictList(), el("p", {}, this.verdict.length ? "Choose the next edit." : `Choose an edit. Before it is run, predict what it does on ${focus}.`)];
    const asks = [
      { label: "it is", options: ["done", "refused"], truth: null },
      { label: "if refused, because", options: REASONS.map(([, words]) => words), truth: null, isOptional: true },
      { label: "rows changed", truth: 0, isOptional: true },
      ...["V", "E", "F"].map((letter) => ({ label: `${letter} after`, truth: 0, isOptional: true })),
    ];
    return [this.ask(`${pending} on ${focus}: what does it do? Mark the cells that it changes in the card of ${focus}.`, asks, {
      words: "Check and run",
      check: (given) => explorer.run(() => this.checkEdit(asks, given)),
      hint: () => this.editHint(),
      show: () => explorer.run(() => this.runPending()),
    }), el("p", { class: "buttons" }, button("Another edit", () => { explorer.pending = null; explorer.tell("all"); }, { class: "link", id: "predict-cancel" }))];
  }

  editHint() {
    const { explorer } = this;
    const { pending, view: { focus } } = explorer;
    explorer.run(async () => {
      const { answers, refusals } = await explorer.askEdit(explorer.state, [focus], pending);
      const tables = new Set((answers.get(focus)?.rows ?? []).map(({ table }) => table));
      this.say(refusals.has(focus) ? `Hint: ${focus} reads first, and finds something.` : `Hint: ${focus} changes rows of ${[...tables].join(", ") || "no table"}.`);
    });
    return "";
  }

  async checkEdit(asks, given) {
    const { explorer } = this;
    const { pending, view: { focus } } = explorer;
    const { answers, refusals } = await explorer.askEdit(explorer.state, [focus], pending);
    const answer = answers.get(focus);
    const refusal = refusals.get(focus) ?? null;
    const after = answer?.after ?? null;
    const truths = [refusal === null ? "done" : "refused", refusal === null ? null : reasonOf(refusal), answer?.changed ?? null, after?.vertices ?? null, after?.edges ?? null, after?.faces ?? null];
    const guesses = this.guesses;
    const cells = this.cardOf(focus).cells;
    this.compare(asks.map((asked, i) => ({ ...asked, label: i < 2 ? ["the edit is", "because"][i] : asked.label, truth: truths[i] })), given);
    if (answer && guesses.size) this.verdict.push(cellVerdict(answer.rows, cells, guesses));
    this.verdict.unshift([refusal === null === (given[0] === "done"), `${pending} on ${focus}${refusal ? `: ${refusal}` : ""}`]);
    await this.runPending();
  }

  async runPending() {
    const { explorer } = this;
    const edit = explorer.pending;
    explorer.pending = null;
    explorer.revealed = explorer.state;
    const { verdict } = this;
    await explorer.edit(edit);
    this.verdict = verdict;
    this.show();
  }

  // A cell was clicked.
  guess(structure, cell) {
    const { explorer } = this;
    const isOpen = explorer.view.quiz && explorer.view.tab === "edit" && explorer.pending && structure === explorer.view.focus;
    if (!isOpen || cell.classList.contains("derived")) return;
    if (!this.guesses.delete(cell)) this.guesses.add(cell);
    cell.classList.toggle("guess", this.guesses.has(cell));
  }

  // What the next step of subdivision makes.
  ofLevel() {
    const { explorer } = this;
    const { scheme, level } = explorer.view;
    if (!explorer.refined) return [];
    const asks = ["vertices", "edges", "faces", "irregular vertices"].map((label) => ({ label, truth: 0 }));
    return [this.verdictList(), this.ask(`Level ${level + 1} of ${scheme}: how many has it?`, asks, {
      words: "Check and show",
      check: (given) => explorer.run(() => this.checkLevel(asks, given)),
      hint: () => "Hint: what becomes of a vertex, of an edge and of a face in one step? A vertex that lies on an old edge or in an old face: how many edges meet there?",
      show: () => explorer.run(() => explorer.look({ level: level + 1, point: null })),
    })];
  }

  async checkLevel(asks, given) {
    const { explorer } = this;
    const { subject, view } = explorer;
    const shown = { subject, view: { ...view, level: view.level + 1, point: null } };
    await refine(explorer.engine, shown);
    if (!shown.refined) throw new Error(shown.failed);
    const model = shown.refined.models[view.level + 1];
    const irregular = [...model.valences].filter((one) => one?.isIrregular).length;
    const truths = [model.vertexCount, model.edges.size, model.faceCount, irregular];
    this.compare(asks.map((asked, i) => ({ ...asked, truth: truths[i] })), given);
    const { verdict } = this;
    await explorer.look({ level: view.level + 1, point: null });
    this.verdict = verdict;
    this.show();
  }

  // Which structures refuse the mesh.
  ofMesh() {
    const { explorer } = this;
    if (!explorer.isPredicting) return [this.verdictList()];
    const { verdicts } = explorer.checked ?? { verdicts: [] };
    const asks = [
      { label: "these structures refuse the mesh", truth: verdicts.filter(({ holds }) => !holds).map(({ backend }) => backend) },
    ];
    return [this.ask("Which structures refuse this mesh?", asks, {
      words: "Check and show",
      check: (given) => {
        this.compare(asks, given);
        this.revealMesh();
      },
      hint: () => "Hint: is there an edge with three faces, or two neighbours that run along their edge in the same direction? Is each face a triangle? Which structures store something about edges or sides?",
      show: () => this.revealMesh(),
    })];
  }

  revealMesh() {
    const { explorer } = this;
    explorer.revealed = explorer.state;
    explorer.tell("all");
  }
}

// Whether the marked cells are those that an edit changes: rows that it makes cannot be marked.
function cellVerdict(rows, cells, guesses) {
  const changed = new Set(rows.flatMap(({ table, row, before, after }) => {
    const own = cells.get(`${table} ${row}`) ?? [];
    return before ? own.filter((_, i) => !after || before[i] !== after[i]) : [];
  }));
  const missed = [...changed].filter((cell) => !guesses.has(cell)).length;
  const extra = [...guesses].filter((cell) => !changed.has(cell)).length;
  const good = missed === 0 && extra === 0;
  return [good, good ? `cells marked: all ${changed.size} that change` : `cells marked: ${changed.size - missed} of the ${changed.size} that change${extra ? `, and ${extra} that stay` : ""}`];
}
