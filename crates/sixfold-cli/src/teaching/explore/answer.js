// Answers to questions: their fields, and whether they are right. `sixfold lessons --check` decides by the same rules.

import { el, select } from "./dom.js";

// Whether an answer is right. `truth` is a number, names or one of the options. Numbers agree if they differ by at most half
// a percent, integers exactly; names in any order.
export function isRight(truth, given) {
  if (typeof truth === "number") {
    const tolerance = Number.isInteger(truth) ? 0 : 0.005 * Math.abs(truth);
    return typeof given === "number" && Math.abs(truth - given) <= tolerance;
  }
  if (!Array.isArray(truth)) return truth === given;
  return Array.isArray(given) && truth.every((name) => given.includes(name)) && given.every((name) => truth.includes(name));
}

// A number or a fraction, such as 5/8; null if the text is neither.
export function readNumber(text) {
  const [above, below = "1", ...more] = text.trim().split("/");
  const value = Number(above) / Number(below);
  return above.trim() === "" || below.trim() === "" || more.length || !Number.isFinite(value) ? null : value;
}

// An answer as text.
export const answerText = (value) =>
  (Array.isArray(value) ? value.join(", ") || "none" : typeof value === "number" ? value.toLocaleString("en", { maximumFractionDigits: 6 }) : String(value ?? ""));

// The field for one value: { element, read, show }. `names` are those that can be chosen, if names are asked for.
export function answerField({ label, truth, options }, names) {
  if (options) {
    const field = select([["", "choose …"], ...options], "", () => {}, { "aria-label": label });
    return { element: el("label", {}, `${label} `, field), read: () => field.value || null, show: (value) => { field.value = value; } };
  }
  if (Array.isArray(truth)) {
    const boxes = names.map((name) => el("input", { type: "checkbox", value: name }));
    const none = el("input", { type: "checkbox", value: "" });
    const element = el("fieldset", {}, el("legend", {}, label),
      boxes.map((box) => el("label", {}, box, ` ${box.value}`)), el("label", {}, none, " none of them"));
    const chosen = () => boxes.filter((box) => box.checked).map((box) => box.value);
    return {
      element,
      read: () => (chosen().length || none.checked ? chosen() : null),
      show: (value) => { for (const box of boxes) box.checked = value.includes(box.value); none.checked = value.length === 0; },
    };
  }
  const field = el("input", { class: "number", size: 6, inputmode: "decimal", autocomplete: "off", "aria-label": label });
  return { element: el("label", {}, `${label} `, field), read: () => readNumber(field.value), show: (value) => { field.value = answerText(value); } };
}
