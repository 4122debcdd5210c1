// Elements of the page. All text becomes text nodes, so that text from files is never read as markup.

// Makes an element: el("button", { title: "…", onclick }, "text", child …).
export function el(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && typeof value !== "string") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

export const find = (id) => document.getElementById(id);

// A button that runs an action. `text` can be a list of texts and elements.
export function button(text, action, properties = {}) {
  return el("button", { type: "button", onclick: action, ...properties }, text);
}

// A list to select from: options are texts, or pairs of a value and a text.
export function select(options, value, onChange, properties = {}) {
  const list = options.map((option) => (Array.isArray(option) ? option : [option, option]));
  const entries = list.map(([key, text]) => el("option", { value: key, selected: key === value }, text));
  return el("select", { onchange: (event) => onChange(event.target.value), ...properties }, entries);
}

// Text with `code` between backticks.
export function withCode(text) {
  return text.split("`").map((part, i) => (i % 2 ? el("code", {}, part) : part));
}

const plural = (one) => (one === "vertex" ? "vertices" : `${one}s`);

// A number with its unit: 3 faces.
export const count = (number, one) => `${number.toLocaleString("en")} ${number === 1 ? one : plural(one)}`;

// Offers a text as a file.
export function download(name, text, type) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
