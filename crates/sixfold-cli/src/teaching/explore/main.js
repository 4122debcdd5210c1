// Starts the page: connects the engine, the mesh, the cards and the player.

import { Card, Rows } from "./cards.js";
import { helpDialog, meshDialog, openFile, shareDialog } from "./dialogs.js";
import { button, count, el, find } from "./dom.js";
import { changesOf } from "./edit.js";
import { editSteps } from "./edit-steps.js";
import { Engine, fromBase64, gunzip } from "./engine.js";
import { Explorer } from "./explorer.js";
import { lessonView } from "./lesson.js";
import { drawnModel, marks } from "./marks.js";
import { markPrimary, panel } from "./panels.js";
import { Player } from "./player.js";
import { Predictions } from "./predict.js";
import { Race } from "./race.js";
import { defaultView, fromLink, fromText, meshState } from "./state.js";
import { Store } from "./store.js";
import { levelMark } from "./subdivide.js";
import { View } from "./view.js";

// Requests that take longer can be stopped.
const SLOW_MS = 4000;
// Maximum number of elements of a kind in the list of elements.
const MOST_LISTED = 500;
const TABS_WITH_CARDS = ["query", "edit", "walk"];

class Page {
  constructor(explorer, data, store) {
    this.explorer = explorer;
    this.data = data;
    this.store = store;
    this.predictions = new Predictions(explorer);
    this.predictions.cardOf = (structure) => this.cards.get(structure);
    this.view = new View(find("faces"), find("overlay"), (name, more) => this.chosen(name, more));
    this.cards = new Map(data.structures.map(({ name }) => [name, new Card(name, {
      focus: (structure) => this.focus(structure),
      clickRow: (structure, row) => this.predictions.answer(structure, row),
      clickCell: (structure, cell) => this.predictions.guess(structure, cell),
    })]));
    find("cards").append(...[...this.cards.values()].map((card) => card.element));
    this.race = new Race(explorer);
    this.player = new Player(explorer);
    this.listen();
    explorer.onChange((what) => this.update(what));
  }

  // An element of the mesh was clicked.
  chosen(name, more) {
    const { explorer } = this;
    const { tab, level } = explorer.view;
    if (tab === "subdivide" && level > 0) {
      if (name.includes("-") || name.startsWith("f")) return;
      explorer.run(() => explorer.look({ point: name }));
    } else explorer.run(() => explorer.choose(name, more || (tab === "edit" && explorer.several)));
  }

  focus(structure) {
    const { explorer } = this;
    if (explorer.view.tab === "walk") explorer.run(() => explorer.look({ focus: structure }));
    else {
      explorer.bringToFront(structure);
      explorer.tell("time");
      if (explorer.view.quiz) explorer.tell("all");
    }
  }

  update(what) {
    const { explorer } = this;
    if (what === "busy") return this.showMessage();
    if (what === "kept") return undefined;
    if (what === "lesson") return this.showLesson();
    if (what === "lesson-again") return this.showLesson(true);
    // The elements below a pressed button stay until it is released: else its click would be lost.
    if (what === "all" && this.isPressed) {
      this.isWaiting = true;
      return undefined;
    }
    if (what === "all") this.showAll();
    const { view } = explorer;
    if (this.front !== view.focus) this.bringToFront(view.focus);
    for (const [name, card] of this.cards) {
      card.at(view.time, view.time >= explorer.length);
      card.element.classList.toggle("front", name === view.focus);
      // A screen reader says the steps of the structure in front.
      card.now.setAttribute("aria-live", name === view.focus ? "polite" : "off");
    }
    for (const card of this.cards.values()) card.reveal();
    this.draw();
    this.mark();
    if (what === "all") this.ranWalk = view.walk;
    markPrimary(explorer, this.ranWalk);
  }

  // Scrolls the cards to the structure in front, where they are beside one another in one row.
  bringToFront(structure) {
    this.front = structure;
    const card = this.cards.get(structure)?.element;
    if (card) find("cards").scrollLeft = card.offsetLeft - find("cards").offsetLeft;
  }

