// The pictures side by side, each with its metrics, the hash of its film and the program's.
import { Box } from "./api";
import { el, made, minus } from "./dom";
import { Arm, Described, Metric, Model, Shown } from "./model";
import { byKey, Frame, Outlined, Picking } from "./frame";
import { State } from "./state";
import { figures, scaleBar } from "./text";

const mine = "mine";

/** One picture: index of its film, or -1 for the reference. */
export class Picture {
  readonly root: HTMLElement;
  private readonly frame: Frame;
  private readonly words = el("figcaption");
  private readonly aim = el("p", { class: "aim" });
  private readonly versus = el("p", { class: "aim" });
  private readonly table = el("div", { class: "metrics" });

  constructor(readonly index: number, private d: Described, private readonly picking: Picking) {
    this.frame = new Frame(d, picking);
    this.canvas.tabIndex = 0;
    this.root = el("figure", { class: index < 0 ? "reference" : "shown" }, this.frame.root, this.words, el("div", {}, this.versus, this.aim), this.table);
  }

  /** The same film with other settings: the last picture stays until it is painted over. */
  opened(d: Described): void { this.d = d; }

  get canvas(): HTMLCanvasElement { return this.frame.canvas; }

  name(title: string, line: string): void {
    this.words.replaceChildren(el("b", {}, title), line ? ` ${line}` : "");
    this.canvas.setAttribute("aria-label", `${title} ${line}. Arrow keys choose a pixel.`);
  }

  /** The axis of the arm, and its density; for two techniques, their weights. */
  about(arm: Arm): void {
    if (!arm.formula) return this.aim.replaceChildren(arm.summary);
    this.aim.replaceChildren(made(`${arm.summary}: <math><mi>${arm.techniques > 1 ? "w" : "p"}</mi><mo>=</mo>${arm.formula}</math>`));
  }

  /** The scale of the neighbouring maps, under the reference. */
  legend(model: Model, state: State, top: number): void {
    if (state.view === "photograph" || !model.referenceDone) return this.table.replaceChildren();
    const heat = state.view === "heat", width = 256, end = figures(top);
    const bar = el("canvas", { width, height: 1, class: "bar", role: "img", "aria-label": heat ? `the colours of |Y − Y_ref| from 0 to ${end}` : "the two colours of the signed maps" });
    bar.getContext("2d")!.putImageData(scaleBar(heat ? 1 : 2, width), 0, 0);
    const ends = heat ? ["|Y − Y_ref| = 0", end] : [`the other arm is nearer by ${end}`, `this one by ${end}`];
    this.table.replaceChildren(bar, el("p", { class: "ends" }, ...ends.map((words) => el("span", {}, words))));
  }

  /** The corners of a drawn region can be moved; the tab key reaches those on the reference. */
  outlines(pixel: [number, number] | undefined): void {
    const own = (name: string): Partial<Outlined> => (name === mine ? { move: this.picking.region, reached: this.index < 0 } : {});
    this.frame.outlines(this.d.regions.map((region) => ({ ...region, ...own(region.name) })), pixel);
  }

  /** Paints a box of it, if it is still wanted when it comes. */
  async paint(model: Model, state: State, top: number, box: Box, wanted: () => boolean): Promise<void> {
    const kind = this.index < 0 || state.view === "photograph" ? 0 : state.view === "heat" ? 1 : 2;
    const other = (this.index + 1) % model.shown.length;
    this.versus.textContent = kind !== 2 ? "" : other === this.index ? "choose a second arm to compare it with" : `compared with ${model.shown[other]!.name}`;
    const pixels = await model.pixels(wanted, { picture: kind, index: this.index, other: Math.max(other, 0), top, times: 1 }, box);
    if (pixels) this.canvas.getContext("2d")!.putImageData(pixels, box.x0, this.d.height - box.y1);
  }

  repaint(model: Model, state: State, top: number, wanted: () => boolean): Promise<void> {
    return this.paint(model, state, top, { x0: 0, y0: 0, x1: this.d.width, y1: this.d.height }, wanted);
  }

  private beside(hash: string, program: string | undefined): (Node | string)[] {
    if (!program) return [];
    const verdict = hash === program ? ": the same bits" : el("b", { class: "bad" }, ": not the same bits");
    return [", the program's ", el("code", {}, program), verdict];
  }

  /** Every row exists from the start, so that nothing moves when its number arrives. `native`: the hash of the
   *  program's film, if this is one of its films. */
  metrics(s: Shown, native: (key: string) => string | undefined): void {
    const last = s.sampleCounts.at(-1);
    this.name(s.name, last ? `N = ${last.n}` : "being sampled");
    const m = last?.metrics, rows: HTMLTableRowElement[] = [], waiting: Metric = { value: 0, text: "…" };
    const row = (name: string, metric: Metric | undefined = last ? undefined : waiting, note = ""): void => {
      if (!metric) return;
      const room = this.d.source !== "" && !note; // for published values, if there are any
      const published = metric.published || room ? el("small", {}, metric.published ? `published ${minus(metric.published)}` : "\u00a0") : undefined;
      rows.push(el("tr", {}, el("th", { scope: "row" }, name),
        el("td", { class: "n" }, minus(metric.text), published)));
      if (note) rows.push(el("tr", { class: "note" }, el("td", { colspan: 2 }, note)));
    };
    for (const { name } of this.d.regions) {
      row(`RMSE of ${name}`, m?.metrics[`rmse.${name}`], m?.unsure?.includes(name) ? "the reference is not good enough" : "");
      if (m?.own?.[name]) row(`error of the reference in ${name}`, { value: 0, text: m.own[name]! });
      const tail = s.tails[name];
      row(`tail k̂ of ${name}`, tail ? { value: 0, text: tail.text ?? "–" } : waiting, tail?.words ?? "being measured");
    }
    row("fireflies", m?.metrics["fireflies"]);
    row("under the horizon", m?.metrics["horizon_frac"]);
    row("mean Y", m?.metrics["y_mean"]);
    if (m && m.bad > 0) row("not a number", { value: m.bad, text: String(m.bad) });
    this.table.replaceChildren(el("table", {}, el("tbody", {}, ...rows)),
      el("p", { class: "hash" }, ...(m && last ? ["film ", el("code", { "data-hash": `${s.name} ${last.n}` }, m.hash), ...this.beside(m.hash, native(m.key))] : ["film …"])));
  }
}

/** The path under which a drawn region is set. */
export const drawnRegion = `regions.${mine}.box`;

/** The pixel that an arrow key leads to, ten pixels with shift; from the middle if none is selected. */
export function byArrow(event: KeyboardEvent, from: [number, number] | undefined, d: Described): [number, number] | undefined {
  const by = byKey(event);
  if (!by) return undefined;
  const [i, j] = from ?? [d.width >> 1, d.height >> 1];
  const clip = (x: number, most: number): number => Math.max(0, Math.min(most - 1, x));
  return [clip(i + by[0], d.width), clip(j + by[1], d.height)];
}
