// `check` on the page: a sampler at one w_o, its verdicts in a table; and samplers shown by their draws over the density
// that they claim.
import { Asker } from "./answers";
import { choice } from "./controls";
import { el } from "./dom";
import { Lesson } from "./lessons";
import { Model } from "./model";

interface Verdict { name: string; state: string; say: string; why?: string }
interface Judged { name: string; state: string; cases: { trial: string; verdicts: Verdict[] }[] }
interface Option { value: string; words: string }

const size = 176, draws = 512;

function table(one: Judged["cases"][number]): HTMLElement {
  const rows = one.verdicts.map((v) => el("tr", {}, el("th", { scope: "row" }, v.name),
    el("td", { class: v.state === "wrong" ? "bad" : "" }, v.state), el("td", {}, v.say)));
  return el("table", { class: "verdicts" }, el("caption", {}, one.trial), el("tbody", {}, ...rows));
}

/** A sampler and a w_o to choose, and what `check` says of them. */
export function checkPanel(asker: Asker, lesson: Lesson): HTMLElement {
  const { samplers, theta } = lesson.check!, answer = lesson.answer as { samplers: readonly string[]; theta: number };
  let sampler = answer.samplers[0]!, at = answer.theta, asked = 0;
  const out = el("div", { id: "judged", "aria-live": "polite" });
  const judge = async (): Promise<void> => {
    const mine = ++asked;
    out.replaceChildren(el("p", {}, "Being judged …"));
    try {
      const judged = await asker.judged<Judged>(sampler, at);
      if (mine !== asked) return;
      // A planted fault has a name of several words; the program judges it at three w_o in one call.
      const how = sampler.includes(" ") ? ["; the program judges such faults by ", "crescent check --planted"] : [", as from ", `crescent check ${sampler} --wo ${at}`];
      out.replaceChildren(el("p", {}, el("b", {}, judged.state), how[0], el("code", {}, how[1])), ...judged.cases.map(table));
    } catch (error) {
      out.replaceChildren(el("p", { class: "bad" }, `It could not be judged: ${error instanceof Error ? error.message : error}.`));
    }
  };
  return el("section", { "aria-label": "Check a sampler" }, el("p", {}, "Now play: choose a sampler and the angle of w_o to the normal, and check it."),
    el("div", { class: "choices" },
      choice("check-sampler", "sampler", samplers.map(({ value, words }) => [value, words]), sampler, (value) => { sampler = value; }),
      choice("check-theta", "w_o, degrees from the normal", theta.map((t) => [String(t), String(t)]), String(at), (value) => { at = Number(value); }),
      el("button", { type: "button", id: "check", onclick: () => void judge() }, "Check")), out);
}

function picture(model: Model, { value, words }: Option, theta: number): HTMLElement {
  const { draws: points, trial } = model.door.ask<{ draws: [number, number][]; trial: string }>("drawn", { sampler: value, theta, n: draws });
  const canvas = el("canvas", { width: size, height: size, class: "disk", role: "img", "aria-label": `${words}: ${points.length} draws over the density that it claims, ${trial}` });
  const pen = canvas.getContext("2d")!;
  pen.putImageData(new ImageData(new Uint8ClampedArray(model.door.bytesAbout("density_disk", value, 4 * size * size, theta, size)), size, size), 0, 0);
  pen.fillStyle = "#ffffff";
  pen.strokeStyle = "#141517";
  for (const [x, y] of points) {
    pen.beginPath();
    pen.arc((size * (1 + x)) / 2, (size * (1 - y)) / 2, 1.6, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
  }
  return el("figure", {}, canvas, el("figcaption", {}, el("b", {}, words)));
}

/** Each sampler's draws as points over its density, four decades of it. */
export function samplerPictures(model: Model, samplers: readonly Option[], theta: number): HTMLElement {
  return el("div", { class: "disks six" }, ...samplers.map((option) => picture(model, option, theta)));
}