  showAll() {
    const { explorer } = this;
    const { view, state } = explorer;
    this.draw();
    const { shown } = this;
    find("mesh-name").textContent = state.name;
    find("mesh-size").textContent =
      [count(shown.vertexCount, "vertex"), count(shown.edges.size, "edge"), count(shown.faceCount, "face")].join(", ");
    find("undo").disabled = explorer.past.length === 0;
    find("redo").disabled = explorer.future.length === 0;
    for (const tab of document.querySelectorAll("[role=tab]")) {
      tab.setAttribute("aria-selected", String(tab.dataset.tab === view.tab));
      tab.tabIndex = tab.dataset.tab === view.tab ? 0 : -1;
    }
    keepingFocus(() => find("panel").replaceChildren(...panel(explorer)));
    for (const canvas of find("panel").querySelectorAll("[data-picture]")) {
      const { models } = explorer.refined;
      this.view.drawSmall(canvas, models[canvas.dataset.picture], models[0]);
    }
    find("cards").hidden = !TABS_WITH_CARDS.includes(view.tab);
    find("chosen").hidden = !TABS_WITH_CARDS.includes(view.tab) || view.tab === "walk";
    keepingFocus(() => find("chosen").replaceChildren("shown: ", ...explorer.structures.map((name) => button(name, () => explorer.toggle(name), {
      "data-shown": name, "aria-pressed": String(explorer.shown.includes(name)), style: `--colour: var(--${name}, var(--other))`,
      title: `show or hide ${name}`,
    }))));
    find("cards").classList.toggle("single", view.tab === "walk");
    find("player").hidden = view.tab === "edit" ? explorer.length === 0 : view.tab !== "query" && view.tab !== "walk";
    find("player").classList.toggle("edit", view.tab === "edit");
    for (const [name, card] of this.cards) this.showCard(name, card);
    this.showLesson();
  }

  // Draws the mesh if it is another one than before.
  draw() {
    const { explorer } = this;
    const shown = drawnModel(explorer);
    const suffix = explorer.view.tab === "subdivide" && explorer.refined ? levelMark(explorer.view.level) : "";
    if (this.shown !== shown || this.suffix !== suffix) this.view.show(shown, suffix);
    Object.assign(this, { shown, suffix });
    this.listElements();
  }

  // Lists the elements, if the list is open: they can all be chosen with the keys.
  listElements() {
    const { shown, explorer: { view } } = this;
    if (!find("elements").open) return;
    const list = find("elements").querySelector("select");
    if (this.listed !== shown) {
      const all = [["vertices", shown.vertices, "v"], ["faces", shown.faces, "f"]].map(([title, elements, letter]) =>
        [title, [...elements.keys()].filter((i) => elements[i]).map((i) => letter + i)]);
      all.splice(1, 0, ["edges", [...shown.edges.keys()]]);
      list.replaceChildren(...all.map(([title, names]) =>
        el("optgroup", { label: title }, names.slice(0, MOST_LISTED).map((name) => el("option", { value: name }, name)))));
    }
    this.listed = shown;
    list.value = view.tab === "subdivide" && view.level > 0 ? view.point ?? "" : view.element;
  }

  showCard(name, card) {
    const { explorer } = this;
    const { state, view, lastEdit } = explorer;
    const stopped = state.stopped[name];
    const status = stopped === undefined ? null : `waits: it refused ${state.edits[stopped]}`;
    card.show({
      records: explorer.records.get(name)?.records,
      moved: explorer.records.get(name)?.moved,
      refusal: explorer.refusals.get(name) ?? lastEdit?.refusals.get(name),
      state: status,
      changes: changesOf(lastEdit, name),
    });
    if (explorer.base.holdingTriangles.has(name)) {
      card.reason.append(" ", button("triangulate", () => explorer.run(() =>
        explorer.withSubject({ ...explorer.subject, triangulate: true }))));
    }
    card.follow(explorer.timelines.get(name), editSteps(explorer, name));
    card.element.hidden = view.tab === "walk" ? name !== view.focus : !explorer.shown.includes(name);
  }

  // Shows the lesson that is open; `again` after an answer.
  showLesson(again = false) {
    const { lesson } = this.explorer.view;
    find("lesson").hidden = lesson === null;
    find("lessons-button").setAttribute("aria-expanded", String(lesson !== null));
    if (this.lesson === lesson && !again) return;
    const isOther = this.lesson !== lesson;
    this.lesson = lesson;
    if (lesson !== null) find("lesson").replaceChildren(...lessonView(this.explorer, this.data.lessons, { version: this.data.version, store: this.store }));
    if (isOther) find("lesson").scrollTop = 0;
  }

