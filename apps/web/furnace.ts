// Furnaces with changeable exponents and numbers of samples, recomputed.
import { Asker } from "./answers";
import { choice } from "./controls";
import { el, minus } from "./dom";
import { Lesson } from "./lessons";

/** An s and an N to choose, and the result of each furnace for them. */
export function furnacePanel(asker: Asker, lesson: Lesson): HTMLElement {
  const { s: sharpness, n: numbers } = lesson.furnace!, answer = lesson.answer as { n: number };
  let s = lesson.furnace!.own, n = answer.n, asked = 0;
  const out = el("div", { id: "read", "aria-live": "polite" });
  const read = async (): Promise<void> => {
    const mine = ++asked;
    out.replaceChildren(el("p", {}, "Being read …"));
    try {
      const found = await asker.furnaces(lesson, s, n);
      if (mine === asked) out.replaceChildren(el("p", {}, `s = ${s}, N = ${n}: `, el("b", {}, words(found.answer))), el("ul", {}, ...found.lines.map((line) => el("li", {}, minus(line)))));
    } catch (error) {
      out.replaceChildren(el("p", { class: "bad" }, `They could not be read: ${error instanceof Error ? error.message : error}.`));
    }
  };
  const words = (value: string): string => (lesson.ask.kind === "choice" ? lesson.ask.options.find((o) => o.value === value)?.words : undefined) ?? value;
  const all = (numbers: readonly number[], own: number): [string, string][] => [...new Set([...numbers, own])].sort((a, b) => a - b).map((x) => [String(x), String(x)]);
  return el("section", { "aria-label": "Read the furnaces" }, el("p", {}, "Now play: choose the sphere's exponent and the number of samples, and read the furnaces again."),
    el("div", { class: "choices" },
      choice("furnace-s", "s of sphere", all(sharpness, s), String(s), (value) => { s = Number(value); }),
      choice("furnace-n", "samples", all(numbers, n), String(n), (value) => { n = Number(value); }),
      el("button", { type: "button", id: "read-again", onclick: () => void read() }, "Read")), out);
}
