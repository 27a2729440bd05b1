// The answer of a lesson: the core measures it now, in several workers, and words the conclusion. Nothing is looked up,
// and nothing is computed here.
import { Opening } from "./jobs";
import { Answer, Lesson, Measured } from "./lessons";
import { Box } from "./api";
import { Model, Region } from "./model";
import { quoted, Source } from "./state";

/** `kind` names the result: the lesson has a sentence for it. */
export interface Found { answer: string; kind: string; lines: string[]; pixel?: [number, number] }

/** For a sampler at one w_o; the program makes five times as many. A user waits for up to seven surfaces at once. */
export const evaluations = 300_000;
const builtIn = ["uniform", "cosine", "phong"]; // arms that the experiment of the lessons has

/** Queries the core on the experiment of the lessons, for any state of the bench. */
export class Asker {
  private readonly found = new Map<string, Promise<Found>>();
  readonly regions: Region[];
  readonly size: readonly [number, number];

  constructor(private readonly model: Model, private readonly opening: Opening, source: Source) {
    this.regions = source.regions;
    this.size = source.size;
  }

  /** The reference's picture, box by box as it is computed. */
  photograph(put: (box: Box, bytes: ArrayBuffer) => void): void { void this.model.photograph(this.opening, this.size, put); }

  /** The arms of a lesson as strips of one small picture. */
  async strips(arms: readonly string[], n: number, width: number, height: number): Promise<ImageData[]> {
    const all = [...builtIn, ...arms.filter((arm) => !builtIn.includes(arm))]; // as the experiment has them, and then those that are set
    const scene = this.opening.text.split(/^(?=\[)/m).filter((part) => !/^\[+(exponent|furnaces|plates|assertions|regions)/.test(part)).join("").replace(/^(published|note_evidence).*$/gm, "");
    const opening = { ...this.opening, text: scene, set: [`image.width=${width}`, `image.height=${height}`, ...all.slice(builtIn.length).map((arm) => `arms.${arm}.n=[${n}]`)] };
    const { bytes } = await this.model.pool.request({ kind: "strips", arms: arms.map((arm) => all.indexOf(arm)), n, width, height, opening }, true);
    return bytes!.map((one) => new ImageData(new Uint8ClampedArray(one), one.byteLength / 4 / height, height));
  }

  private opened(set: readonly string[], arms: readonly string[]): Opening {
    const extra = [...new Set(arms)].filter((arm) => !builtIn.includes(arm)).map((arm) => `arms.${arm}.n=[16, 64]`);
    return { ...this.opening, set: [...set, ...extra] };
  }
  private region(name: string): Region { return this.regions.find((r) => r.name === name)!; }

  private measured(m: Measured, { name, box }: Region = this.region(m.region)): Promise<unknown> {
    const { set = [], ...request } = m;
    return this.model.request("measure", { ...request, region: name, box }, this.opened(set, [m.arm]));
  }

  private all(of: readonly Measured[]): Promise<unknown[]> { return Promise.all(of.map((m) => this.measured(m))); }

  /** The verdicts of a sampler at one w_o. */
  checked<T>(sampler: string, theta: number): Promise<T> { return this.model.request<T>("checked", { sampler, theta, evaluations }, this.opened([], [])); }

  /** The furnaces at an exponent and a number of samples. */
  furnaces(lesson: Lesson, s: number, n: number): Promise<Found> { return this.model.request<Found>("furnaces_of", { ...lesson.answer, n }, this.opened([`sphere.s=${s}`], [])); }

  private concluded(answer: Answer, lesson: Lesson, of: unknown[], beside?: unknown[]): Promise<Found> {
    const options = lesson.ask.kind === "choice" ? lesson.ask.options.map((option) => option.value) : "of" in answer ? answer.of.map(({ arm }) => arm) : [];
    const surface = "surface" in answer ? answer.surface : "";
    return this.model.request<Found>("concluded", { by: answer.by, options, surface, of, beside }, this.opened([], []));
  }

  /** Measured once per page: the sheet shows the results of the lessons. `guess` is used if the answer is a box;
   *  without one, the experiment's own regions are measured. */
  find(lesson: Lesson, guess = ""): Promise<Found> {
    const drawn = lesson.ask.kind === "region", key = drawn ? `${lesson.id} ${guess}` : lesson.id;
    const known = this.found.get(key) ?? (drawn ? this.measureBoxes(lesson, guess) : this.measure(lesson));
    this.found.set(key, known);
    known.catch(() => this.found.delete(key));
    return known;
  }

  /** Over the drawn box; without one, over the region of the lesson. Also measures the other series. */
  private async measureBoxes(lesson: Lesson, guess: string): Promise<Found> {
    const { of } = lesson.answer as { of: readonly Measured[] }, own = this.region(of[0]!.region);
    const box = guess.split(",").map(Number) as Region["box"];
    const boxes = guess ? [{ name: "your box", box }] : [own, ...this.regions.filter((r) => r !== own)];
    const found = await Promise.all(boxes.map(async (region) => this.concluded(lesson.answer, lesson, await Promise.all(of.map((m) => this.measured(m, region))))));
    return { ...found[0]!, lines: found.flatMap(({ lines }) => lines) };
  }

  /** Commands of the program that give the numbers of the answer. */
  commands({ answer, ask }: Lesson, guess: string): string[] {
    const { file } = this.opening;
    switch (answer.by) {
      case "firefly": return [];
      case "furnace": return [`./run ${file}`];
      case "support": case "t-test": return answer.samplers.map((name) => `crescent check ${name} --wo ${answer.theta}`);
      case "chi-square": case "which": return ["crescent check --planted"];
      default: {
        const box = ask.kind === "region" && guess ? [`regions.mine.box=[${guess.replaceAll(",", ", ")}]`] : [];
        const lines = answer.of.map((m) => ["./run", file, "--seeds", String(m.seeds),
          ...[...this.opened(m.set ?? [], answer.of.map(({ arm }) => arm)).set, ...box].flatMap((word) => ["--set", quoted(word)])].join(" "));
        return [...new Set(lines)];
      }
    }
  }

  private async measure(lesson: Lesson): Promise<Found> {
    const { answer } = lesson;
    switch (answer.by) {
      case "firefly":
        return this.model.request<Found>("firefly", { ...answer, box: this.region(answer.region).box }, this.opened([], [answer.arm]));
      case "furnace":
        return this.model.request<Found>("furnaces_of", answer, this.opened([], []));
      case "support":
      case "chi-square":
      case "t-test":
      case "which":
        return this.concluded(answer, lesson, await Promise.all(answer.samplers.map((name) => this.checked(name, answer.theta))));
      default:
        return this.concluded(answer, lesson, await this.all(answer.of), answer.beside && (await this.all(answer.beside)));
    }
  }
}
