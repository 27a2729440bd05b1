// The pictures side by side, each with its meters, the hash of its film and the program's.
import { Box } from "./door";
import { el, made } from "./dom";
import { Arm, Described, Meter, Model, Shown } from "./model";
import { Frame, Picking } from "./frame";
import { State } from "./state";

const mine = "mine";

/** One picture: index of its film, or -1 for the reference. */
export class Picture {
  readonly root: HTMLElement;
  private readonly frame: Frame;
  private readonly words = el("figcaption");
  private readonly aim = el("p", { class: "aim" });
  private readonly versus = el("p", { class: "aim" });
  private readonly table = el("div", { class: "meters" });

  constructor(readonly index: number, private readonly d: Described, picking: Picking) {
    this.frame = new Frame(d, picking);
    this.canvas.tabIndex = 0;
    this.root = el("figure", { class: index < 0 ? "reference" : "shown" }, this.frame.root, this.words, this.versus, this.aim, this.table);
  }

  get canvas(): HTMLCanvasElement { return this.frame.canvas; }

  name(title: string, line: string): void {
    this.words.replaceChildren(el("b", {}, title), line ? ` ${line}` : "");
    this.canvas.setAttribute("aria-label", `${title} ${line}. Arrow keys choose a pixel.`);
  }

  /** What the arm aims by, and its density; of two techniques, their weights. */
  about(arm: Arm): void {
    this.aim.replaceChildren(made(`${arm.summary}: <math><mi>${arm.techniques > 1 ? "w" : "p"}</mi><mo>=</mo>${arm.formula}</math>`));
  }

  /** The scale of the maps beside, under the reference. */
  legend(model: Model, state: State, top: number): void {
    if (state.view === "photograph" || !model.referenceDone) return this.table.replaceChildren();
    const heat = state.view === "heat", width = 256, end = model.door.say("figures", undefined, top);
    const bar = el("canvas", { width, height: 1, class: "bar", role: "img", "aria-label": heat ? `the colours of |Y − Y_ref| from 0 to ${end}` : "the two colours of the signed maps" });
    bar.getContext("2d")!.putImageData(new ImageData(new Uint8ClampedArray(model.door.bytes("scale_bar", 4 * width, heat ? 1 : 2, width)), width, 1), 0, 0);
    const ends = heat ? ["|Y − Y_ref| = 0", end] : [`the other arm is nearer by ${end}`, `this one by ${end}`];
    this.table.replaceChildren(bar, el("p", { class: "ends" }, ...ends.map((words) => el("span", {}, words))));
  }

  outlines(pixel: [number, number] | undefined): void { this.frame.outlines(this.d.regions, pixel); }

  paint(model: Model, state: State, top: number, box: Box): void {
    const kind = this.index < 0 || state.view === "photograph" ? 0 : state.view === "heat" ? 1 : 2;
    const other = (this.index + 1) % model.shown.length;
    this.versus.textContent = kind !== 2 ? "" : other === this.index ? "choose a second arm to compare it with" : `compared with ${model.shown[other]!.name}`;
    const pixels = model.pixels(kind, this.index, Math.max(other, 0), top, box);
    this.canvas.getContext("2d")!.putImageData(pixels, box.x0, this.d.height - box.y1);
  }

  private beside(hash: string, program: string | undefined): (Node | string)[] {
    if (!program) return [];
    const verdict = hash === program ? ": the same bits" : el("b", { class: "bad" }, ": not the same bits");
    return [", the program's ", el("code", {}, program), verdict];
  }

  /** `native`: the hash of the program's film, where this one has it. */
  meters(s: Shown, native: (key: string) => string | undefined): void {
    const last = s.rungs.at(-1);
    this.name(s.name, last ? `N = ${last.n}` : "being sampled");
    if (!last) return;
    const m = last.meters, rows: HTMLTableRowElement[] = [];
    const row = (name: string, meter: Meter | undefined, note = ""): void => {
      if (!meter) return;
      const published = meter.published ? el("small", {}, `published ${meter.published}`) : undefined;
      rows.push(el("tr", {}, el("th", { scope: "row" }, name),
        el("td", { class: "n" }, meter.text, published, note ? el("small", {}, note) : undefined)));
    };
    for (const { name } of this.d.regions) {
      row(`RMSE of ${name}`, m.meters[`rmse.${name}`], m.unsure?.includes(name) ? "the reference is not good enough" : "");
      const tail = s.tails[name];
      if (tail) row(`tail k̂ of ${name}`, { value: 0, text: tail.text ?? "–" }, tail.words);
    }
    row("fireflies", m.meters["fireflies"]);
    row("under the horizon", m.meters["horizon_frac"]);
    row("mean Y", m.meters["y_mean"]);
    if (m.bad > 0) row("not a number", { value: m.bad, text: String(m.bad) });
    this.table.replaceChildren(el("table", {}, el("tbody", {}, ...rows)),
      el("p", { class: "hash" }, "film ", el("code", { "data-hash": `${s.name} ${last.n}` }, m.hash), ...this.beside(m.hash, native(m.key))));
  }
}

/** The path under which a region that was drawn is set. */
export const drawnRegion = `regions.${mine}.box`;

/** The pixel that an arrow key leads to, ten pixels on with shift; from the middle where none is chosen. */
export function byArrow(event: KeyboardEvent, from: [number, number] | undefined, d: Described): [number, number] | undefined {
  const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (!by) return undefined;
  event.preventDefault();
  const step = event.shiftKey ? 10 : 1, [i, j] = from ?? [d.width >> 1, d.height >> 1];
  const clip = (x: number, most: number): number => Math.max(0, Math.min(most - 1, x));
  return [clip(i + step * by[0]!, d.width), clip(j + step * by[1]!, d.height)];
}
