// Sliders and fields for changeable values, made from the knobs that the core names. A value is stored in the state as
// text for --set; a value equal to the experiment's own is removed.
import { el } from "./dom";
import { Described, Knob, Region } from "./model";

type Change = (path: string, value: string | undefined) => void;

const steps = 1000;
const short = (x: number): string => String(Number(x.toPrecision(4))); // a slider's value
const typed = (x: number): string => String(Number(x.toPrecision(12)));

/** Converts a value to its place on a slider, and back. */
function share(knob: Knob, x: number): number {
  if (!knob.log) return (x - knob.low) / (knob.high - knob.low);
  return Math.log(Math.max(x, knob.low) / knob.low) / Math.log(knob.high / knob.low);
}
function valueAt(knob: Knob, t: number): number {
  return knob.log ? knob.low * (knob.high / knob.low) ** t : knob.low + t * (knob.high - knob.low);
}

/** taken: returns the value that replaces x, if it differs. */
function field(label: string, value: number, taken: (x: number) => number | undefined): HTMLInputElement {
  return el("input", {
    type: "text", inputmode: "decimal", "aria-label": label, value: typed(value), class: "number",
    onchange: (event): void => {
      const input = event.target as HTMLInputElement, x = Number(input.value.trim() || NaN);
      if (!Number.isFinite(x)) { input.value = typed(value); return; }
      const becomes = taken(x);
      value = becomes ?? x;
      if (becomes !== undefined) input.value = typed(value);
    },
  });
}

function slider(label: string, knob: Knob, value: number, moved: (x: number) => void): HTMLInputElement {
  return el("input", {
    type: "range", min: 0, max: steps, step: 1, value: Math.round(steps * share(knob, value)), "aria-label": label,
    "aria-valuetext": `${short(value)} ${knob.unit}`,
    oninput: (event): void => {
      const input = event.target as HTMLInputElement, x = Number(short(valueAt(knob, Number(input.value) / steps)));
      input.setAttribute("aria-valuetext", `${short(x)} ${knob.unit}`);
      moved(x);
    },
  });
}

/** A slider and a field for one number, each showing the value of the other. */
function pair(label: string, knob: Knob, value: number, taken: (x: number) => void): HTMLInputElement[] {
  const text = field(label, value, (x) => { bar.value = String(Math.round(steps * share(knob, x))); taken(x); return undefined; });
  const bar = slider(`${label} (slider)`, knob, value, (x) => { text.value = short(x); taken(x); });
  return [bar, text];
}

/** Three fields, and a slider that scales all of them. */
function colourRow(knob: Knob, own: number[], change: Change): HTMLElement[] {
  const hue = [...own]; // used when the slider makes it black
  const tell = (all: number[]): undefined => void change(knob.path, `[${all.map(typed).join(", ")}]`);
  const fields = own.map((c, k) => field(`${knob.label} ${["red", "green", "blue"][k]}`, c, (x) => { hue[k] = x; return tell(hue); }));
  if (!(Math.max(...own) > 0)) return fields;
  return [slider(`${knob.label} (slider)`, knob, Math.max(...own), (x) => {
    const all = hue.map((c) => Number(short((c * x) / Math.max(...hue))));
    fields.forEach((one, k) => { one.value = typed(all[k]!); });
    tell(all);
  }), ...fields];
}

/** A slider and a field for each coordinate. */
function placeRow(knob: Knob, own: number[], change: Change): HTMLElement[] {
  const all = [...own];
  return ["x", "y", "z"].map((name, k) => el("div", { class: "row" }, el("span", { "aria-hidden": "true" }, name),
    ...pair(`${knob.label} ${name}`, knob, own[k]!, (x) => { all[k] = x; change(knob.path, `[${all.map(typed).join(", ")}]`); })));
}

/** A number: a slider and a field. Three numbers: a field for each, and sliders. */
function knobRow(knob: Knob, change: Change): HTMLElement {
  const legend = el("legend", {}, knob.unit ? `${knob.label}, ${knob.unit}` : knob.label);
  const set = (...rows: HTMLElement[]): HTMLElement => el("fieldset", { class: "knob", "data-path": knob.path }, legend, ...rows);
  const row = (inside: HTMLElement[]): HTMLElement => set(el("div", { class: "row" }, ...inside));
  const { value } = knob;
  if (typeof value !== "number") return knob.low < 0 ? set(...placeRow(knob, value, change)) : row(colourRow(knob, value, change));
  if (knob.path !== "seed") return row(pair(knob.label, knob, value, (x) => change(knob.path, typed(x))));
  const text = field(knob.label, value, (x) => { change(knob.path, String(Math.max(0, Math.round(x)))); return undefined; });
  text.value = String(value);
  return row([text]);
}

/** Its four ends; none passes the opposite one, or the picture's edge. */
function regionRow(region: Region, { width, height }: Described, change: Change): HTMLElement {
  const names = ["left", "bottom", "right", "top"], box = [...region.box];
  const fields = box.map((x, k) => field(`region ${region.name} ${names[k]}`, x, (to) => {
    const low = [0, 0, box[0]! + 1, box[1]! + 1][k]!, high = [box[2]! - 1, box[3]! - 1, width - 1, height - 1][k]!;
    box[k] = Math.max(low, Math.min(high, Math.round(to)));
    change(`regions.${region.name}.box`, `[${box.join(", ")}]`);
    return box[k]!;
  }));
  return el("fieldset", { class: "knob", "data-path": `regions.${region.name}.box` },
    el("legend", {}, `region ${region.name}, pixels`), el("div", { class: "row" }, ...fields));
}

/** All rows; `only`: the paths that a lesson allows to change. */
export function controlRows(d: Described, change: Change, only: readonly string[] | undefined): HTMLElement[] {
  const wanted = (path: string): boolean => !only || only.includes(path);
  const knobs = d.knobs.filter((knob) => wanted(knob.path)).map((knob) => knobRow(knob, change));
  const regions = d.regions.filter((r) => wanted(`regions.${r.name}.box`)).map((r) => regionRow(r, d, change));
  return [...knobs, ...regions];
}

/** options: a value, its words, and whether it cannot be chosen. */
export function choice(id: string, label: string, options: [string, string, boolean?][], chosen: string, taken: (value: string) => void): HTMLElement {
  const select = el("select", { id, onchange: (e): void => taken((e.target as HTMLSelectElement).value) },
    ...options.map(([value, words, disabled = false]) => el("option", { value, selected: value === chosen, disabled }, words)));
  return el("div", { class: "choice" }, el("label", { for: id }, label), select);
}
