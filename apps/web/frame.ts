// A picture with pointer input: a canvas of a size in pixels, boxes drawn over it, a pixel to choose by pointer, a
// region to draw by dragging. Boxes are [x0, y0, x1, y1], both ends inclusive, from the bottom-left.
import { el } from "./dom";

export type Drawn = [number, number, number, number];
/** A box with its name. move: its corners can be moved, the new box is passed on; reached: also by the tab key. */
export interface Outlined { name: string; box: readonly number[]; move?: ((box: Drawn) => void) | undefined; reached?: boolean | undefined }
export interface Picking {
  pixel?(i: number, j: number): void;
  region(box: Drawn): void;
}

/** The step of an arrow key, in pixels: one, ten with shift. Other keys are ignored. */
export function byKey(event: KeyboardEvent): [number, number] | undefined {
  const step = event.shiftKey ? 10 : 1;
  const by: Record<string, [number, number]> = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
  if (by[event.key]) event.preventDefault();
  return by[event.key];
}

export class Frame {
  readonly canvas: HTMLCanvasElement;
  readonly root: HTMLElement;
  private readonly over = el("div", { class: "over" });
  private from: [number, number] | undefined;
  private last: readonly Outlined[] = [];
  private chosen: [number, number] | undefined;

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

  /** One corner of a box as a button outside it; x is box[kx], y is box[ky]. It stops one pixel before the opposite
   *  corner. */
  private corner(of: Outlined, kx: 0 | 2, ky: 1 | 3): HTMLElement {
    const box = of.box as Drawn, { width, height } = this.size;
    const to = (x: number, y: number): Drawn => {
      const next: Drawn = [...box];
      next[kx] = kx === 0 ? Math.max(0, Math.min(x, box[2] - 1)) : Math.min(width - 1, Math.max(x, box[0] + 1));
      next[ky] = ky === 1 ? Math.max(0, Math.min(y, box[3] - 1)) : Math.min(height - 1, Math.max(y, box[1] + 1));
      return next;
    };
    const take = (next: Drawn): void => {
      if (next.join() === box.join()) return;
      this.outlines(this.last.map((o) => (o === of ? { ...o, box: next } : o)), this.chosen);
      of.move!(next);
    };
    const made = el("button", {
      type: "button", class: "corner", "data-corner": `${of.name} ${kx} ${ky}`, tabindex: of.reached ? 0 : -1,
      "aria-label": `${of.name}, ${ky === 1 ? "bottom" : "top"} ${kx === 0 ? "left" : "right"} corner at ${box[kx]}, ${box[ky]}. Arrow keys move it.`,
    });
    let grip: [number, number] | undefined; // from the pointer to the corner
    const pulled = (e: PointerEvent): Drawn => to(this.at(e)[0] + grip![0], this.at(e)[1] + grip![1]);
    made.onkeydown = (event): void => {
      const by = byKey(event);
      if (by) take(to(box[kx] + by[0], box[ky] + by[1]));
    };
    made.onpointerdown = (e): void => {
      grip = [box[kx] - this.at(e)[0], box[ky] - this.at(e)[1]];
      made.setPointerCapture(e.pointerId);
    };
    made.onpointermove = (e): void => {
      if (!grip) return;
      this.over.querySelector(".dragging")?.remove();
      this.over.append(this.outline(pulled(e), "dragging", ""));
    };
    made.onpointercancel = (): void => { grip = undefined; };
    made.onpointerup = (e): void => {
      this.over.querySelector(".dragging")?.remove();
      if (grip) take(pulled(e));
    };
    const x = `${(100 * (kx === 0 ? box[0] : box[2] + 1)) / width}%`, y = `${(100 * (height - (ky === 1 ? box[1] : box[3] + 1))) / height}%`;
    const within = (before: boolean, at: string): string => // inside the picture, and next to the corner at any zoom
      before ? `clamp(0px, calc(${at} - 24px), calc(100% - 48px))` : `clamp(24px, ${at}, calc(100% - 24px))`;
    made.style.left = within(kx === 0, x);
    made.style.top = within(ky === 3, y);
    return made;
  }

  /** Boxes with their names, and a pixel if one is selected. A focused corner keeps the focus. */
  outlines(boxes: readonly Outlined[], pixel?: [number, number]): void {
    const held = this.over.contains(document.activeElement) ? (document.activeElement as HTMLElement).dataset["corner"] : undefined;
    this.last = boxes;
    this.chosen = pixel;
    const chosen = pixel ? [this.outline([...pixel, ...pixel], "pixel", "")] : [];
    const ends: [0 | 2, 1 | 3][] = [[0, 1], [2, 1], [0, 3], [2, 3]];
    const corners = boxes.filter(({ move }) => move).flatMap((of) => ends.map(([kx, ky]) => this.corner(of, kx, ky)));
    this.over.replaceChildren(...boxes.map(({ name, box, move }) => this.outline(box, move ? "region own" : "region", name)), ...chosen, ...corners);
    if (held) this.over.querySelector<HTMLElement>(`[data-corner="${held}"]`)?.focus();
  }
}