  showMessage() {
    const { explorer } = this;
    const { message, busy } = explorer;
    const close = () => {
      explorer.message = null;
      explorer.tell("busy");
    };
    find("message").hidden = !message;
    find("message").replaceChildren(...(message ? [message, " ", button("✕", close, { "aria-label": "Close" })] : []));
    if (message) find("dialog").close();
    document.documentElement.toggleAttribute("data-busy", busy);
    clearTimeout(this.slow);
    find("slow").hidden = true;
    if (busy) this.slow = setTimeout(() => { find("slow").hidden = false; }, SLOW_MS);
  }

  // The pointer was released.
  released() {
    this.isPressed = false;
    if (this.isWaiting) {
      this.isWaiting = false;
      this.update("all");
    }
  }

  // Draws the mesh in other colours.
  redraw() {
    this.view.shades = null;
    this.view.draw();
    this.mark();
  }

  mark() {
    const { explorer } = this;
    const style = getComputedStyle(document.documentElement);
    const rowsOf = (structure) => this.cards.get(structure)?.rows ?? new Rows();
    const list = marks(explorer, rowsOf, (name) => style.getPropertyValue(name).trim());
    this.view.mark(list);
    this.turnToMark(list.find((mark) => mark.isAtHand));
    const refusals = explorer.lastEdit?.refusals ?? new Map();
    find("say").hidden = refusals.size === 0;
    find("say").textContent = refusalText(refusals, explorer.isRefused);
  }

  // Turns the mesh to the element at hand if it is another one than before. Fast steps do not turn it.
  turnToMark(mark) {
    const key = mark && `${mark.label} ${this.explorer.view.time}`;
    if (key === this.atHand) return;
    this.atHand = key;
    const isFast = this.player.isPlaying && Number(find("speed").value) > 5;
    if (mark && !isFast) this.view.turnTo(mark.place);
  }

  listen() {
    const { explorer } = this;
    const click = (id, action) => find(id).addEventListener("click", action);
    click("undo", () => explorer.run(() => explorer.undo()));
    click("redo", () => explorer.run(() => explorer.redo()));
    click("mesh-button", () => meshDialog(explorer, this.data.shapes));
    click("share-button", () => explorer.run(() => shareDialog(explorer)));
    click("help-button", () => helpDialog(this.data.version));
    click("lessons-button", () => {
      explorer.set({ lesson: explorer.view.lesson === null ? "" : null });
      explorer.tell("lesson");
    });
    click("theme", () => {
      const root = document.documentElement;
      const isDark = getComputedStyle(root).colorScheme === "dark";
      root.dataset.theme = isDark ? "light" : "dark";
      this.redraw();
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
    click("stop", () => explorer.stop());
    document.addEventListener("pointerdown", () => { this.isPressed = true; }, true);
    for (const type of ["pointerup", "pointercancel"]) {
      document.addEventListener(type, () => setTimeout(() => this.released()), true);
    }
    for (const tab of document.querySelectorAll("[role=tab]")) {
      tab.addEventListener("click", () => explorer.run(() => explorer.look({ tab: tab.dataset.tab })));
      tab.addEventListener("keydown", (event) => {
        const next = { ArrowRight: tab.nextElementSibling, ArrowLeft: tab.previousElementSibling }[event.key];
        if (!next) return;
        next.focus();
        next.click();
      });
    }
    for (const box of find("names").querySelectorAll("input")) {
      box.addEventListener("change", () => {
        this.view.names[box.value] = box.checked;
        this.view.drawOverlay();
      });
    }
    find("elements").addEventListener("toggle", () => this.listElements());
    find("elements").addEventListener("change", (event) => this.chosen(event.target.value, false));
    find("panel").addEventListener("input", () => markPrimary(explorer, this.ranWalk));
    find("quiz").addEventListener("change", (event) => this.predictions.turn(event.target.checked));
    const open = (file) => file && explorer.run(() => openFile(explorer, file));
    find("file").addEventListener("change", (event) => {
      open(event.target.files[0]);
      event.target.value = "";
    });
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      open(event.dataTransfer.files[0]);
    });
    document.addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z") return;
      if (event.target.closest("input:not([type=range]):not([type=checkbox]), textarea")) return;
      event.preventDefault();
      explorer.run(() => (event.shiftKey ? explorer.redo() : explorer.undo()));
    });
    window.addEventListener("hashchange", () => explorer.run(async () => {
      const [hash, only] = partsOf(location.hash);
      const situation = await situationOf(hash, this.data.lessons);
      if (!situation) return;
      showOnly(only ?? document.documentElement.dataset.only);
      // The same link can be followed again.
      history.replaceState(null, "", "#");
      await explorer.open(situation);
    }));
  }
}

