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

// The elements of the panel of the current tab.
export function panel(explorer) {
  return PANELS[explorer.view.tab](explorer).filter((part) => part);
}
