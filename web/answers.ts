// The answer of a lesson: numbers that the core measures now, in words. Nothing is looked up.
import { Answer, Lesson, Measured } from "./lessons";
import { Model, Region } from "./model";
import { Opening } from "./jobs";

export interface Found { answer: string; lines: string[] }

interface Series { rmse: number[]; median: number; q05: number; q95: number; reference: number; mean_median: number }
interface Furnace { name: string; measured: number; expected: number; se: number; k?: number; published?: number }

const digits = (x: number): string => String(Number(x.toPrecision(4)));

/** Asks the core on the experiment of the lessons, whatever the bench shows. */
export class Asker {
  constructor(private readonly model: Model, private readonly opening: Opening, private readonly regions: Region[]) {}

  private opened(set: readonly string[], arms: readonly string[]): Opening {
    const extra = arms.filter((arm) => !["uniform", "cosine", "phong"].includes(arm)).map((arm) => `arms.${arm}.n=[16, 64]`);
    return { ...this.opening, set: [...set, ...extra] };
  }

  private async measured(m: Measured): Promise<Series> {
    const box = this.regions.find((r) => r.name === m.region)!.box;
    return this.model.ask<Series>("measure", { arm: m.arm, n: m.n, box, seeds: m.seeds ?? 1 }, this.opened(m.set ?? [], [m.arm]));
  }

  async find(lesson: Lesson): Promise<Found> {
    const { answer } = lesson;
    switch (answer.by) {
      case "largest":
      case "smallest":
        return this.extreme(lesson, answer);
      case "ratio":
        return this.ratio(answer.of);
      case "firefly":
        return this.firefly(answer);
      case "furnace":
        return this.furnace(answer);
    }
  }

  private async extreme(lesson: Lesson, answer: Extract<Answer, { by: "largest" | "smallest" }>): Promise<Found> {
    const all = await Promise.all(answer.of.map((m) => this.measured(m)));
    const options = lesson.ask.kind === "choice" ? lesson.ask.options : [];
    const values = all.map((series) => series.median);
    const best = answer.by === "largest" ? Math.max(...values) : Math.min(...values);
    const lines = values.map((value, k) => `${options[k]!.words}: RMSE of ${answer.of[k]!.region} ${digits(value)} at N = ${answer.of[k]!.n}`);
    return { answer: options[values.indexOf(best)]!.value, lines };
  }

  private async ratio(of: readonly [Measured, Measured]): Promise<Found> {
    if (of[0].of === "spread") {
      const { q05, q95, median } = await this.measured(of[0]);
      return {
        answer: digits(q95 / q05),
        lines: [`${of[0].seeds} seeds: 5 % at ${digits(q05)}, median ${digits(median)}, 95 % at ${digits(q95)}: a factor of ${digits(q95 / q05)}`],
      };
    }
    const [a, b] = await Promise.all([this.measured(of[0]), this.measured(of[1])]);
    const line = (m: Measured, series: Series): string => `${m.arm}, N = ${m.n}: RMSE of ${m.region} ${digits(series.median)}`;
    return {
      answer: digits(a.median / b.median),
      lines: [line(of[0], a), line(of[1], b), `a factor of ${digits(a.median / b.median)}`],
    };
  }

  private async firefly(answer: Extract<Answer, { by: "firefly" }>): Promise<Found> {
    const box = this.regions.find((r) => r.name === answer.region)!.box;
    const found = await this.model.ask<Record<string, string>>("firefly", { arm: answer.arm, n: answer.n, box }, this.opened([], [answer.arm]));
    const factors: [string, string][] = [["f", found["f"]!], ["L", found["light"]!], ["cos", found["cos"]!], ["1/p", found["over_p"]!]];
    const largest = factors.reduce((a, b) => (Number(b[1]) > Number(a[1]) ? b : a))[0];
    const product = factors.map(([name, value]) => `${name} = ${value}`).join(", ");
    return { answer: largest, lines: [`pixel (${found["i"]}, ${found["j"]}): X = ${found["x"]}, of ${product}`] };
  }

  private async furnace(answer: Extract<Answer, { by: "furnace" }>): Promise<Found> {
    const all = await this.model.ask<Furnace[]>("furnaces_of", { n: answer.n }, this.opened([], []));
    const f = all.find((one) => one.name === answer.name)!;
    const heavy = f.k !== undefined && f.k >= 0.5;
    const lines = all.map((one) => `${one.name.replaceAll("_", " ")}: reads ${digits(one.measured)} ± ${digits(one.se)}, expected ${digits(one.expected)}` +
      (one.k === undefined ? "" : `, tail k̂ ${digits(one.k)}`));
    return { answer: heavy ? "tail" : Math.abs(f.measured - f.expected) < 1e-5 * f.expected ? "precision" : "bug", lines };
  }
}
