// The hemisphere of a pixel: f L cos and the density as two disks, the pixel's draws as points, the light's edge, the
// running mean, the factors of the largest sample.
import { choice } from "./controls";
import { EngineError } from "./api";
import { el, made } from "./dom";
import { Model } from "./model";
import { State } from "./state";

interface Opened {
  shape?: string; mirror: [number, number]; draws: [number, number, number, number][]; under: number;
  lights: { name: string; rim: [number, number][]; angle: number }[]; mean: string; reference?: string; chart: string;
  largest?: Record<string, string>;
}

const size = 288;
const ground = "#141517", light = "#ffffff", point = "#ffffff";

const disk = (label: string): HTMLCanvasElement => el("canvas", { width: size, height: size, class: "disk", role: "img", "aria-label": label });

const onDisk = (x: number, y: number): [number, number] => [(size * (1 + x)) / 2, (size * (1 - y)) / 2];

/** The light's edge, n and R. */
function marks(pen: CanvasRenderingContext2D, pixel: Opened): void {
  pen.lineWidth = 1.5;
  pen.strokeStyle = light;
  for (const { rim } of pixel.lights) {
    pen.beginPath();
    rim.forEach(([x, y], k) => (k === 0 ? pen.moveTo(...onDisk(x, y)) : pen.lineTo(...onDisk(x, y))));
    pen.closePath();
    pen.stroke();
  }
  pen.font = "600 13px Inter, sans-serif";
  for (const [name, at] of [["n", [0, 0]], ["R", pixel.mirror]] as [string, [number, number]][]) {
    const [x, y] = onDisk(...at);
    pen.lineWidth = 3;
    pen.strokeStyle = ground;
    pen.strokeText(name, x + 5, y - 5);
    pen.fillStyle = light;
    pen.fillText(name, x + 5, y - 5);
    pen.fillRect(x - 1.5, y - 1.5, 3, 3);
  }
}

/** The draws: area by weight, those that met a light square, so that it is visible without colour. */
function points(pen: CanvasRenderingContext2D, pixel: Opened): void {
  for (const [x, y, side, met] of pixel.draws) {
    if (met === -2) continue;
    const [a, b] = onDisk(x, y), r = 1.5 + 7 * side;
    pen.beginPath();
    if (met >= 0) pen.rect(a - r, b - r, 2 * r, 2 * r);
    else pen.arc(a, b, r, 0, 2 * Math.PI);
    pen.fillStyle = met >= 0 ? "rgb(255 255 255 / 0.75)" : "rgb(255 255 255 / 0.25)";
    pen.fill();
    pen.lineWidth = 1;
    pen.strokeStyle = met >= 0 ? ground : point;
    pen.stroke();
  }
}

function largestTable(parts: Record<string, string>): HTMLElement {
  const rows: [string, string][] = [["largest X", parts["x"]!], ["f, 1/sr", parts["f"]!], [`L (${parts["met"]})`, parts["light"]!],
    ["cos θ", parts["cos"]!], ["1/p, sr", parts["over_p"]!], ["θ from n", `${parts["angle"]}°`]];
  if (parts["weight"]) rows.push(["MIS weight", parts["weight"]]);
  return el("table", {}, el("tbody", {}, ...rows.map(([name, value]) =>
    el("tr", {}, el("th", { scope: "row" }, name), el("td", { class: "n" }, value)))));
}

/** Fills `root` with pixel (i, j) under an arm, if it is still wanted; show(): called once its text is there. Throws
 *  EngineError. */
async function showPixel(root: HTMLElement, model: Model, i: number, j: number, arm: number, name: string, n: number, wanted: () => boolean, show: () => void): Promise<void> {
  const pixel = await model.parts<Opened>(wanted, "pixel", { i, j, arm: name, n, css: `c${arm % 6}`, reference: model.referenceDone });
  if (!pixel) return;
  if (!pixel.shape) {
    root.replaceChildren(el("p", {}, `Pixel (${i}, ${j}) sees nothing: there is no hemisphere over it.`));
    return show();
  }
  const integrand = disk(`f L cos over the hemisphere of pixel ${i}, ${j}, with the light's edge`);
  const density = disk(`the density of ${name} over the same hemisphere with its ${pixel.draws.length} draws`);
  const under = pixel.under > 0 ? ` ${pixel.under} of them fell under the horizon and weigh 0.` : "";
  root.replaceChildren(
    el("p", {}, el("b", {}, `Pixel (${i}, ${j}), ${pixel.shape}. `), `After ${n} samples ${name} reads `, el("b", { class: "v" }, pixel.mean),
      ...(pixel.reference === undefined ? ["; the reference is being computed"] : [", the reference ", el("b", { class: "v" }, pixel.reference)]), `.${under}`),
    el("div", { class: "disks" },
      el("figure", {}, integrand, el("figcaption", {}, el("b", {}, "f L cos θ"), `, four decades${pixel.lights.some(({ rim }) => rim.length > 0) ? "; the ring is the light's edge" : ""}`)),
      el("figure", {}, density, el("figcaption", {}, el("b", {}, `p of ${name}`), " with its draws, made of the same random numbers for every arm: area is weight, squares met a light")),
      el("figure", {}, made(pixel.chart), el("figcaption", {}, pixel.reference === undefined ? "The mean so far." : "The mean so far, and the reference.")),
      pixel.largest ? el("figure", {}, largestTable(pixel.largest), el("figcaption", {}, "The largest sample: X = f L cos θ / p.")) : undefined));
  show();
  for (const [canvas, what] of [[integrand, "f L cos"], [density, "pdf"]] as const) {
    const painted = await model.disk(wanted, "hemisphere", { i, j, arm: name, what }, size);
    if (!painted) return;
    const pen = canvas.getContext("2d")!;
    pen.putImageData(painted, 0, 0);
    if (canvas === density) points(pen, pixel);
    marks(pen, pixel);
  }
}

function pixelFailed(root: HTMLElement, error: unknown): void {
  const words = error instanceof EngineError ? error.message : String(error);
  root.replaceChildren(el("p", { class: "bad" }, `This pixel cannot be opened: ${words}.`));
}

/** The pixel of the state in `root`, with the choice of the arm whose draws are shown; latest(): no other was opened
 *  since; again(): another arm was chosen. */
export async function openPixel(root: HTMLElement, model: Model, state: State, latest: () => boolean, again: () => void): Promise<void> {
  const { pixel } = state, { described: d } = model;
  if (!pixel) return;
  const [i, j] = [Math.min(pixel[0], d.width - 1), Math.min(pixel[1], d.height - 1)];
  const single = (name: string): boolean => d.arms.some((arm) => arm.name === name && arm.sampler !== "");
  const inside = el("div"), arms = state.arms.map((arm, k): [string, string] => [String(k), arm]).filter(([, arm]) => single(arm));
  if (arms.length === 0) return root.replaceChildren(el("p", {}, "No arm here is a sampler of its own: choose one to see its draws."));
  if (!single(state.arms[state.arm] ?? "")) state.arm = Number(arms[0]![0]);
  const whose = choice("whose", "draws of", arms, String(state.arm), (value) => { state.arm = Number(value); again(); });
  const s = model.shown[state.arm] ?? model.shown[0]!;
  const show = (): void => { // the old contents stay until this one has its text
    if (inside.isConnected) return;
    const held = document.activeElement?.id === "whose";
    root.replaceChildren(whose, inside);
    if (held) whose.querySelector("select")!.focus();
  };
  try {
    await showPixel(inside, model, i, j, s.arm, s.name, state.n, () => latest() && d === model.described, show);
  } catch (error) { pixelFailed(inside, error); show(); }
}
