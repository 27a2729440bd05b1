// The state behind the pictures: the experiment with its settings, its films at growing sample counts, its reference,
// its metrics. One instance of the module on the page's own thread assembles the tiles; workers compute them.
import { Box, Api, DoorError, pixelsOf } from "./api";
import { Opening } from "./jobs";
import { Pool } from "./pool";
import { Turns } from "./turns";

export interface Arm {
  name: string; sampler: string; n: number[]; techniques: number; summary: string; formula: string; misses: string;
}
export interface Knob {
  path: string; label: string; unit: string; low: number; high: number; log: boolean; value: number | number[];
}
export interface Region { name: string; box: [number, number, number, number] }
export interface Described {
  title: string; width: number; height: number; seed: number; s: number; n: number; firefly_k: number; hash: string;
  arms: Arm[]; regions: Region[]; knobs: Knob[]; source: string;
}
export interface Metric { value: number | string; text: string; published?: string }
export interface Metrics {
  key: string; largest: number; bad: number; hash: string; metrics: Record<string, Metric>; unsure?: string[];
}
export interface Tail { k?: number; se?: number; heavy?: boolean; text?: string; words: string }

/** One picture: an arm of the experiment and its results so far. */
export interface Shown {
  arm: number; name: string; n: number; sampleCounts: { n: number; metrics: Metrics }[]; tails: Record<string, Tail>;
}

/** The listener of the model. */
export interface Viewer {
  opened(described: Described, shown: Shown[]): void;
  painted(index: number, box: Box): void; // index -1: the reference
  measured(): void;
  tailed(): void;
  failed(error: DoorError): void;
}

export const ladder = [1, 4, 16, 64, 256, 1024];
const referenceAfter = 64; // sample counts up to this one are computed before it
const untouchedByReference = /^(seed|firefly_k|arms\.|regions\.)/;

export class Model {
  api: Api;
  described!: Described;
  shown: Shown[] = [];
  referenceDone = false;
  finished = false;
  startedAt = 0;
  took = 0; // ms to the last metric, and to the last film
  filmsTook = 0;
  private readonly most: number; // samples of one part, and the cost of a pixel: of the reference; of a film, without its samples
  private readonly referenceCost: number;
  private readonly filmCost: number;
  private era = 0;
  private asking: Promise<unknown> = Promise.resolve(); // requests in parts, one after another
  private tiles: { key: string; parts: { box: Box; bytes: ArrayBuffer }[] } = { key: "", parts: [] };

  /** `api`: an instance of the module for the page's own thread. */
  constructor(private readonly module: WebAssembly.Module, api: Api, readonly pool: Pool, readonly turns: Turns, private readonly viewer: Viewer) {
    this.api = api;
    this.most = this.api.number("most_of_part");
    this.referenceCost = this.api.number("reference_cost");
    this.filmCost = this.api.number("film_cost");
  }

  private boxes(cost: number, [width, height]: readonly [number, number] = [this.described.width, this.described.height]): Box[] {
    return this.pool.tiles(width, height, cost, this.most);
  }
  private cost(shown: Shown[], n: number): number {
    return shown.reduce((sum, { arm }) => sum + n * this.described.arms[arm]!.techniques + this.filmCost, 0);
  }

  /** A call in parts, each in a turn that has room: one request after another. `take` is applied to the result before
   *  the next. Undefined if it is no longer wanted. */
  parts<T, R = T>(wanted: () => boolean, call: string, request?: unknown, given: number[] = [], take = (answer: T): R => answer as unknown as R): Promise<R | undefined> {
    const done = this.asking.then(async () => {
      for (let next = call; ; next = "go_on") {
        await this.turns.pass();
        if (!wanted()) return undefined;
        const response = next === call ? this.api.ask<T | { more: number }>(call, request, ...given) : this.api.ask<T | { more: number }>(next);
        this.turns.count(this.api.number("worked"));
        if (!(response as object).hasOwnProperty("more")) return take(response as T);
      }
    });
    this.asking = done.catch(() => {}); // the caller has the error
    return done;
  }

