// Find the fault: a prediction, the workshop with the sampler, hints in three steps. Solved when check finds nothing
// wrong; progress stays in the browser.
import { el, minus, plusMinus } from "./dom";
import { Exercise, exercises } from "./exercises";
import { Checked } from "./workshop";

interface Progress { state: "open" | "predicted" | "solved"; predicted: string; hints: number }
type Kept = Record<string, Progress>;

const key = "crescent.exercises", verdicts = ["valid", "support", "normalised", "density", "identity", "physics", "mean"];
const words = { open: "open", predicted: "in work", solved: "solved" };

function kept(): Kept {
  try {
    return JSON.parse(localStorage.getItem(key) ?? "{}") as Kept;
  } catch {
    return {}; // a browser that keeps nothing
  }
}
function keep(all: Kept): void {
  try {
    localStorage.setItem(key, JSON.stringify(all));
  } catch { /* it lasts as long as the page */ }
}

/** The exercises for teachers: what the check says of each before and after its repair, measured now. */
export function faultSheet(check: (code: string, ground: string) => Promise<Checked>): HTMLElement {
  const rows = exercises.map((exercise) => ({ exercise, before: el("td", {}, "being checked …"), after: el("td") }));
  const first = ({ state, verdicts: all }: Checked): string => {
    const found = all.find((v) => v.state === "wrong" || v.state === "error") ?? all.find((v) => v.state === "inconclusive");
    return found ? `${found.name} ${found.state}: ${minus(plusMinus(found.message))}` : state;
  };
  const root = el("div", { id: "fault-sheet" }, el("h2", {}, "Find the fault"),
    el("p", {}, `${exercises.length} exercises of ${exercises.reduce((sum, { minutes }) => sum + minutes, 0)} minutes in all. Let the class predict before it looks.`),
    el("table", {}, el("thead", {}, el("tr", {}, ...["exercise", "minutes", "what the check says", "fault and repair", "then"].map((words) => el("th", { scope: "col" }, words)))),
      el("tbody", {}, ...rows.map(({ exercise, before, after }) => el("tr", {}, el("th", { scope: "row" }, exercise.title), el("td", {}, String(exercise.minutes)), before,
        el("td", {}, ...(exercise.repair ? [el("code", {}, exercise.repair[0].split("\n")[0]), " → ", el("code", {}, exercise.repair[1].split("\n")[0]), ". "] : []), exercise.hints[2]), after)))));
  void (async (): Promise<void> => {
    await Promise.resolve(); // it is on the page then
    for (const { exercise: { code, ground, repair }, before, after } of rows) {
      if (!root.isConnected) return;
      try {
        before.textContent = first(await check(code, ground));
        after.textContent = repair ? first(await check(code.replace(repair[0], () => repair[1]), ground)) : "no fault";
      } catch (error) {
        before.textContent = `It could not be checked: ${error instanceof Error ? error.message : error}.`;
      }
    }
    root.dataset["measured"] = "all";
  })();
  return root;
}

export class Faults {
  private all = kept();
  private result: HTMLElement | undefined;
  private current: Exercise | undefined;
  constructor(private readonly go: (name: string) => void, private readonly begin: (exercise: Exercise) => void) {}

  private of(name: string): Progress {
    const { state, predicted, hints } = this.all[name] ?? {};
    return { state: state === "solved" || state === "predicted" ? state : "open", predicted: typeof predicted === "string" ? predicted : "", hints: Number(hints) || 0 };
  }
  private set(name: string, change: Partial<Progress>): void {
    this.all[name] = { ...this.of(name), ...change };
    keep(this.all);
    for (const item of document.querySelectorAll<HTMLElement>(`[data-exercise="${name}"]`)) item.dataset["state"] = this.of(name).state;
  }

  list(root: HTMLElement): void {
    const solved = exercises.filter(({ name }) => this.of(name).state === "solved").length;
    root.replaceChildren(el("h2", {}, "Find the fault"),
      el("p", {}, `Twelve samplers, from real bug reports. Predict which verdict fails, look, then repair: an exercise is solved when the check finds nothing wrong. One of them has no fault. ${solved} of ${exercises.length} solved; progress stays in this browser.`),
      el("ol", { class: "cards" }, ...exercises.map((e) => {
        const { state } = this.of(e.name);
        return el("li", { "data-exercise": e.name, "data-state": state },
          el("a", { href: `#exercise=${e.name}`, onclick: (event) => { event.preventDefault(); this.go(e.name); } }, e.title), el("small", {}, `${e.minutes} minutes, ${words[state]}`));
      })));
  }

