// The jobs of a worker, and their execution.
import { Api, Box, EngineError, pixelsOf } from "./api";
import { UserSampler } from "./user";

/** Files of the user, which an experiment names. `key`: another one for other files. */
export interface Given { key: string; files: { name: string; bytes: Blob }[] }
export interface Opening { file: string; text: string; set: string[]; published: string; given?: Given }

/** What is painted of a film: apps/web/pictures.cpp. */
export interface Paint { picture: number; index: number; other: number; top: number; times: number }

export type Job =
  | { kind: "open"; opening: Opening }
  | { kind: "look"; opening: Opening } // opens it and says what it is; "" as text: one is made for the files
  | { kind: "tile"; arms: number[]; n: number; box: Box } // a film's planes for each arm
  | { kind: "reference"; box: Box }
  | { kind: "photograph"; box: Box; opening: Opening } // of the reference
  | { kind: "strips"; arms: number[]; n: number; width: number; height: number; opening: Opening } // a picture, of each arm a strip
  | { kind: "json"; call: string; request: unknown; opening?: Opening; given?: number[] } // opening: for another experiment
  // The rest is for the worker that assembles the films.
  | { kind: "call"; call: string; given: number[] }
  | { kind: "words"; call: string; request: unknown } // an answer that is no JSON
  | { kind: "put"; films: number[]; box: Box; bytes: ArrayBuffer[] } // tiles of films; of the reference, -1
  | { kind: "paint"; paint: Paint; box: Box }
  | { kind: "disk"; call: string; request: unknown; size: number };

export type Answer = { bytes?: ArrayBuffer[]; response?: unknown };
export interface Fault { kind: string; text: string; lines?: [number, number][] } // lines: of the places in the script where it happened
export type Reply = { id: number; answer?: Answer; error?: Fault; size?: number }; // id of no job: a sign of life; size: of its instance

const filmPlanes = 9, referencePlanes = 5;

declare class FileReaderSync { readAsArrayBuffer(blob: Blob): ArrayBuffer }

async function perform(api: Api, job: Exclude<Job, { kind: "open" | "look" }>): Promise<Answer> {
  switch (job.kind) {
    case "tile": {
      const { x0, y0, x1, y1 } = job.box, pixels = pixelsOf(job.box);
      const bytes: ArrayBuffer[] = [];
      for (const arm of job.arms) bytes.push(await api.bytesLater("tile", 4 * ((filmPlanes + 1) * pixels + 1), arm, job.n, x0, y0, x1, y1));
      return { bytes };
    }
    case "reference": {
      const { x0, y0, x1, y1 } = job.box;
      return { bytes: [api.bytes("reference_tile", 4 * referencePlanes * pixelsOf(job.box), x0, y0, x1, y1)] };
    }
    case "photograph": {
      const { x0, y0, x1, y1 } = job.box;
      api.number("reference_tile", x0, y0, x1, y1);
      return { bytes: [api.bytes("paint", 4 * pixelsOf(job.box), 0, -1, 0, 1, 1, x0, y0, x1, y1)] };
    }
    case "strips": {
      const { arms, n, width, height } = job;
      return { bytes: arms.map((arm, k) => {
        const ends = [k, k + 1].map((part) => Math.round((part * width) / arms.length)), x0 = ends[0]!, x1 = ends[1]!;
        api.give(api.bytes("tile", 4 * ((filmPlanes + 1) * (x1 - x0) * height + 1), arm, n, x0, 0, x1, height));
        api.number("begin", 0, arm, n);
        api.number("put", 0, x0, 0, x1, height);
        return api.bytes("paint", 4 * (x1 - x0) * height, 0, 0, 0, 1, 1, x0, 0, x1, height);
      }) };
    }
    case "json":
      return { response: await api.jsonLater(job.call, job.request, ...(job.given ?? [])) };
    case "words":
      return { response: api.say(job.call, job.request) };
    case "call":
      api.number(job.call, ...job.given);
      return {};
    case "put": {
      const { x0, y0, x1, y1 } = job.box;
      job.bytes.forEach((bytes, k) => {
        api.give(bytes);
        if (job.films[k]! < 0) api.number("put_reference", x0, y0, x1, y1);
        else api.number("put", job.films[k]!, x0, y0, x1, y1);
      });
      return {};
    }
    case "paint": {
      const { x0, y0, x1, y1 } = job.box, { picture, index, other, top, times } = job.paint;
      return { bytes: [api.bytes("paint", 4 * pixelsOf(job.box), picture, index, other, top, times, x0, y0, x1, y1)] };
    }
    case "disk":
      await api.jsonLater(job.call, job.request);
      return { bytes: [api.bytes("disk", 4 * job.size * job.size)] };
  }
}

