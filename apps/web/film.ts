// The main film: two of sampler, reference, error and variance, side by side or under a wipe, on one canvas with one
// view. Zoom by wheel, pinch and keys, down to single pixels; the values of a pixel; exposure; regions.
import { Box } from "./api";
import { choice } from "./controls";
import { el } from "./dom";
import { byKey, Drawn } from "./frame";
import { Described, Model, Shown } from "./model";
import { figures, scaleBar } from "./text";

export interface FilmHost {
  model: Model;
  choose(pixel: [number, number]): void;
  region?(box: Drawn): void;
}
type Kind = "film" | "reference" | "error" | "variance";
interface Layer { kind: Kind; index: number; canvas: HTMLCanvasElement }
type Mode = "wipe" | "side" | "one";
interface Rect { x: number; y: number; w: number; h: number }

const unit = "W/(sr m²)";
const mostZoom = 64; // times the size at which the film fits
const narrow = 560; // CSS pixels: below it two panels are stacked

export class FilmView {
  readonly root: HTMLElement;
  readonly canvas: HTMLCanvasElement;
  private readonly bars = el("div", { class: "bars" });
  private readonly readout = el("p", { class: "readout" });
  private readonly tools = el("div", { class: "choices film-tools" });
  private readonly wipe: HTMLInputElement;
  private d: Described | undefined;
  private shown: Shown[] = [];
  private names: [string, string] = ["film 0", "film 1"]; // of the panels: keys of layers
  private layers: Layer[] = [];
  private mode: Mode = "wipe";
  private at = 0.5; // of the wipe
  private stops = 0;
  private scales = { top: 1, variance: 1 };
  private zoom = 1;
  private centre: [number, number] = [0, 0]; // film pixels, from the top-left
  private pixel: [number, number] | undefined;
  private era = 0;
  private asked = 0;
  private drawing = false; // a region
  private dragging: Drawn | undefined;
  private frame = 0;
  private fresh = false; // nothing of this size was drawn yet
  private repainting = 0;
  private readonly pointers = new Map<number, [number, number]>();
  private moved = 0; // CSS pixels that the pointer went since it was put down
  private pull: "wipe" | "view" | "region" | undefined;
  private from: [number, number] = [0, 0]; // where it was put down

  constructor(private readonly host: FilmHost, private readonly id: string, private readonly prefer: [string, string] | undefined = undefined) {
    this.canvas = el("canvas", { id, class: "main-film", tabindex: 0, role: "img", "aria-describedby": `${id}-keys` });
    this.wipe = el("input", {
      type: "range", id: `${id}-wipe`, min: 0, max: 100, value: 50, "aria-label": "where the wipe is, %",
      oninput: () => { this.at = Number(this.wipe.value) / 100; this.draw(); },
    });
    this.root = el("div", { class: "film" }, this.tools, el("div", { class: "film-frame" }, this.canvas), this.wipe, this.bars, this.readout,
      el("p", { class: "footnote", id: `${id}-keys` }, "Wheel, pinch, + and − zoom; dragging and the arrow keys move; 0 shows all of it; [ and ] move the wipe. A click opens the hemisphere of a pixel."));
    const { canvas } = this;
    canvas.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    canvas.addEventListener("pointerdown", (e) => this.down(e));
    canvas.addEventListener("pointermove", (e) => this.move(e));
    canvas.addEventListener("pointerup", (e) => this.up(e));
    canvas.addEventListener("pointercancel", (e) => this.up(e));
    canvas.addEventListener("keydown", (e) => this.key(e));
    new ResizeObserver(() => this.fit()).observe(this.root);
  }

  /** Another experiment, or the same with other settings: the view stays if the size does. */
  opened(d: Described, shown: Shown[]): void {
    ++this.era;
    const same = this.d?.width === d.width && this.d.height === d.height;
    const alike = same && this.shown.map(({ name }) => name).join() === shown.map(({ name }) => name).join();
    this.d = d;
    this.shown = shown;
    if (alike) return void (this.layers = this.layers.map((layer) => ({ ...layer }))); // layout takes longer than the first tile
    this.fresh = !same;
    if (!same) (this.zoom = 1), (this.centre = [d.width / 2, d.height / 2]), (this.layers = []);
    const keys = this.options().map(([key]) => key);
    const want = this.prefer ?? [keys[0]!, keys[1] ?? "reference"];
    this.names = this.names.map((name, k) => (keys.includes(name) && same ? name : keys.includes(want[k]!) ? want[k]! : keys[k]!)) as [string, string];
    this.layers = this.names.map((key, k) => this.layer(key, same ? this.layers[k] : undefined));
    this.scales = same ? this.scales : { top: 1, variance: 1 };
    this.controls();
    this.legend();
    this.label();
    this.fit();
  }