  /** The text of an exercise; its sampler is shown once a verdict was predicted. */
  show(root: HTMLElement, exercise: Exercise): void {
    this.current = exercise;
    const { name } = exercise, next = exercises[exercises.indexOf(exercise) + 1], hints = el("ol", { class: "hints" }), predicted = el("p", { class: "predicted" });
    const options: [string, string][] = [...verdicts.map((v): [string, string] => [v, v]), ["none", "none: there is no fault"]];
    const hint = el("button", { type: "button", id: "hint", onclick: () => { this.set(name, { hints: Math.min(3, this.of(name).hints + 1) }); tell(); } });
    const tell = (): void => {
      const { hints: count } = this.of(name);
      hints.replaceChildren(...exercise.hints.slice(0, count).map((line) => el("li", {}, line)));
      hint.hidden = count >= 3;
      hint.textContent = count === 0 ? "A hint" : "Another hint";
    };
    const inputs = options.map(([value]) => el("input", { type: "radio", name: "predicted", id: `predicted-${value}`, value }));
    const form = el("form", { onsubmit: (event) => {
      event.preventDefault();
      const chosen = inputs.find((input) => input.checked)?.value;
      if (chosen) (this.set(name, { predicted: chosen, state: this.of(name).state === "solved" ? "solved" : "predicted" }), start());
    } }, el("fieldset", {}, el("legend", {}, "Which verdict will fail first?"), ...options.map(([, label], k) => el("div", { class: "option" }, inputs[k], el("label", { for: inputs[k]!.id }, label)))),
      el("button", { type: "submit", class: "main", id: "predict" }, "Show the sampler"));
    this.result = el("p", { id: "exercise-result", "aria-live": "polite" });
    const none = el("button", { type: "button", id: "no-fault", onclick: () => this.answerNone() }, "There is no fault");
    const start = (): void => {
      form.hidden = true;
      predicted.textContent = `Predicted: ${options.find(([value]) => value === this.of(name).predicted)?.[1] ?? "nothing"}.`;
      work.hidden = false;
      this.begin(exercise);
    };
    const work = el("div", { hidden: true }, hints, el("p", { class: "row-wrap" }, hint, none,
      el("button", { type: "button", id: "again", onclick: () => this.begin(exercise) }, "As it was"),
      ...(next ? [el("button", { type: "button", id: "next-exercise", onclick: () => this.go(next.name) }, `Next: ${next.title}`)] : [])));
    tell();
    root.replaceChildren(
      el("p", {}, el("a", { href: "#part=faults", onclick: (event) => { event.preventDefault(); this.go(""); } }, "All exercises")),
      el("div", { class: "asking", "data-exercise": name, "data-state": this.of(name).state }, el("h2", {}, exercise.title), el("p", {}, exercise.task), form, predicted, work, this.result));
    if (this.of(name).predicted) start();
  }

  private last: Checked | undefined;
  private answerNone(): void {
    const { current } = this;
    if (!current) return;
    const wrong = this.last?.verdicts.find(({ state }) => state === "wrong" || state === "error");
    if (!this.last) this.tell("Check it first.");
    else if (wrong) this.tell(`The check disagrees: ${wrong.name} is ${wrong.state}.`);
    else if (current.repair && this.all[current.name]?.state !== "solved") this.tell("Check the sampler as it was.");
    else (this.set(current.name, { state: "solved" }), this.tell("Solved: no verdict is wrong. What stays open is the tail, and a heavy tail is no fault of the code."));
  }
  private tell(line: string): void { if (this.result) this.result.textContent = line; }

  /** Another sampler is shown. */
  forget(): void { this.last = undefined; this.tell(""); }

  checked(result: Checked): void {
    const { current } = this;
    this.last = result;
    if (!current || !this.result?.isConnected) return;
    const { predicted, state } = this.of(current.name), wrong = result.verdicts.find((v) => v.state === "wrong" || v.state === "error");
    if (!current.repair) return this.tell(wrong ? `${wrong.name} is ${wrong.state}.` : "No verdict is wrong. Is there a fault?");
    if (wrong) return this.tell(`The first wrong verdict is ${wrong.name}; you predicted ${predicted}.`);
    const open = result.verdicts.find((v) => v.state === "inconclusive");
    if (open) return this.tell(`Nothing is wrong, but ${open.name} is inconclusive: the exercise is solved by a sampler that is right.`);
    if (state !== "solved") this.set(current.name, { state: "solved" });
    this.tell("Solved: the check finds nothing wrong any more.");
  }
}
