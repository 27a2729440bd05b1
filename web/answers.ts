// The answer of a lesson: what the core measures now, in several workers, and what the core says that it comes to.
// Nothing is looked up, and nothing is computed here.
import { Opening } from "./jobs";
import { Answer, Lesson, Measured } from "./lessons";
import { Model, Region } from "./model";

/** `kind` names what was found: the lesson has a sentence for it. */
export interface Found { answer: string; kind: string; lines: string[] }

const builtIn = ["uniform", "cosine", "phong"]; // arms that the experiment of the lessons has

/** Asks the core on the experiment of the lessons, whatever the bench shows. */
export class Asker {
  private readonly found = new Map<string, Promise<Found>>();
  constructor(private readonly model: Model, private readonly opening: Opening, private readonly regions: Region[]) {}

  private opened(set: readonly string[], arms: readonly string[]): Opening {
    const extra = arms.filter((arm) => !builtIn.includes(arm)).map((arm) => `arms.${arm}.n=[16, 64]`);
    return { ...this.opening, set: [...set, ...extra] };
  }
  private box(name: string): readonly number[] { return this.regions.find((r) => r.name === name)!.box; }

  private measured(m: Measured): Promise<unknown> {
    const { set = [], ...request } = m;
    return this.model.ask("measure", { ...request, box: this.box(m.region) }, this.opened(set, [m.arm]));
  }

  /** The verdicts of a sampler at one w_o. */
  judged<T>(sampler: string, theta: number): Promise<T> { return this.model.ask<T>("judged", { sampler, theta }, this.opened([], [])); }

  private concluded(answer: Answer, lesson: Lesson, of: unknown[]): Promise<Found> {
    const options = lesson.ask.kind === "choice" ? lesson.ask.options.map((option) => option.value) : [];
    const surface = "surface" in answer ? answer.surface : "";
    return this.model.ask<Found>("concluded", { by: answer.by, options, surface, of }, this.opened([], []));
  }

  /** Measured once a page: the sheet shows what the lessons found. */
  find(lesson: Lesson): Promise<Found> {
    const known = this.found.get(lesson.id) ?? this.measure(lesson);
    this.found.set(lesson.id, known);
    known.catch(() => this.found.delete(lesson.id));
    return known;
  }

  private async measure(lesson: Lesson): Promise<Found> {
    const { answer } = lesson;
    switch (answer.by) {
      case "firefly":
        return this.model.ask<Found>("firefly", { ...answer, box: this.box(answer.region) }, this.opened([], [answer.arm]));
      case "furnace":
        return this.model.ask<Found>("furnaces_of", answer, this.opened([], []));
      case "support":
      case "chi-square":
      case "t-test":
      case "which":
        return this.concluded(answer, lesson, await Promise.all(answer.samplers.map((name) => this.judged(name, answer.theta))));
      default:
        return this.concluded(answer, lesson, await Promise.all(answer.of.map((m) => this.measured(m))));
    }
  }
}
