// A question that is answered by a box: drawn on the reference's picture, or entered as corners.
import { Asker } from "./answers";
import { el } from "./dom";
import { Drawn, Frame } from "./frame";

/** The field in the question, and its value: "x0,y0,x1,y1", or "" if it is not a box of the picture. */
export function boxQuestion(asker: Asker, given: string | undefined): { inside: HTMLElement[]; read(): string } {
  const [width, height] = asker.size, ends = ["left", "bottom", "right", "top"], most = [width, height, width, height];
  const fields = ends.map((end, k) => el("input", {
    type: "number", id: k === 0 ? "guess" : `guess-${end}`, min: 0, max: most[k]! - 1, class: "number", value: given?.split(",")[k] ?? "",
    "aria-label": `your box, ${end}, pixels`, oninput: () => outline(),
  }));
  const box = (): Drawn | undefined => {
    const all = fields.map((field, k) => (/^\d+$/.test(field.value) ? Number(field.value) : NaN) < most[k]! ? Number(field.value) : NaN);
    return all[0]! < all[2]! && all[1]! < all[3]! ? (all as Drawn) : undefined;
  };
  const taken = (drawn: Drawn): void => { fields.forEach((field, k) => { field.value = String(drawn[k]); }); outline(); };
  const frame = new Frame({ width, height }, { region: taken });
  const outline = (): void => { const drawn = box(); frame.outlines([...asker.regions, ...(drawn ? [{ name: "your box", box: drawn, move: taken, reached: true }] : [])]); };
  outline();
  frame.canvas.setAttribute("aria-label", "the reference: what all arms would show without noise");
  const pen = frame.canvas.getContext("2d")!;
  asker.photograph((at, bytes) => pen.putImageData(new ImageData(new Uint8ClampedArray(bytes), at.x1 - at.x0, at.y1 - at.y0), at.x0, height - at.y1));
  return {
    inside: [frame.root, el("p", { class: "footnote" }, "Drag a box on the picture, then its corners, also by the arrow keys; or type them: left, bottom, right, top, in pixels from the bottom-left."),
      el("div", { class: "row four" }, ...fields)],
    read: () => box()?.join(",") ?? "",
  };
}
