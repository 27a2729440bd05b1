// A picture that can be pointed at: a canvas of a size in pixels, boxes drawn over it, a pixel to choose by pointer, a
// region to draw by dragging. Boxes are [x0, y0, x1, y1], both ends inside, from the bottom-left.
import { el } from "./dom";

export type Drawn = [number, number, number, number];
export interface Picking {
  pixel?(i: number, j: number): void;
  region(box: Drawn): void;
}

export class Frame {
  readonly canvas: HTMLCanvasElement;
  readonly root: HTMLElement;
  private readonly over = el("div", { class: "over" });
  private from: [number, number] | undefined;

  constructor(private readonly size: { width: number; height: number }, private readonly picking: Picking) {
    this.canvas = el("canvas", { width: size.width, height: size.height, role: "img" });
    this.root = el("div", { class: "frame" }, this.canvas, this.over);
    this.canvas.addEventListener("pointerdown", (e) => { this.from = this.at(e); this.canvas.setPointerCapture(e.pointerId); });
    this.canvas.addEventListener("pointermove", (e) => this.drag(e));
    this.canvas.addEventListener("pointerup", (e) => this.drop(e));
    this.canvas.addEventListener("pointercancel", () => { this.from = undefined; });
  }

  /** Pixel (i, j) under the pointer. */
  private at(event: PointerEvent): [number, number] {
    const r = this.canvas.getBoundingClientRect(), { width, height } = this.size;
    const clip = (x: number, most: number): number => Math.max(0, Math.min(most - 1, Math.floor(x)));
    return [clip(((event.clientX - r.left) / r.width) * width, width), clip(((r.bottom - event.clientY) / r.height) * height, height)];
  }
  private dragged(event: PointerEvent): Drawn | undefined {
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
    else if (from) this.picking.pixel?.(...from);
  }

  private outline(box: readonly number[], css: string, name: string): HTMLElement {
    const [x0, y0, x1, y1] = box as Drawn, { width, height } = this.size;
    const made = el("div", { class: css }, name ? el("span", {}, name) : undefined);
    made.style.left = `${(100 * x0) / width}%`;
    made.style.width = `${(100 * (x1 - x0 + 1)) / width}%`;
    made.style.top = `${(100 * (height - 1 - y1)) / height}%`;
    made.style.height = `${(100 * (y1 - y0 + 1)) / height}%`;
    return made;
  }

  /** Boxes with their names, and a pixel where one is chosen. */
  outlines(boxes: readonly { name: string; box: readonly number[] }[], pixel?: [number, number]): void {
    const chosen = pixel ? [this.outline([...pixel, ...pixel], "pixel", "")] : [];
    this.over.replaceChildren(...boxes.map(({ name, box }) => this.outline(box, "region", name)), ...chosen);
  }
}