// Rebuilds elements, and gives the focus to the one that takes the place of the one with the focus.
function keepingFocus(rebuild) {
  const before = document.activeElement;
  const key = before?.id ? `#${before.id}` : dataSelector(before);
  rebuild();
  if (key && !before.isConnected) document.querySelector(key)?.focus();
}

function dataSelector(element) {
  const data = [...element?.attributes ?? []].find(({ name }) => name.startsWith("data-"));
  return data ? `[${data.name}="${CSS.escape(data.value)}"]` : null;
}

// Who refuses an edit, and why.
function refusalText(refusals, byAll) {
  const byReason = new Map();
  for (const [structure, reason] of refusals) byReason.set(reason, [...byReason.get(reason) ?? [], structure]);
  const texts = [...byReason].map(([reason, structures]) =>
    `${byAll && byReason.size === 1 ? "all structures" : structures.join(", ")}: ${reason}`);
  return texts.length ? `refused by ${texts.join("; by ")}` : "";
}

// The part of a link after #, without &only=PART at its end, and the name of this part.
function partsOf(hash) {
  const [, rest, only] = /^(.*?)(?:&only=(cards|mesh))?$/s.exec(hash);
  return [rest, only];
}

// Shows one part of the page alone, for a frame in another page, which is told the height that the part needs.
function showOnly(only) {
  const root = document.documentElement;
  if (!only || root.dataset.only === only) return;
  const isFirst = !root.dataset.only;
  root.dataset.only = only;
  if (isFirst && parent !== window) {
    new ResizeObserver(() => parent.postMessage({ sixfold: "height", height: document.body.offsetHeight }, "*")).observe(document.body);
  }
}

// What the part of a link after # shows: a state, a lesson (#lesson=flip), or what a lesson shows with its command of a
// number (#show=flip/1). Null if it names nothing.
async function situationOf(hash, lessons) {
  const [, kind, name, number] = /^#(lesson|show)=([\w-]+)(?:\/(\d+))?$/.exec(hash) ?? [];
  if (!kind && hash.length > 1 && !hash.startsWith("#s=")) throw new Error("this link has nothing to show: the part after # is not known");
  if (!kind) return fromLink(hash);
  const lesson = lessons.find((one) => one.name === name);
  if (!lesson) throw new Error(`there is no lesson ${name}`);
  const shown = lesson.parts.map((part) => part.command?.situation).filter((situation) => situation);
  if (number && !shown[number - 1]) throw new Error(`the lesson ${name} shows ${shown.length} situations, and no number ${number}`);
  const situation = shown[(number ?? 1) - 1];
  const { state, view } = situation ? fromText(JSON.stringify(situation)) : defaultSituation();
  return { state, view: { ...view, lesson: kind === "lesson" ? name : null } };
}

const defaultSituation = () =>
  ({ state: meshState({ mesh: { shape: { name: "octahedron" } } }, "octahedron"), view: defaultView() });

async function start() {
  const data = JSON.parse(find("data").textContent);
  const engine = await Engine.start(await gunzip(fromBase64(find("engine").textContent)));
  const explorer = new Explorer(engine, data.structures.map(({ name }) => name), data.schemes);
  const store = new Store(explorer, data.situation);
  const kept = store.read();
  explorer.course = kept.course;
  const [hash, only] = partsOf(location.hash);
  showOnly(only);
  new Page(explorer, data, store);
  const own = data.situation ? fromText(JSON.stringify(data.situation)) : defaultSituation();
  await explorer.run(async () => explorer.open((await situationOf(hash, data.lessons)) ?? (kept.state ? fromText(kept.state) : own)));
  if (!explorer.state) {
    const { message } = explorer;
    await explorer.run(() => explorer.open(own));
    if (explorer.state) Object.assign(explorer, { message });
    explorer.tell("busy");
  }
  // A part in another page does not replace the mesh that the whole page keeps.
  if (!only) store.keep();
  document.documentElement.dataset.ready = "yes";
  performance.mark("ready");
}

start().catch((error) => {
  find("message").hidden = false;
  find("message").textContent = `This page cannot start: ${error.message}. It needs a browser of 2023 or later.`;
});
