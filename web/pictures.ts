// The pictures side by side, each with its meters: a canvas of the experiment's size, regions drawn over it, a pixel to
// choose by pointer or by arrow keys, a region to draw by dragging.
import { Box } from "./door";
import { el, made } from "./dom";
import { Arm, Described, Meter, Model, Shown } from "./model";
import { State } from "./state";

export interface Picking {
  pixel(i: number, j: number): void;
  region(box: [number, number, number, number]): void;
}

const mine = "mine";

/** One picture: index of its film, or -1 for the reference. */
export class Picture {
  readonly canvas: HTMLCanvasElement;
  readonly root: HTMLElement;
  private readonly over = el("div", { class: "over" });
  private readonly words = el("figcaption");
  private readonly aim = el("p", { class: "aim" });
  private readonly table = el("div", { class: "meters" });
  private from: [number, number] | undefined;

  constructor(readonly index: number, private readonly d: Described, private readonly picking: Picking) {
    this.canvas = el("canvas", { width: d.width, height: d.height, tabindex: 0, role: "img" });
    const frame = el("div", { class: "frame" }, this.canvas, this.over);
    this.root = el("figure", { class: index < 0 ? "reference" : "shown" }, frame, this.words, this.aim, this.table);
    this.canvas.addEventListener("pointerdown", (e) => { this.from = this.at(e); this.canvas.setPointerCapture(e.pointerId); });
    this.canvas.addEventListener("pointermove", (e) => this.drag(e));
    this.canvas.addEventListener("pointerup", (e) => this.drop(e));
    this.canvas.addEventListener("pointercancel", () => { this.from = undefined; });
  }

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
    const ends = heat ? ["|Y − Y_ref| = 0", end] : [`the next is nearer by ${end}`, `this one by ${end}`];
    this.table.replaceChildren(bar, el("p", { class: "ends" }, ...ends.map((words) => el("span", {}, words))));
  }

  /** Pixel (i, j) under the pointer, from the bottom-left. */
  private at(event: PointerEvent): [number, number] {
    const r = this.canvas.getBoundingClientRect(), { width, height } = this.d;
    const clip = (x: number, most: number): number => Math.max(0, Math.min(most - 1, Math.floor(x)));
    return [clip(((event.clientX - r.left) / r.width) * width, width), clip(((r.bottom - event.clientY) / r.height) * height, height)];
  }
  private dragged(event: PointerEvent): [number, number, number, number] | undefined {
    if (!this.from) return undefined;
    const [a, b] = this.from, [c, d] = this.at(event);
    if (Math.abs(a - c) < 6 || Math.abs(b - d) < 6) return undefined;
    return [Math.min(a, c), Math.min(b, d), Math.max(a, c), Math.max(b, d)];
  }
  private drag(event: PointerEvent): void {
    const box = this.dragged(event);
    this.over.querySelector(".dragging")?.remove();
    if (box) this.over.append(this.outline(box, "dragging", ""));
  }
  private drop(event: PointerEvent): void {
    const box = this.dragged(event), from = this.from;
    this.from = undefined;
    this.over.querySelector(".dragging")?.remove();
    if (box) this.picking.region(box);
    else if (from) this.picking.pixel(...from);
  }

  private outline(box: readonly number[], css: string, name: string): HTMLElement {
    const [x0, y0, x1, y1] = box as [number, number, number, number], { width, height } = this.d;
    const made = el("div", { class: css }, name ? el("span", {}, name) : undefined);
    made.style.left = `${(100 * x0) / width}%`;
    made.style.width = `${(100 * (x1 - x0 + 1)) / width}%`;
    made.style.top = `${(100 * (height - 1 - y1)) / height}%`;
    made.style.height = `${(100 * (y1 - y0 + 1)) / height}%`;
    return made;
  }

  outlines(pixel: [number, number] | undefined): void {
    const regions = this.d.regions.map((r) => this.outline(r.box, "region", r.name));
    const chosen = pixel ? [this.outline([...pixel, ...pixel], "pixel", "")] : [];
    this.over.replaceChildren(...regions, ...chosen);
  }

  paint(model: Model, state: State, top: number, box: Box): void {
    const kind = this.index < 0 || state.view === "photograph" ? 0 : state.view === "heat" ? 1 : 2;
    const other = (this.index + 1) % model.shown.length;
    const pixels = model.pixels(kind, this.index, Math.max(other, 0), top, box);
    this.canvas.getContext("2d")!.putImageData(pixels, box.x0, this.d.height - box.y1);
  }

  meters(s: Shown): void {
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
      el("p", { class: "hash" }, "film ", el("code", { "data-hash": `${s.name} ${last.n}` }, m.hash)));
  }
}

/** The path under which a region that was drawn is set. */
export const drawnRegion = `regions.${mine}.box`;
