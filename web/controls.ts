// Sliders and fields for what may be changed, made from the knobs that the core names. A value goes into the state as
// text that --set takes; a value that is the experiment's own leaves it.
import { el } from "./dom";
import { Described, Knob, Region } from "./model";

type Change = (path: string, value: string | undefined) => void;

const steps = 1000;
const short = (x: number): string => String(Number(x.toPrecision(4)));

/** Where a value lies on a slider, and back. */
function share(knob: Knob, x: number): number {
  if (!knob.log) return (x - knob.low) / (knob.high - knob.low);
  return Math.log(Math.max(x, knob.low) / knob.low) / Math.log(knob.high / knob.low);
}
function valueAt(knob: Knob, t: number): number {
  return knob.log ? knob.low * (knob.high / knob.low) ** t : knob.low + t * (knob.high - knob.low);
}

/** taken: returns what becomes of x, where that may be another value. */
function field(label: string, value: number, taken: (x: number) => number | undefined): HTMLInputElement {
  return el("input", {
    type: "text", inputmode: "decimal", "aria-label": label, value: short(value), class: "number",
    onchange: (event): void => {
      const input = event.target as HTMLInputElement, x = Number(input.value.trim() || NaN);
      if (!Number.isFinite(x)) { input.value = short(value); return; }
      const becomes = taken(x);
      value = becomes ?? x;
      if (becomes !== undefined) input.value = short(value);
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

/** A number: a slider and a field. Three numbers: three fields and, for a colour, a slider that scales all. */
function knobRow(knob: Knob, change: Change): HTMLElement {
  const legend = knob.unit ? `${knob.label}, ${knob.unit}` : knob.label;
  const inside: HTMLElement[] = [];
  if (typeof knob.value === "number") {
    const write = knob.path === "seed" ? (x: number): string => String(Math.max(0, Math.round(x))) : short;
    const text = field(knob.label, knob.value, (x) => { change(knob.path, write(x)); return undefined; });
    if (knob.path === "seed") text.value = String(knob.value);
    else inside.push(slider(`${knob.label} (slider)`, knob, knob.value, (x) => { text.value = short(x); change(knob.path, short(x)); }));
    inside.push(text);
  } else {
    let all = knob.value;
    const names = knob.low < 0 ? ["x", "y", "z"] : ["red", "green", "blue"];
    const set = (values: number[]): undefined => void change(knob.path, `[${(all = values).map(short).join(", ")}]`);
    const most = Math.max(...all);
    if (knob.low >= 0 && most > 0)
      inside.push(slider(`${knob.label} (slider)`, knob, most, (x) => set(all.map((c) => (c * x) / (Math.max(...all) || 1)))));
    inside.push(...all.map((c, k) => field(`${knob.label} ${names[k] ?? k}`, c, (x) => set(all.map((old, at) => (at === k ? x : old))))));
  }
  return el("fieldset", { class: "knob", "data-path": knob.path }, el("legend", {}, legend), el("div", { class: "row" }, ...inside));
}

/** Its four ends; none passes the one beyond, or the picture's edge. */
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

/** All rows; `only`: the paths that a lesson lets one play with. */
export function controlRows(d: Described, change: Change, only: readonly string[] | undefined): HTMLElement[] {
  const wanted = (path: string): boolean => !only || only.includes(path);
  const knobs = d.knobs.filter((knob) => wanted(knob.path)).map((knob) => knobRow(knob, change));
  const regions = d.regions.filter((r) => wanted(`regions.${r.name}.box`)).map((r) => regionRow(r, d, change));
  return [...knobs, ...regions];
}

export function choice(id: string, label: string, options: [string, string][], chosen: string, taken: (value: string) => void): HTMLElement {
  const select = el("select", { id, onchange: (e): void => taken((e.target as HTMLSelectElement).value) },
    ...options.map(([value, words]) => el("option", { value, selected: value === chosen }, words)));
  return el("div", { class: "choice" }, el("label", { for: id }, label), select);
}