  /** Opens, and begins to compute up to n samples per pixel of these arms; throws DoorError for invalid settings. */
  async run(opening: Opening, arms: string[], n: number): Promise<void> {
    const era = ++this.era, sampleCounts = [...ladder.filter((sampleCount) => sampleCount > 1 && sampleCount < n), n];
    this.startedAt = performance.now();
    this.finished = this.referenceDone = false;
    this.pool.open({ ...opening, published: "" });
    try {
      this.described = this.api.ask<Described>("open", opening);
      this.shown = arms.map((name) => {
        const arm = this.described.arms.findIndex((a) => a.name === name);
        return { arm, name, n: 0, sampleCounts: [], tails: {} };
      });
      for (const [index, s] of this.shown.entries()) {
        if (!(await this.room(era, index))) return;
        this.api.number("begin", index, s.arm, sampleCounts[0]!);
      }
    } catch (error) {
      this.api = new Api(this.module); // a failed call leaves its instance in an intermediate state
      throw error;
    }
    this.viewer.opened(this.described, this.shown);
    await this.pool.ready;
    if (era !== this.era) return;
    try {
      await this.compute(era, opening, sampleCounts);
    } catch (error) {
      if (era === this.era) this.viewer.failed(error instanceof DoorError ? error : new DoorError("bug", String(error)));
    }
  }

  /** Drops the work in progress. */
  stop(): void {
    ++this.era;
    this.pool.cancel();
  }

  /** Films first: the reference costs more than a film at the sample count before it, and no picture waits for it.
   *  Sample counts completed before the reference are computed again, for their metrics. */
  private async compute(era: number, opening: Opening, sampleCounts: number[]): Promise<void> {
    const known = this.keep(opening), early = sampleCounts.filter((n) => !known && n <= referenceAfter), late = sampleCounts.filter((n) => !early.includes(n));
    const watched = early.filter((_, k) => k === 0 || k !== early.length - 2); // the last but one would cost a fifth of the time
    for (const n of watched) await this.sampleCount(era, n);
    this.filmsTook = performance.now() - this.startedAt;
    await this.reference(era);
    for (const n of early.slice(0, -1)) await this.again(era, n);
    for (const n of late) await this.sampleCount(era, n);
    if (era !== this.era) return;
    if (late.length > 0) this.filmsTook = performance.now() - this.startedAt;
    this.finished = true;
    this.took = performance.now() - this.startedAt;
    this.viewer.measured();
    await this.tails(era);
  }

  private async sampleCount(era: number, n: number): Promise<void> {
    if (era !== this.era) return;
    this.shown.forEach((s, index) => this.api.number("begin", index, s.arm, n));
    const boxes = this.boxes(this.cost(this.shown, n));
    let left = boxes.length;
    await Promise.all(boxes.map(async (box) => {
      if (!(await this.tile(era, this.shown.map((s, index) => [index, s.arm]), n, box))) return;
      this.shown.forEach((_, index) => this.viewer.painted(index, box));
      if (--left > 0) return;
      for (const s of this.shown) s.n = n;
      if (this.referenceDone) await this.measure(era);
    }));
  }

  /** The memory of a film, of the reference for -1; undefined if something else was opened meanwhile. */
  private room(era: number, film: number): Promise<object | undefined> { return this.parts<object>(() => era === this.era, "film_buffer", undefined, [film]); }

  /** A sample count computed only for its metrics, in a film that no picture shows. */
  private async again(era: number, n: number): Promise<void> {
    const spare = this.shown.length;
    for (const s of this.shown) {
      if (!(await this.room(era, spare))) return;
      this.api.number("begin", spare, s.arm, n);
      await Promise.all(this.boxes(this.cost([s], n)).map((box) => this.tile(era, [[spare, s.arm]], n, box)));
      const metrics = await this.metersOf(era, spare);
      if (!metrics) return;
      s.sampleCounts.push({ n, metrics });
      s.sampleCounts.sort((a, b) => a.n - b.n);
    }
  }

  /** Puts one tile of each arm into its film, [film, arm]; false if something else was opened meanwhile. */
  private async tile(era: number, films: [number, number][], n: number, box: Box): Promise<boolean> {
    const { bytes } = await this.pool.ask({ kind: "tile", arms: films.map(([, arm]) => arm), n, box });
    if (era !== this.era || !bytes) return false;
    films.forEach(([film], k) => {
      this.api.give(bytes[k]!);
      this.api.number("put", film, box.x0, box.y0, box.x1, box.y1);
    });
    this.turns.count(this.api.number("worked"));
    return true;
  }

  private metersOf(era: number, film: number): Promise<Metrics | undefined> { return this.parts<Metrics>(() => era === this.era, "metrics", undefined, [film]); }