  private options(): [string, string][] {
    const of = (kind: Kind, words: string): [string, string][] => this.shown.map((s, k) => [`${kind} ${k}`, words.replace("*", s.name)]);
    return [...of("film", "*"), ["reference", "reference"], ...of("error", "error of *"), ...of("variance", "variance of *")];
  }

  /** The picture of a panel; the last one stays until it is painted over. */
  private layer(key: string, before?: Layer): Layer {
    const [kind, index] = key.split(" "), { width, height } = this.d!;
    const canvas = el("canvas", { width, height });
    if (before && before.kind === kind) canvas.getContext("2d")!.drawImage(before.canvas, 0, 0);
    return { kind: kind as Kind, index: kind === "reference" ? -1 : Number(index), canvas };
  }

  private controls(): void {
    const options = this.options(), held = document.activeElement?.id;
    const side = (k: 0 | 1): HTMLElement => choice(`${this.id}-${"ab"[k]}`, k === 0 ? "left" : "right", options, this.names[k], (value) => {
      this.names[k] = value;
      this.layers[k] = this.layer(value);
      this.legend();
      this.label();
      void this.repaint();
    });
    const button = (words: string, label: string, act: () => void): HTMLElement => el("button", { type: "button", "aria-label": label, onclick: act }, words);
    const stops = el("output", { for: `${this.id}-exposure` }, this.exposureWords());
    const exposure = el("input", {
      type: "range", id: `${this.id}-exposure`, min: -6, max: 6, step: 0.5, value: this.stops, "aria-label": "exposure, stops",
      oninput: () => { this.stops = Number(exposure.value); stops.textContent = this.exposureWords(); void this.repaint(); },
    });
    const region = this.host.region ? [el("button", { type: "button", "aria-pressed": String(this.drawing), onclick: (e: Event) => {
      this.drawing = !this.drawing;
      (e.target as HTMLElement).setAttribute("aria-pressed", String(this.drawing));
    } }, "Draw a region")] : [];
    this.tools.replaceChildren(side(0), side(1),
      choice(`${this.id}-mode`, "together", [["wipe", "under a wipe"], ["side", "side by side"], ["one", "left alone"]], this.mode, (value) => { this.mode = value as Mode; this.label(); this.fit(); }),
      el("div", { class: "choice" }, el("span", { class: "label" }, "exposure ", stops), exposure),
      el("div", { class: "zoom", role: "group", "aria-label": "zoom" }, button("−", "zoom out", () => this.zoomBy(1 / 2)), button("+", "zoom in", () => this.zoomBy(2)), button("1:1", "one film pixel for one of the screen", () => this.toPixels()), button("all", "show all of it", () => this.reset())), ...region);
    if (held) document.getElementById(held)?.focus();
  }
  private exposureWords(): string { return `${this.stops > 0 ? "+" : this.stops < 0 ? "−" : ""}${Math.abs(this.stops)} stops`; }

  private title(k: 0 | 1): string { return this.options().find(([key]) => key === this.names[k])?.[1] ?? ""; }
  private label(): void {
    const [a, b] = [this.title(0), this.title(1)];
    this.canvas.setAttribute("aria-label", this.mode === "one" ? a : `${a} on the left, ${b} on the right, ${this.mode === "wipe" ? "under a wipe" : "side by side"}`);
    this.wipe.hidden = this.mode !== "wipe";
  }

