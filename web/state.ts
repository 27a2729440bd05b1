// What the address says, and the command line that makes the same numbers. The address is data: what is wrong in it
// gives its default, and a line that says so.
import { ladder, Region } from "./model";

export interface Source { file: string; title: string; text: string; published: string; arms: Record<string, number[]>; regions: Region[]; quadrature: boolean }

export interface State {
  experiment: string;
  arms: string[];
  n: number;
  view: "photograph" | "heat" | "signed";
  set: Record<string, string>; // path -> value, as --set takes it
  pixel: [number, number] | undefined;
  arm: number; // whose draws the hemisphere shows
  lesson: string;
  answers: Record<string, string>; // lesson -> answer
}

const path = /^(?!__)[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+){0,3}$/;
const number = "-?(\\d+\\.?\\d*|\\.\\d+)([eE][-+]?\\d{1,3})?";
const value = new RegExp(`^(${number}|\\[ *${number}( *, *${number}){0,7} *\\]|"[a-z-]{1,40}")$`);

export function fresh(experiment: string, source: Source): State {
  const arms = Object.keys(source.arms).slice(0, 3), rungs = source.arms[arms[0]!]!;
  return {
    experiment, arms, n: Math.max(...ladder.filter((n) => n <= Math.max(...rungs))), view: "photograph", set: {}, pixel: undefined, arm: 0, lesson: "",
    answers: {},
  };
}

/** Reads an address; `said` receives a line for everything that was not understood. */
export function read(hash: string, sources: Record<string, Source>, samplers: string[], said: string[]): State {
  const asked = new URLSearchParams(hash.replace(/^#/, ""));
  const first = Object.keys(sources)[0]!;
  const wrong = (key: string, instead: string): void => {
    said.push(`The address says ${key}=${(asked.get(key) ?? "").slice(0, 60)}, which is none here: ${instead}.`);
  };
  let experiment = asked.get("experiment") ?? first;
  if (!Object.hasOwn(sources, experiment)) wrong("experiment", `${first} is open`), (experiment = first);
  const state = fresh(experiment, sources[experiment]!);
  const arms = asked.get("arms")?.split(",");
  if (arms) {
    const known = [...new Set(arms)].filter((a) => samplers.includes(a) || Object.hasOwn(sources[experiment]!.arms, a)).slice(0, 3);
    if (known.length !== arms.length) wrong("arms", "known ones are shown");
    if (known.length > 0) state.arms = known;
  }
  if (asked.has("n")) {
    const n = Number(asked.get("n"));
    if (ladder.includes(n)) state.n = n;
    else wrong("n", `it can be ${ladder.join(", ")}`);
  }
  const view = asked.get("view");
  if (view === "photograph" || view === "heat" || view === "signed") state.view = view;
  else if (view !== null) wrong("view", "photographs are shown");
  for (const text of asked.getAll("set")) {
    const at = text.indexOf("=");
    const key = text.slice(0, at), to = text.slice(at + 1);
    if (at > 0 && path.test(key) && value.test(to)) state.set[key] = to;
    else said.push(`The address says set=${text.slice(0, 60)}, which is no setting: it is left out.`);
  }
  const pixel = asked.get("pixel");
  if (pixel !== null) {
    const found = /^(\d{1,5}),(\d{1,5})$/.exec(pixel);
    if (found) state.pixel = [Number(found[1]), Number(found[2])];
    else wrong("pixel", "none is open");
  }
  const arm = Number(asked.get("arm") ?? 0);
  if (Number.isInteger(arm) && arm >= 0 && arm < state.arms.length) state.arm = arm;
  else wrong("arm", "the first one is shown");
  state.lesson = /^[a-z0-9-]{0,40}$/.exec(asked.get("lesson") ?? "")?.[0] ?? "";
  for (const text of asked.getAll("answer")) {
    const found = /^([a-z0-9-]{1,40}):([-0-9.a-z,]{1,60})$/.exec(text);
    if (found) state.answers[found[1]!] = found[2]!;
  }
  return state;
}

export function write(state: State): string {
  const out = new URLSearchParams({ experiment: state.experiment, arms: state.arms.join(","), n: String(state.n) });
  if (state.view !== "photograph") out.set("view", state.view);
  for (const [key, to] of Object.entries(state.set)) out.append("set", `${key}=${to}`);
  if (state.pixel) out.set("pixel", state.pixel.join(","));
  if (state.arm > 0) out.set("arm", String(state.arm));
  if (state.lesson) out.set("lesson", state.lesson);
  for (const [lesson, answer] of Object.entries(state.answers)) out.append("answer", `${lesson}:${answer}`);
  return `#${out.toString().replaceAll("%2C", ",").replaceAll("%3D", "=").replaceAll("%3A", ":")}`;
}

/** Rungs that an arm of the experiment does not have, as --set takes them; "" where there are none. */
function rungs(arm: string, state: State, source: Source): string {
  if (source.arms[arm]?.includes(state.n)) return "";
  const most = Math.max(state.n, 64);
  return `arms.${arm}.n=[${ladder.filter((n) => n <= most && (n > 1 || state.n === 1)).join(", ")}]`;
}

/** What was set, and what the arms that are looked at need beside it. */
export function overrides(state: State, source: Source): string[] {
  const set = Object.entries(state.set).map(([key, to]) => `${key}=${to}`);
  return [...set, ...state.arms.map((arm) => rungs(arm, state, source)).filter((word) => word !== "")];
}

export function command(state: State, source: Source): string {
  const quoted = (word: string): string => (/^[A-Za-z0-9_.=/-]+$/.test(word) ? word : `'${word}'`);
  const measured = source.quadrature ? [] : ['reference.kind="quadrature"']; // as the page does, whatever the file says
  return ["./run", source.file, ...[...overrides(state, source), ...measured].flatMap((word) => ["--set", quoted(word)])].join(" ");
}
