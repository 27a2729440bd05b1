// The choices of the page: experiment, arms, N, which pictures. A lesson shows only those that it uses.
import { choice } from "./controls";
import { byId } from "./dom";
import { ladder } from "./model";
import { fresh, Source, State } from "./state";

export interface Choosing {
  state: State;
  sources: Record<string, Source>;
  samplers: readonly { name: string; label: string }[];
  only: readonly string[] | undefined; // of a lesson
  open(): void; // with the choices
  show(): void; // the same films in another view
}

function armChoice(k: number, { state, sources, samplers, open }: Choosing): HTMLElement {
  const labels = new Map(samplers.map((s) => [s.name, s.label]));
  const known = [...new Set([...Object.keys(sources[state.experiment]!.arms), ...labels.keys()])];
  const options = known.map((name): [string, string] => [name, labels.get(name) ?? name]);
  return choice(`arm-${k}`, `arm ${k + 1}`, [...(k > 0 ? [["", "none"] as [string, string]] : []), ...options], state.arms[k] ?? "", (value) => {
    const all = [0, 1, 2].map((at) => (at === k ? value : state.arms[at] ?? ""));
    state.arms = [...new Set(all.filter((arm) => arm !== ""))];
    state.arm = Math.min(state.arm, state.arms.length - 1);
    open();
  });
}

/** Creates the choices again; the focused one keeps the focus. */
export function showChoices(root: HTMLElement, given: Choosing): void {
  const { state, sources, only } = given, held = document.activeElement?.id;
  const all: [string, () => HTMLElement][] = [
    ["experiment", () => choice("experiment", "experiment", Object.entries(sources).map(([name, s]) => [name, s.title]), state.experiment, (value) => {
      Object.assign(state, fresh(value, sources[value]!), { answers: state.answers, lesson: state.lesson, part: state.part });
      given.open();
    })],
    ...[0, 1, 2].map((k): [string, () => HTMLElement] => ["arms", () => armChoice(k, given)]),
    ["n", () => choice("n", "samples a pixel, up to", ladder.map((n) => [String(n), String(n)]), String(state.n), (value) => { state.n = Number(value); given.open(); })],
    ["view", () => choice("view", "pictures show", [["photograph", "photographs"], ["heat", "|Y − Y_ref|, one scale"], ["signed", "the nearer of two"]], state.view,
      (value) => { state.view = value as State["view"]; given.show(); })],
  ];
  root.replaceChildren(...all.filter(([name]) => !only || only.includes(name)).map(([, make]) => make()));
  if (held) byId(held)?.focus();
}
