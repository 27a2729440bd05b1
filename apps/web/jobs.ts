// The jobs of a worker, and their execution in any instance: the same code in a worker and on the page's own thread.
import { Box, Api, DoorError, pixelsOf } from "./api";

export interface Opening { file: string; text: string; set: string[]; published: string }

export type Job =
  | { kind: "open"; opening: Opening }
  | { kind: "tile"; arms: number[]; n: number; box: Box } // a film's planes for each arm
  | { kind: "reference"; box: Box }
  | { kind: "photograph"; box: Box; opening: Opening } // of the reference
  | { kind: "ask"; call: string; request: unknown; opening?: Opening }; // opening: for another experiment

export type Answer = { bytes?: ArrayBuffer[]; response?: unknown };
export type Reply = { id: number; answer?: Answer; error?: { kind: string; text: string }; size?: number }; // size: of its instance

const filmPlanes = 9, referencePlanes = 5;

function perform(api: Api, job: Exclude<Job, { kind: "open" }>): Answer {
  switch (job.kind) {
    case "tile": {
      const { x0, y0, x1, y1 } = job.box, pixels = pixelsOf(job.box);
      return { bytes: job.arms.map((arm) => api.bytes("tile", 4 * ((filmPlanes + 1) * pixels + 1), arm, job.n, x0, y0, x1, y1)) };
    }
    case "reference": {
      const { x0, y0, x1, y1 } = job.box;
      return { bytes: [api.bytes("reference_tile", 4 * referencePlanes * pixelsOf(job.box), x0, y0, x1, y1)] };
    }
    case "photograph": {
      const { x0, y0, x1, y1 } = job.box;
      api.number("reference_tile", x0, y0, x1, y1);
      return { bytes: [api.bytes("paint", 4 * pixelsOf(job.box), 0, -1, 0, 1, x0, y0, x1, y1)] };
    }
    case "ask":
      return { response: api.ask(job.call, job.request) };
  }
}

const goesOn = (answer: Answer): boolean => typeof answer.response === "object" && answer.response !== null && "more" in answer.response;
const readsReference = (job: Job): boolean => job.kind === "reference" || job.kind === "photograph";

/** An instance that opens the experiment of a job, and opens it again after a failure. */
export class Answering {
  private api: Api;
  private last: Opening | undefined; // that of the page
  private here: Opening | undefined; // that of the api
  private ready = false; // ready to compute its reference
  private steps: (() => Answer)[] = []; // of the current job: the last step returns its answer
  private goes = false; // the first of them has parts left
  worked = 0; // the work of the last part, in samples, and of the largest so far
  most = 0;

  /** `kept`: the number of pixels for which it keeps the hits of primary rays. */
  constructor(private readonly module: WebAssembly.Module, private readonly kept = 0) { this.api = this.made(); }

  private made(): Api {
    const api = new Api(this.module);
    api.number("keep_points", this.kept);
    return api;
  }

  get size(): number { return this.api.size; }

  /** All parts of a job. */
  answer(job: Job): Answer {
    let answer = this.begin(job);
    while (!answer) answer = this.goOn();
    return answer;
  }

  /** The experiment of jobs that name no opening. */
  about(opening: Opening): void { this.last = opening; }

  /** The first part of a job; undefined if more are left. Unfinished parts from before are dropped. */
  begin(job: Job): Answer | undefined {
    if (job.kind === "open") this.last = job.opening;
    const about = ("opening" in job ? job.opening : undefined) ?? this.last;
    if (this.api.waits) this.renew();
    this.goes = false;
    this.steps = [];
    const known = !about || about === this.here || JSON.stringify(about) === JSON.stringify(this.here);
    if (!known) this.steps.push(() => this.open(about));
    if (readsReference(job) && !(known && this.ready)) this.steps.push(() => this.prepare());
    this.steps.push(() => (job.kind === "open" ? {} : perform(this.api, job)));
    return this.goOn();
  }

  /** The next part of the current job. */
  goOn(): Answer | undefined {
    return this.part(() => {
      const answer = this.goes ? { response: this.api.ask("go_on") } : this.steps[0]!();
      this.goes = goesOn(answer);
      if (this.goes) return undefined;
      this.steps.shift();
      return this.steps.length === 0 ? answer : undefined;
    });
  }

  private open(about: Opening): Answer {
    this.here = undefined;
    this.ready = false;
    this.api.ask("open", about);
    this.here = about;
    return {};
  }

  private prepare(): Answer {
    this.ready = true;
    return { response: this.api.ask("prepare_reference") };
  }

  private part(work: () => Answer | undefined): Answer | undefined {
    this.worked = 0;
    try {
      const answer = work();
      this.worked = this.api.number("worked");
      this.most = Math.max(this.most, this.worked);
      return answer;
    } catch (error) {
      this.renew();
      throw error;
    }
  }

  private renew(): void {
    this.api = this.made();
    this.here = undefined;
    this.ready = false;
  }
}

export function failure(error: unknown): { kind: string; text: string } {
  if (error instanceof DoorError) return { kind: error.kind, text: error.message };
  return { kind: "bug", text: String(error) };
}