  /** The scales of error and variance, with their units; room for them is kept. */
  private legend(): void {
    const width = 256, shown = this.mode === "one" ? this.layers.slice(0, 1) : this.layers;
    const bar = (words: string, low: string, high: string): HTMLElement => {
      const canvas = el("canvas", { width, height: 1, class: "bar", role: "img", "aria-label": `${words}: colours from ${low} to ${high}` });
      canvas.getContext("2d")!.putImageData(scaleBar(1, width), 0, 0);
      return el("div", {}, canvas, el("p", { class: "ends" }, ...[low, words, high].map((text) => el("span", {}, text))));
    };
    const kinds = new Set(shown.map(({ kind }) => kind)), { top, variance } = this.scales;
    this.bars.replaceChildren(
      ...(kinds.has("error") ? [bar(`|Y − Y_ref|, ${unit}`, "0", figures(top))] : []),
      ...(kinds.has("variance") ? [bar(`variance of one sample, (${unit})²`, figures(variance * 1e-6), figures(variance))] : []));
  }

  painted(index: number, box: Box): void {
    for (const layer of this.layers)
      if (layer.index === index && (layer.kind === "film" || layer.kind === "reference" || layer.kind === "variance" || this.host.model.referenceDone)) this.paint(layer, box).catch(() => {}); // the model reports what fails
  }

  /** After metrics: the scales, and what is measured by them. */
  async measured(): Promise<void> {
    const scales = await this.host.model.scales().catch(() => undefined); // the model reports what fails
    if (!scales) return;
    this.scales = scales;
    this.legend();
    await Promise.all(this.layers.filter(({ kind }) => kind === "error" || kind === "variance").map((layer) => this.paint(layer).catch(() => {})));
  }

  private async repaint(): Promise<void> {
    const mine = ++this.repainting;
    await Promise.resolve();
    if (mine === this.repainting) await Promise.all(this.layers.map((layer) => this.paint(layer).catch(() => {})));
  }

  private async paint(layer: Layer, box: Box = { x0: 0, y0: 0, x1: this.d!.width, y1: this.d!.height }): Promise<void> {
    const { era } = this, { top, variance } = this.scales, stops = this.stops;
    const still = (): boolean => era === this.era && this.layers.includes(layer) && stops === this.stops;
    if (layer.kind === "error" && !this.host.model.referenceDone) return;
    const picture = { film: 0, reference: 0, error: 1, variance: 3 }[layer.kind];
    const pixels = await this.host.model.pixels(still, { picture, index: layer.index, other: 0, top: layer.kind === "variance" ? variance : top, times: 2 ** stops }, box);
    if (!pixels) return;
    layer.canvas.getContext("2d")!.putImageData(pixels, box.x0, this.d!.height - box.y1);
    this.draw();
  }

  // ---- The view.

  /** The panels in CSS pixels of the canvas. */
  private panels(): Rect[] {
    const w = this.canvas.clientWidth, h = this.canvas.clientHeight;
    if (this.mode !== "side") return [{ x: 0, y: 0, w, h }];
    return w < narrow ? [{ x: 0, y: 0, w, h: h / 2 }, { x: 0, y: h / 2, w, h: h / 2 }] : [{ x: 0, y: 0, w: w / 2, h }, { x: w / 2, y: 0, w: w / 2, h }];
  }
  /** CSS pixels of one film pixel. */
  private scale(panel: Rect): number { return (panel.w / this.d!.width) * this.zoom; }
  private origin(panel: Rect): [number, number] {
    const s = this.scale(panel);
    return [panel.x + panel.w / 2 - this.centre[0] * s, panel.y + panel.h / 2 - this.centre[1] * s];
  }
  private panelAt(x: number, y: number): Rect { return this.panels().find((p) => x >= p.x && x < p.x + p.w && y >= p.y && y < p.y + p.h) ?? this.panels()[0]!; }
  /** Film coordinates, from the top-left, of a place on the canvas. */
  private filmAt([x, y]: [number, number]): [number, number] {
    const panel = this.panelAt(x, y), [ox, oy] = this.origin(panel), s = this.scale(panel);
    return [(x - ox) / s, (y - oy) / s];
  }
  private pixelAt(place: [number, number]): [number, number] | undefined {
    const [x, y] = this.filmAt(place), { width, height } = this.d!, i = Math.floor(x), j = height - 1 - Math.floor(y);
    return i >= 0 && j >= 0 && i < width && j < height ? [i, j] : undefined;
  }

