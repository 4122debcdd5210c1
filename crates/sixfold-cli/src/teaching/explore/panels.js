// The panels above the cards: one for each tab. Each returns its elements for what the explorer shows.

import { checkPanel } from "./check.js";
import { editPanel } from "./edit.js";
import { measurePanel } from "./measure.js";
import { queryPanel } from "./query.js";
import { subdividePanel } from "./subdivide.js";
import { walkPanel } from "./walk.js";

const PANELS = {
  query: queryPanel,
  edit: editPanel,
  walk: walkPanel,
  subdivide: subdividePanel,
  check: checkPanel,
  measure: measurePanel,
};

// The buttons that can be the primary one. A panel without steps has its own.
const PRIMARY = ["#next", "#play", "#run-walk", "#edits button", "[data-repair]"];

// The button that is pressed next, as a selector; null if the next thing is not a button. `ranWalk` is the walk that was
// run last.
function nextButton(explorer, ranWalk) {
  const { view, length, checked } = explorer;
  const step = view.time < length ? "#next" : null;
  if (view.tab === "query") return explorer.isPredicting ? null : step;
  if (explorer.isPredicting && (view.tab !== "edit" || explorer.pending)) return null;
  if (view.tab === "edit") return step ?? (length ? "#play" : "#edits button");
  if (view.tab === "walk" && view.walk.trim()) return view.walk === ranWalk && !explorer.failed ? step : "#run-walk";
  return view.tab === "check" && !checked?.repair ? "[data-repair]" : null;
}

// Makes the button that is pressed next the primary one.
export function markPrimary(explorer, ranWalk) {
  const selector = nextButton(explorer, ranWalk);
  const primary = selector && document.querySelector(selector);
  for (const one of document.querySelectorAll(PRIMARY.join())) one.classList.toggle("main", one === primary);
}

// The elements of the panel of the current tab.
export function panel(explorer) {
  // What is to be predicted is not shown before.
  if (explorer.view.tab === "check" && explorer.isPredicting) return [];
  return PANELS[explorer.view.tab](explorer).filter((part) => part);
}