  /** The metrics of every arm at the sample count that is complete. */
  private async measure(era: number): Promise<void> {
    const all = await Promise.all(this.shown.map((_, index) => this.metersOf(era, index)));
    if (era !== this.era) return;
    this.shown.forEach((s, index) => s.sampleCounts.push({ n: s.n, metrics: all[index]! }));
    this.viewer.measured();
  }

  /** The end of the scale of maps. */
  async top(): Promise<number> {
    const { era } = this;
    return (await this.parts<{ top: number }>(() => era === this.era, "scale", undefined, [this.shown.length]))?.top ?? 1;
  }

  /** A disk that `call` paints, RGBA, `size` pixels across. */
  disk(wanted: () => boolean, call: string, request: Record<string, unknown>, size: number): Promise<ImageData | undefined> {
    return this.parts(wanted, call, { ...request, size }, [], () => new ImageData(new Uint8ClampedArray(this.api.bytes("disk", 4 * size * size)), size, size));
  }

  /** The reference is kept if only seeds, arms, regions or k have changed; returns whether it is complete. */
  private keep(opening: Opening): boolean {
    const key = JSON.stringify([opening.text, opening.set.filter((set) => !untouchedByReference.test(set))]);
    if (this.tiles.key !== key) this.tiles = { key, parts: [] };
    return this.tiles.parts.length === this.referenceBoxes().length;
  }
  private referenceBoxes(): Box[] { return this.boxes(this.referenceCost); }

  /** By quadrature; the memory is copied first. */
  private async reference(era: number): Promise<void> {
    const { parts } = this.tiles;
    if (!(await this.room(era, -1))) return;
    const put = (box: Box, bytes: ArrayBuffer): void => {
      this.api.give(bytes);
      this.api.number("put_reference", box.x0, box.y0, box.x1, box.y1);
      this.turns.count(this.api.number("worked"));
      this.viewer.painted(-1, box);
    };
    for (const { box, bytes } of parts) {
      await this.turns.pass();
      if (era !== this.era) return;
      put(box, bytes);
    }
    const have = new Set(parts.map(({ box }) => `${box.x0} ${box.y0}`));
    const missing = this.referenceBoxes().filter((box) => !have.has(`${box.x0} ${box.y0}`));
    await Promise.all(missing.map(async (box) => {
      const { bytes } = await this.pool.ask({ kind: "reference", box });
      if (era !== this.era || !bytes) return;
      parts.push({ box, bytes: bytes[0]! });
      put(box, bytes[0]!);
    }));
    if (era !== this.era) return;
    this.referenceDone = true;
    if (this.shown[0]!.n > 0) await this.measure(era);
  }

  /** After the last change, one after another: each occupies a worker for a while, and a new setting must find one
   *  free. */
  private async tails(era: number): Promise<void> {
    await new Promise((done) => setTimeout(done, 300));
    for (const s of this.shown)
      for (const region of this.described.regions) {
        if (era !== this.era) return;
        const tail = await this.ask<Tail>("tail", { arm: s.name, box: region.box });
        if (era !== this.era) return;
        s.tails[region.name] = tail;
        this.viewer.tailed();
      }
  }

  /** A request to any worker, of another experiment if one is given: such a request survives other openings. */
  async ask<T>(call: string, request: unknown, opening?: Opening): Promise<T> {
    if (!opening) return (await this.pool.ask({ kind: "ask", call, request })).response as T;
    return (await this.pool.ask({ kind: "ask", call, request, opening }, true)).response as T;
  }

  /** The reference of an experiment as a picture, RGBA of one box after another. The last request is computed first. */
  async photograph(opening: Opening, size: readonly [number, number], put: (box: Box, bytes: ArrayBuffer) => void): Promise<void> {
    await this.pool.ready;
    for (const box of this.boxes(this.referenceCost + this.filmCost, size).reverse()) // and its colours
      this.pool.ask({ kind: "photograph", box, opening }, true).then(({ bytes }) => put(box, bytes![0]!), () => {}); // the question works without it
  }

  /** RGBA of a box, rows from the top. */
  pixels(picture: number, index: number, other: number, top: number, box: Box): ImageData {
    const size = 4 * pixelsOf(box), { x0, y0, x1, y1 } = box;
    const bytes = this.api.bytes("paint", size, picture, index, other, top, x0, y0, x1, y1);
    this.turns.count(this.api.number("worked"));
    return new ImageData(new Uint8ClampedArray(bytes), x1 - x0, y1 - y0);
  }
}