  private keep(): void {
    const { width, height } = this.d!, half = [width / 2 / this.zoom, height / 2 / this.zoom];
    this.centre = [width, height].map((size, k) => Math.max(half[k]!, Math.min(size - half[k]!, this.centre[k]!))) as [number, number];
    this.canvas.style.touchAction = this.zoom > 1 || this.drawing ? "none" : "pan-y";
    this.canvas.dataset["zoom"] = String(Number(this.zoom.toPrecision(4)));
    this.draw();
  }
  private zoomBy(by: number, place?: [number, number]): void {
    if (!this.d) return;
    const about = place ? this.filmAt(place) : this.pixel ? [this.pixel[0] + 0.5, this.d.height - 0.5 - this.pixel[1]] as [number, number] : this.centre;
    const most = (mostZoom * Math.max(1, this.d.width / 960)), next = Math.max(1, Math.min(most, this.zoom * by)), ratio = this.zoom / next;
    if (place) this.centre = [about[0] + (this.centre[0] - about[0]) * ratio, about[1] + (this.centre[1] - about[1]) * ratio];
    else this.centre = about;
    this.zoom = next;
    this.keep();
  }
  private toPixels(): void { this.zoomBy(1 / this.scale(this.panels()[0]!)); }
  private reset(): void { this.zoom = 1; this.centre = [this.d!.width / 2, this.d!.height / 2]; this.keep(); }

  private fit(): void {
    if (!this.d) return;
    const room = this.root.clientWidth, { width, height } = this.d;
    if (room === 0) return;
    // As large as the window shows as a whole; 900 pixels at least, where there are so many.
    const w = this.mode === "side" ? room : Math.min(room, Math.max(900, Math.round((0.8 * window.innerHeight * width) / height)));
    this.canvas.style.width = this.wipe.style.width = `${w}px`;
    const stacked = this.mode === "side" && w < narrow, panel = this.mode === "side" && !stacked ? w / 2 : w;
    const h = Math.round((panel * height) / width) * (stacked ? 2 : 1), density = Math.min(2, window.devicePixelRatio || 1);
    this.canvas.style.height = `${h}px`;
    if (this.canvas.width !== Math.round(w * density) || this.canvas.height !== Math.round(h * density)) {
      this.canvas.width = Math.round(w * density);
      this.canvas.height = Math.round(h * density);
    }
    this.keep();
  }

