// Creates elements; all text is set by textContent, so that names and comments are never parsed as markup.

export type Content = Node | string;

// Characters that turn the direction of text around, as their numbers: a comment can't show another program than it is.
export const inOrder = (text: string): string =>
  text.replace(/[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]/g, (c) => `<U+${c.charCodeAt(0).toString(16).toUpperCase().padStart(4, "0")}>`);

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Record<string, string> = {}, ...content: Content[]): HTMLElementTagNameMap[K] {
  const out = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) out.setAttribute(name, value);
  out.append(...content.map((part) => typeof part === "string" ? inOrder(part) : part));
  return out;
}

export function button(label: string, title: string, click: () => void): HTMLButtonElement {
  const out = element("button", { type: "button", title }, label);
  out.addEventListener("click", click);
  return out;
}

export function swatch(colour: string): HTMLElement {
  const out = element("span", { class: "swatch" });
  out.style.background = colour;
  return out;
}

// A scale with a title above and marks below.
export function legendBar(background: string, title: string, marks: string[]): HTMLElement[] {
  const box = element("div", { class: "legend-bar" });
  box.style.background = background;
  return [element("div", { class: "legend-title" }, title), box,
    element("div", { class: "legend-marks" }, ...marks.map((mark) => element("span", {}, mark)))];
}

// A true minus sign, as wide as a digit.
export const fixed = (value: number, decimals: number): string => value.toFixed(decimals).replace("-", "−");

// At most 4 significant digits below 1000, no exponent.
export function figure(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  const size = value === 0 ? 0 : Math.floor(Math.log10(Math.abs(value)));
  return fixed(value, Math.min(Math.max(digits - 1 - size, 0), 6)).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
}

// "1 h 02 min 03.4 s"
export function duration(seconds: number): string {
  const tenths = Math.round(seconds * 10), s = (tenths % 600 / 10).toFixed(1), m = Math.floor(tenths / 600) % 60;
  const h = Math.floor(tenths / 36000);
  if (h > 0) return `${h} h ${String(m).padStart(2, "0")} min ${s.padStart(4, "0")} s`;
  return m > 0 ? `${m} min ${s.padStart(4, "0")} s` : seconds < 10 ? `${figure(seconds)} s` : `${s} s`;
}

export function metres(millimetres: number): string {
  return millimetres >= 10000 ? `${figure(millimetres / 1000)} m` : `${figure(millimetres)} mm`;
}
