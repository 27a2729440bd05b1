// The state in the address, and the command line that gives the same numbers. The address is data: an invalid part is
// replaced by its default, with a message.
import { Lesson, lessons } from "./lessons";
import { exercises } from "./exercises";
import { Given, Opening } from "./jobs";
import { ladder, Region } from "./model";
import { grounds } from "./templates";

export interface Source {
  file: string; title: string; text: string; published: string; arms: Record<string, number[]>; regions: Region[];
  size: [number, number]; reference: string; // as the file has it: "quadrature", "note", "paired"
  given?: Given; // of a scene of the user
  films: Record<string, string>; // the program's hashes, by "ARM n=N s=S"
}
export type Part = "bench" | "write" | "faults" | "lessons" | "sheet";
const parts: readonly Part[] = ["bench", "write", "faults", "lessons", "sheet"];

export interface State {
  experiment: string;
  arms: string[];
  n: number;
  view: "photograph" | "heat" | "signed";
  set: Record<string, string>; // path -> value, as --set accepts it
  pixel: [number, number] | undefined;
  arm: number; // whose draws the hemisphere shows
  part: Part;
  lesson: string;
  answers: Record<string, string>; // lesson -> answer
  exercise: string;
  code: string; // of the user's sampler, packed.ts; "": that of a template
  ground: string; // its surface, templates.ts
}

const path = /^(?!__)[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+){0,3}$/;
const own = /^(n|arms\.[^.]+\.n|reference\.kind)$/; // set by the page itself
const keys = ["experiment", "arms", "n", "view", "set", "pixel", "arm", "part", "lesson", "answer", "exercise", "code", "ground"];
const number = "-?(\\d+\\.?\\d*|\\.\\d+)([eE][-+]?\\d{1,3})?";
const value = new RegExp(`^(${number}|\\[ *${number}( *, *${number}){0,7} *\\]|"[a-z-]{1,40}")$`);

export function fresh(experiment: string, source: Source): State {
  const arms = Object.keys(source.arms).slice(0, 3), sampleCounts = source.arms[arms[0]!]!;
  return {
    experiment, arms, n: Math.max(...ladder.filter((n) => n <= Math.max(...sampleCounts))), view: "photograph", set: {}, pixel: undefined, arm: 0, part: "bench",
    lesson: "", answers: {}, exercise: "", code: "", ground: "",
  };
}

/** Whether this is a valid answer of a lesson. */
function answers({ ask }: Lesson, to: string, size: readonly [number, number]): boolean {
  if (ask.kind === "choice") return ask.options.some(({ value }) => value === to);
  if (ask.kind === "slider") return to !== "" && Number(to) >= ask.low && Number(to) <= ask.high;
  const box = /^(\d{1,5}),(\d{1,5}),(\d{1,5}),(\d{1,5})$/.exec(to)?.slice(1).map(Number);
  return box !== undefined && box[0]! < box[2]! && box[2]! < size[0] && box[1]! < box[3]! && box[3]! < size[1];
}

/** The part of the page, the lesson and its answers. */
function readLessons(asked: URLSearchParams, state: State, size: readonly [number, number], response: string[], wrong: (key: string, instead: string) => void): void {
  const part = asked.get("part");
  if (parts.includes(part as Part)) state.part = part as Part;
  else if (part !== null) wrong("part", "the bench is open");
  const exercise = asked.get("exercise") ?? "";
  if (exercises.some(({ name }) => name === exercise)) Object.assign(state, { exercise, part: "faults" });
  else if (exercise) wrong("exercise", "the list of exercises is open"), (state.part = "faults");
  const code = asked.get("code"), ground = asked.get("ground");
  if (code !== null && /^[A-Za-z0-9_-]{1,40000}$/.test(code)) Object.assign(state, { code, part: exercise ? "faults" : "write" });
  else if (code !== null) wrong("code", "a template is open");
  if (ground !== null && ground in grounds) state.ground = ground;
  else if (ground !== null) wrong("ground", "that of the template is used");
  const lesson = asked.get("lesson") ?? "";
  if (lessons.some(({ id }) => id === lesson)) Object.assign(state, { lesson, part: "lessons" });
  else if (lesson) wrong("lesson", "the list of lessons is open"), (state.part = "lessons");
  for (const text of asked.getAll("answer")) {
    const at = text.indexOf(":"), to = text.slice(at + 1), of = lessons.find(({ id }) => id === text.slice(0, at));
    if (of && answers(of, to, size)) state.answers[of.id] = to;
    else response.push(`The address says answer=${text.slice(0, 60)}, which answers no lesson: it is ignored.`);
  }
}