  /** Draws in the next frame. */
  private draw(): void {
    if (!this.frame) this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      if (!this.fresh) return this.drawNow();
      this.fresh = false; // the first frame lays out the page
      this.draw();
    });
  }
  private drawNow(): void {
    const pen = this.canvas.getContext("2d"), w = this.canvas.clientWidth, h = this.canvas.clientHeight;
    if (!pen || !this.d || w === 0) return;
    const density = this.canvas.width / w;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.fillStyle = "#000";
    pen.fillRect(0, 0, this.canvas.width, this.canvas.height);
    const panels = this.panels(), wiped = this.mode === "wipe", cut = Math.round(w * this.at);
    const all: [Rect, Rect, Layer][] = wiped
      ? [[panels[0]!, { x: 0, y: 0, w: cut, h }, this.layers[0]!], [panels[0]!, { x: cut, y: 0, w: w - cut, h }, this.layers[1]!]]
      : panels.map((panel, k) => [panel, panel, this.layers[k]!]);
    all.forEach(([panel, clip, layer], k) => {
      pen.save();
      pen.scale(density, density);
      pen.beginPath();
      pen.rect(clip.x, clip.y, clip.w, clip.h);
      pen.clip();
      const [x, y] = this.origin(panel), s = this.scale(panel);
      pen.imageSmoothingEnabled = s * density < 1;
      pen.drawImage(layer.canvas, x, y, this.d!.width * s, this.d!.height * s);
      this.marks(pen, x, y, s);
      pen.restore();
      this.name(pen, density, clip, this.title(k as 0 | 1), wiped && k === 1);
    });
    if (wiped) this.handle(pen, density, cut, h);
  }

  /** Regions, and the selected pixel. */
  private marks(pen: CanvasRenderingContext2D, x: number, y: number, s: number): void {
    const { height, regions } = this.d!;
    const box = ([x0, y0, x1, y1]: readonly number[], colour: string): void => {
      const place: [number, number, number, number] = [x + x0! * s, y + (height - 1 - y1!) * s, (x1! - x0! + 1) * s, (y1! - y0! + 1) * s];
      pen.lineWidth = 3;
      pen.strokeStyle = "#000";
      pen.strokeRect(...place);
      pen.lineWidth = 1.5;
      pen.strokeStyle = colour;
      pen.strokeRect(...place);
    };
    pen.font = "600 12px Inter, sans-serif";
    for (const { name, box: ends } of regions) {
      box(ends, "#fff");
      const [left, top] = [x + ends[0] * s, y + (height - 1 - ends[3]) * s];
      pen.fillStyle = "rgb(0 0 0 / 0.7)";
      pen.fillRect(left, top - 17, pen.measureText(name).width + 8, 16);
      pen.fillStyle = "#fff";
      pen.fillText(name, left + 4, top - 5);
    }
    if (this.dragging) box(this.dragging, "#ff0");
    if (this.pixel) {
      const r = Math.max(0, 5 / s - 0.5); // a pixel is marked by a box that can be seen
      box([this.pixel[0] - r, this.pixel[1] - r, this.pixel[0] + r, this.pixel[1] + r], "#ff0");
    }
  }
  private name(pen: CanvasRenderingContext2D, density: number, clip: Rect, words: string, right: boolean): void {
    if (clip.w < 24) return;
    pen.save();
    pen.scale(density, density);
    pen.font = "600 13px Inter, sans-serif";
    const wide = pen.measureText(words).width + 14, x = right ? clip.x + clip.w - wide : clip.x;
    pen.fillStyle = "rgb(0 0 0 / 0.72)";
    pen.fillRect(x, clip.y, wide, 24);
    pen.fillStyle = "#fff";
    pen.fillText(words, x + 7, clip.y + 17);
    pen.restore();
  }
  private handle(pen: CanvasRenderingContext2D, density: number, cut: number, h: number): void {
    pen.save();
    pen.scale(density, density);
    pen.fillStyle = "#000";
    pen.fillRect(cut - 2, 0, 4, h);
    pen.fillStyle = "#fff";
    pen.fillRect(cut - 1, 0, 2, h);
    pen.beginPath();
    pen.arc(cut, h / 2, 12, 0, 2 * Math.PI);
    pen.fill();
    pen.fillStyle = "#141517";
    pen.font = "600 13px Inter, sans-serif";
    pen.fillText("↔", cut - 7, h / 2 + 5);
    pen.restore();
  }

  // ---- Pointer and keys.

  private place(e: MouseEvent): [number, number] {
    const r = this.canvas.getBoundingClientRect();
    return [e.clientX - r.left, e.clientY - r.top];
  }
  private wheel(e: WheelEvent): void {
    if (!this.d || (this.zoom === 1 && e.deltaY > 0)) return; // the page scrolls on
    e.preventDefault();
    this.zoomBy(2 ** (-Math.max(-240, Math.min(240, e.deltaY * (e.deltaMode === 1 ? 20 : 1))) / 240), this.place(e));
  }
  private down(e: PointerEvent): void {
    if (!this.d) return;
    const place = this.place(e);
    this.canvas.setPointerCapture(e.pointerId);
    this.pointers.set(e.pointerId, place);
    this.moved = 0;
    const near = e.pointerType === "mouse" ? 8 : 22;
    this.pull = this.drawing ? "region" : this.mode === "wipe" && Math.abs(place[0] - this.canvas.clientWidth * this.at) < near ? "wipe" : "view";
    if (this.pull === "region") this.dragging = this.boxOf(place, place);
    this.from = place;
  }
  private boxOf(a: [number, number], b: [number, number]): Drawn {
    const { width, height } = this.d!, clip = (v: number, most: number): number => Math.max(0, Math.min(most - 1, Math.floor(v)));
    const [p, q] = [this.filmAt(a), this.filmAt(b)].map(([x, y]) => [clip(x, width), height - 1 - clip(y, height)] as [number, number]);
    return [Math.min(p![0], q![0]), Math.min(p![1], q![1]), Math.max(p![0], q![0]), Math.max(p![1], q![1])];
  }
  private move(e: PointerEvent): void {
    if (!this.d) return;
    const place = this.place(e), before = this.pointers.get(e.pointerId);
    if (!before) return void this.read(this.pixelAt(place));
    const others = [...this.pointers].filter(([id]) => id !== e.pointerId).map(([, at]) => at);
    this.pointers.set(e.pointerId, place);
    this.moved += Math.hypot(place[0] - before[0], place[1] - before[1]);
    if (others.length > 0) {
      const far = (at: [number, number]): number => Math.hypot(at[0] - others[0]![0], at[1] - others[0]![1]);
      if (far(before) > 8) this.zoomBy(far(place) / far(before), [(place[0] + others[0]![0]) / 2, (place[1] + others[0]![1]) / 2]);
    } else if (this.pull === "wipe") {
      this.at = Math.max(0, Math.min(1, place[0] / this.canvas.clientWidth));
      this.wipe.value = String(Math.round(100 * this.at));
      this.draw();
    } else if (this.pull === "region") {
      this.dragging = this.boxOf(this.from, place);
      this.draw();
    } else if (this.zoom > 1) {
      const s = this.scale(this.panelAt(...place));
      this.centre = [this.centre[0] - (place[0] - before[0]) / s, this.centre[1] - (place[1] - before[1]) / s];
      this.keep();
    }
  }
  private up(e: PointerEvent): void {
    const alone = this.pointers.size === 1;
    if (!this.pointers.delete(e.pointerId) || !alone || !this.d) return;
    if (this.pull === "region" && this.dragging) {
      const box = this.dragging;
      this.dragging = undefined;
      if (box[2] - box[0] >= 2 && box[3] - box[1] >= 2) this.host.region?.(box);
      this.draw();
    } else if (this.moved < 5 && e.type === "pointerup") {
      const pixel = this.pixelAt(this.place(e));
      if (pixel) this.host.choose(pixel);
    }
    this.pull = undefined;
  }
  private key(e: KeyboardEvent): void {
    if (!this.d || e.ctrlKey || e.metaKey || e.altKey) return;
    const by = byKey(e);
    if (by) {
      const { width, height } = this.d, [i, j] = this.pixel ?? [width >> 1, height >> 1];
      const next: [number, number] = [Math.max(0, Math.min(width - 1, i + by[0])), Math.max(0, Math.min(height - 1, j + by[1]))];
      if (this.zoom > 1) this.centre = [next[0] + 0.5, height - 0.5 - next[1]];
      this.keep();
      this.host.choose(next);
      return;
    }
    const acts: Record<string, () => void> = {
      "+": () => this.zoomBy(2), "=": () => this.zoomBy(2), "-": () => this.zoomBy(1 / 2), "0": () => this.reset(),
      "[": () => this.slide(-0.05), "]": () => this.slide(0.05),
    };
    const act = acts[e.key];
    if (!act) return;
    e.preventDefault();
    act();
  }
  private slide(by: number): void {
    this.at = Math.max(0, Math.min(1, this.at + by));
    this.wipe.value = String(Math.round(100 * this.at));
    this.draw();
  }

  /** Selects a pixel, and shows its values. */
  select(pixel: [number, number] | undefined): void {
    const { width, height } = this.host.model.described;
    this.pixel = pixel && pixel[0] < width && pixel[1] < height ? pixel : undefined; // the address may be of a larger film
    this.draw();
    if (this.pixel) void this.read(this.pixel);
  }

  private async read(pixel: [number, number] | undefined): Promise<void> {
    const at = pixel ?? this.pixel, mine = ++this.asked, { era } = this;
    if (!at) return;
    const values = await this.host.model.values(() => mine === this.asked && era === this.era, ...at).catch(() => undefined);
    if (!values) return;
    const one = (words: string, value: string | undefined): string => (value === undefined ? "" : `, ${words} ${value.replace(/^-/, "−")}`);
    this.readout.replaceChildren(el("b", {}, `(${at.join(", ")}) ${values.shape || "nothing"}`), values.reference === undefined ? "" : `: reference Y ${values.reference} ${unit}`,
      ...values.films.filter(({ n }) => n > 0).map((film, k) => el("span", {}, el("b", {}, this.shown[k]?.name ?? ""), ` Y ${film.y} ± ${film.se}${one("error", film.error)}, N ${film.n}, weight 0 below the horizon ${film.zero} %, met a light ${film.met} %`)));
  }
}
