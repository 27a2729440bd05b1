// `check` on the page: a sampler at one w_o, its verdicts in a table; and samplers shown by their draws over their
// stated density.
import { Asker, evaluations } from "./answers";
import { choice } from "./controls";
import { el, minus } from "./dom";
import { Lesson } from "./lessons";
import { Model } from "./model";

interface Verdict { name: string; state: string; message: string; why?: string }
interface Checked { name: string; state: string; cases: { case: string; verdicts: Verdict[] }[] }
interface Option { value: string; words: string }

const size = 176, draws = 512;

function table(one: Checked["cases"][number]): HTMLElement {
  const rows = one.verdicts.map((v) => el("tr", {}, el("th", { scope: "row" }, v.name),
    el("td", { class: v.state === "wrong" ? "bad" : "" }, v.state), el("td", {}, minus(v.message))));
  return el("table", { class: "verdicts" }, el("caption", {}, one.case), el("tbody", {}, ...rows));
}

/** A sampler and a w_o to choose, and the verdicts of `check` on them. */
export function checkPanel(asker: Asker, lesson: Lesson): HTMLElement {
  const { samplers, theta } = lesson.check!, answer = lesson.answer as { samplers: readonly string[]; theta: number };
  let sampler = answer.samplers[0]!, at = answer.theta, asked = 0;
  const out = el("div", { id: "check-result", "aria-live": "polite" });
  const check = async (): Promise<void> => {
    const mine = ++asked;
    out.replaceChildren(el("p", {}, "Checking …"));
    try {
      const checked = await asker.checked<Checked>(sampler, at);
      if (mine !== asked) return;
      // A planted fault has a name of several words; the program checks it at three w_o in one call.
      const how = sampler.includes(" ") ? ["; the program checks such faults by ", "crescent check --planted"] : [`, from ${evaluations} evaluations a surface; the program makes five times as many: `, `crescent check ${sampler} --wo ${at}`];
      out.replaceChildren(el("p", {}, el("b", {}, checked.state), how[0], el("code", {}, how[1])), ...checked.cases.map(table));
    } catch (error) {
      out.replaceChildren(el("p", { class: "bad" }, `It could not be checked: ${error instanceof Error ? error.message : error}.`));
    }
  };
  return el("section", { "aria-label": "Check a sampler" }, el("p", {}, "Now play: choose a sampler and the angle of w_o to the normal, and check it."),
    el("div", { class: "choices" },
      choice("check-sampler", "sampler", samplers.map(({ value, words }) => [value, words]), sampler, (value) => { sampler = value; }),
      choice("check-theta", "w_o, degrees from the normal", theta.map((t) => [String(t), String(t)]), String(at), (value) => { at = Number(value); }),
      el("button", { type: "button", id: "check", onclick: () => void check() }, "Check")), out);
}

/** Paints a sampler's density and its draws when there is room for it; skipped if it is no longer on the page. */
export async function paintDraws(model: Model, canvas: HTMLCanvasElement, { value, words }: Option, theta: number): Promise<void> {
  const wanted = (): boolean => canvas.isConnected;
  if (!wanted()) return;
  const { bytes } = await model.filmWorker.request({ kind: "disk", call: "density_disk", request: { sampler: value, theta, size }, size });
  const drawn = (await model.filmWorker.request({ kind: "json", call: "drawn", request: { sampler: value, theta, n: draws } })).response as { draws: [number, number][]; case: string };
  if (!wanted()) return;
  const density = new ImageData(new Uint8ClampedArray(bytes![0]!), size, size);
  canvas.setAttribute("aria-label", `${words}: ${drawn.draws.length} draws over the density that it claims, ${drawn.case}`);
  const pen = canvas.getContext("2d")!;
  pen.putImageData(density, 0, 0);
  pen.fillStyle = "#ffffff";
  pen.strokeStyle = "#141517";
  for (const [x, y] of drawn.draws) {
    pen.beginPath();
    pen.arc((size * (1 + x)) / 2, (size * (1 - y)) / 2, 1.6, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
  }
}

function picture(model: Model, option: Option, theta: number): HTMLElement {
  const canvas = el("canvas", { width: size, height: size, class: "disk", role: "img", "aria-label": `${option.words}: its draws` });
  void Promise.resolve().then(() => paintDraws(model, canvas, option, theta)).catch(() => {}); // once it is on the page; the question works without it
  return el("figure", {}, canvas, el("figcaption", {}, el("b", {}, option.words)));
}

/** Each sampler's draws as points over its density, four decades of it. */
export function samplerPictures(model: Model, samplers: readonly Option[], theta: number): HTMLElement {
  return el("div", { class: "disks six" }, ...samplers.map((option) => picture(model, option, theta)));
}