/** Reads an address; `response` receives a line for everything that is invalid. */
export function read(hash: string, sources: Record<string, Source>, samplers: string[], response: string[]): State {
  const asked = new URLSearchParams(hash.replace(/^#/, ""));
  const first = Object.keys(sources)[0]!;
  const wrong = (key: string, instead: string): void => {
    response.push(`The address says ${key}=${(asked.get(key) ?? "").slice(0, 60)}, which does not exist here: ${instead}.`);
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
    if (own.test(key)) response.push(`The address says set=${text.slice(0, 60)}, which the page sets itself: it is ignored.`);
    else if (at > 0 && path.test(key) && value.test(to)) state.set[key] = to;
    else response.push(`The address says set=${text.slice(0, 60)}, which is not a setting: it is ignored.`);
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
  readLessons(asked, state, sources[first]!.size, response, wrong);
  for (const key of new Set(asked.keys()))
    if (!keys.includes(key)) wrong(key, "it is left out");
    else if (key !== "set" && key !== "answer" && asked.getAll(key).length > 1) response.push(`The address says ${key} twice: the first one counts.`);
  return state;
}

export function write(state: State): string {
  const out = new URLSearchParams({ experiment: state.experiment, arms: state.arms.join(","), n: String(state.n) });
  if (state.view !== "photograph") out.set("view", state.view);
  for (const [key, to] of Object.entries(state.set)) out.append("set", `${key}=${to}`);
  if (state.pixel) out.set("pixel", state.pixel.join(","));
  if (state.arm > 0) out.set("arm", String(state.arm));
  if (state.exercise && state.part === "faults") out.set("exercise", state.exercise);
  else if (state.lesson) out.set("lesson", state.lesson);
  else if (state.part !== "bench") out.set("part", state.part);
  if (state.part === "write") {
    if (state.code) out.set("code", state.code);
    if (state.ground) out.set("ground", state.ground);
  }
  for (const [lesson, answer] of Object.entries(state.answers)) out.append("answer", `${lesson}:${answer}`);
  return `#${out.toString().replaceAll("%2C", ",").replaceAll("%3D", "=").replaceAll("%3A", ":").replaceAll("%2F", "/")}`;
}

/** Sample counts that an arm of the experiment does not have, in the form for --set; "" if there are none. */
function sampleCounts(arm: string, state: State, source: Source): string {
  if (source.arms[arm]?.includes(state.n)) return "";
  const most = Math.max(state.n, 64);
  return `arms.${arm}.n=[${ladder.filter((n) => n <= most && (n > 1 || state.n === 1)).join(", ")}]`;
}

/** The program's hash of a film that the page has too, if the settings are the experiment's; regions and k do not
 *  change it. */
export function nativeHash(state: State, source: Source, key: string): string | undefined {
  return Object.keys(state.set).every((path) => /^(regions\.|firefly_k$)/.test(path)) ? source.films[key] : undefined;
}

/** The changed settings, and those that the displayed arms also need. */
export function overrides(state: State, source: Source): string[] {
  const set = Object.entries(state.set).map(([key, to]) => `${key}=${to}`);
  return [...set, ...state.arms.map((arm) => sampleCounts(arm, state, source)).filter((word) => word !== "")];
}

/** What the workers open: the experiment with some settings. */
export function openingOf({ file, text, published, given }: Source, set: string[]): Opening {
  return { file, text, published, set, ...(given ? { given } : {}) };
}

/** A word quoted for a shell. */
export const quoted = (word: string): string => (/^[A-Za-z0-9_.=/-]+$/.test(word) ? word : `'${word}'`);

export function command(state: State, source: Source): string {
  const measured = source.reference === "note" ? ['reference.kind="quadrature"'] : []; // as the page does
  return [source.given ? "crescent run" : "./run", quoted(source.file), ...[...overrides(state, source), ...measured].flatMap((word) => ["--set", quoted(word)])].join(" ");
}