const readsReference = (job: Job): boolean => job.kind === "reference" || job.kind === "photograph";

/** Tells the module what the user's functions take. Throws EngineError. */
export function introduce({ numbers, context, bits, points }: UserSampler, api: Api): void {
  api.number("user_takes", numbers, context ? 1 : 0, bits);
  if (points) api.say("user_takes_points", { ...points, numbers });
}

/** An instance that opens the experiment of a job, and opens it again after a failure. */
export class Answering {
  private api: Api;
  private last: Opening | undefined; // that of the page
  private here: Opening | undefined; // that of the api
  private ready = false; // to compute its reference
  private given = ""; // the key of the files that the api has

  /** `kept`: the number of pixels for which it keeps the hits of primary rays. */
  constructor(private readonly module: WebAssembly.Module, private readonly kept: number, private readonly user?: UserSampler) {
    this.api = this.made();
  }

  private made(): Api {
    const { user } = this, api = new Api(this.module, user?.calls);
    this.given = "";
    api.number("keep_points", this.kept);
    if (user) introduce(user, api);
    return api;
  }

  get size(): number { return this.api.size; }

  /** One at a time. */
  async answer(job: Job): Promise<Answer> {
    if (job.kind === "open") this.last = job.opening;
    const about = ("opening" in job ? job.opening : undefined) ?? this.last;
    try {
      if (job.kind === "look") return { response: this.look(job.opening) };
      if (about && about !== this.here && JSON.stringify(about) !== JSON.stringify(this.here)) this.open(about);
      if (readsReference(job) && !this.ready) {
        this.api.json("prepare_reference");
        this.ready = true;
      }
      return job.kind === "open" ? {} : await perform(this.api, job);
    } catch (error) {
      this.api = this.made(); // a failed call leaves its instance in an intermediate state
      this.here = undefined;
      this.ready = false;
      throw error;
    }
  }

  private open(about: Opening): unknown {
    this.here = undefined;
    this.ready = false;
    this.take(about.given);
    const described = this.api.json("open", about);
    this.here = about;
    return described;
  }

  /** The text of an experiment, and what the core says of it. */
  private look(opening: Opening): unknown {
    this.take(opening.given);
    const text = opening.text || this.api.say("experiment_of_files");
    return { text, described: this.open({ ...opening, text }) };
  }

  /** The files of an experiment stay for the next one that has none. A file is not read before its first bytes state a
   *  size that the module takes. */
  private take(given: Given | undefined): void {
    if (!given || given.key === this.given) return;
    const reader = new FileReaderSync(), headers = 64;
    this.given = "";
    this.api.number("forget_files");
    for (const { name, bytes } of given.files) {
      this.api.give(reader.readAsArrayBuffer(bytes.slice(0, headers)));
      this.api.json("expect_file", { name, size: bytes.size });
      this.api.give(reader.readAsArrayBuffer(bytes));
      this.api.json("keep_file", { name });
    }
    this.given = given.key;
  }
}

export function failure(error: unknown): Fault {
  if (error instanceof EngineError) return { kind: error.kind, text: error.message, ...(error.lines ? { lines: error.lines } : {}) };
  return { kind: "bug", text: String(error) };
}
