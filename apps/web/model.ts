// The state behind the pictures: the experiment with its settings, its films at growing sample counts, its reference,
// its metrics. Workers compute the tiles; one of them, the film worker, assembles and paints them.
import { Box, EngineError } from "./api";
import { Answer, Opening, Paint } from "./jobs";
import { FilmWorker, mostSamples, Pool } from "./pool";

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
  reference: string; reference_cost: number; // "paired": two estimates; the cost of one of its pixels, in samples
}
export interface Metric { value: number | string; text: string; published?: string }
export interface Metrics {
  key: string; largest: number; bad: number; hash: string; metrics: Record<string, Metric>; unsure?: string[];
  own?: Record<string, string>; // by region, the error of a reference of two estimates
}
export interface Tail { k?: number; se?: number; heavy?: boolean; text?: string; words: string }

/** One picture: an arm of the experiment and its results so far. */
export interface Shown {
  arm: number; name: string; n: number; sampleCounts: { n: number; metrics: Metrics }[]; tails: Record<string, Tail>;
  bands: Record<string, [number, number, number][]>; // by region: N, and the 5 % and 95 % quantiles of the RMSE over seeds
}

/** The listener of the model. */
export interface Viewer {
  opened(described: Described, shown: Shown[]): void;
  painted(index: number, box: Box): void; // index -1: the reference
  measured(): void;
  tailed(): void;
  spread(): void; // over seeds
  failed(error: EngineError): void;
}

/** One pixel of all films. */
export interface PixelValues {
  shape: string; reference?: string; films: { y: string; error?: string; se: string; n: number; zero: string; met: string }[];
}

export const ladder = [1, 4, 16, 64, 256, 1024];
const referenceAfter = 64; // sample counts up to this one are computed before it
const seedsOfBands = 8;
const quadratureCost = 2000, filmCost = 30; // of a pixel, in samples: apps/web/parts.h
const untouchedByReference = /^(seed|firefly_k|arms\.|regions\.)/;

export class Model {
  described!: Described;
  shown: Shown[] = [];
  referenceDone = false;
  finished = false;
  startedAt = 0;
  took = 0; // ms to the last metric, and to the last film
  filmsTook = 0;
  private era = 0;
  private opening = false; // the film worker is between two experiments
  private tiles: { key: string; parts: { box: Box; bytes: ArrayBuffer }[] } = { key: "", parts: [] };

  constructor(readonly filmWorker: FilmWorker, public pool: Pool, private readonly viewer: Viewer) {}

  private boxes(cost: number, [width, height]: readonly [number, number] = [this.described.width, this.described.height]): Box[] {
    return this.pool.tiles(width, height, cost);
  }
  private cost(shown: Shown[], n: number): number {
    return shown.reduce((sum, { arm }) => sum + n * this.described.arms[arm]!.techniques + filmCost, 0);
  }

  /** A request to the film worker, of the experiment that is open; undefined if it is no longer wanted. */
  private async wanted(still: () => boolean, request: () => Promise<Answer>): Promise<Answer | undefined> {
    if (this.opening || !still()) return undefined;
    const answer = await request();
    return !this.opening && still() ? answer : undefined;
  }

  async parts<T>(still: () => boolean, call: string, request?: unknown, given: number[] = []): Promise<T | undefined> {
    return (await this.wanted(still, () => this.filmWorker.request({ kind: "json", call, request, given })))?.response as T | undefined;
  }

  /** RMSE against N as SVG. */
  async chart(still: () => boolean, request: unknown): Promise<string | undefined> {
    return (await this.wanted(still, () => this.filmWorker.request({ kind: "words", call: "ladder_chart", request })))?.response as string | undefined;
  }

  /** Opens, and begins to compute up to n samples per pixel of these arms; throws EngineError for invalid settings. */
  async run(opening: Opening, arms: string[], n: number): Promise<void> {
    const era = ++this.era, sampleCounts = [...ladder.filter((sampleCount) => sampleCount > 1 && sampleCount < n), n];
    this.startedAt = performance.now();
    this.finished = this.referenceDone = false;
    this.opening = true;
    this.pool.open({ ...opening, published: "" });
    const { described } = (await this.filmWorker.request({ kind: "look", opening })).response as { described: Described };
    if (era !== this.era) return;
    const shown = arms.map((name) => ({ arm: described.arms.findIndex((a) => a.name === name), name, n: 0, sampleCounts: [], tails: {}, bands: {} }));
    await Promise.all([this.filmWorker.request({ kind: "call", call: "film_buffer", given: [-1] }), ...shown.map((s, index) => this.begin(index, s.arm, sampleCounts[0]!))]);
    if (era !== this.era) return;
    this.described = described;
    this.shown = shown;
    this.opening = false;
    this.viewer.opened(this.described, this.shown);
    try {
      await this.pool.ready;
      if (era !== this.era) return;
      await this.compute(era, opening, sampleCounts);
    } catch (error) {
      if (era === this.era) this.viewer.failed(error instanceof EngineError ? error : new EngineError("bug", String(error)));
    }
  }

  /** Drops the work in progress. */
  stop(): void {
    ++this.era;
    this.opening = true;
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
    await this.bands(era);
  }

  private async begin(index: number, arm: number, n: number): Promise<void> { await this.filmWorker.request({ kind: "call", call: "begin", given: [index, arm, n] }); }

  private async sampleCount(era: number, n: number): Promise<void> {
    if (era !== this.era) return;
    const begun = this.shown.map((s, index) => this.begin(index, s.arm, n)), boxes = this.boxes(this.cost(this.shown, n));
    let left = boxes.length;
    await Promise.all([...begun, ...boxes.map(async (box) => {
      if (!(await this.tile(era, this.shown.map((s, index) => [index, s.arm]), n, box))) return;
      this.shown.forEach((_, index) => this.viewer.painted(index, box));
      if (--left > 0) return;
      for (const s of this.shown) s.n = n;
      if (this.referenceDone) await this.measure(era);
    })]);
  }

  /** A sample count computed only for its metrics, in a film that no picture shows. */
  private async again(era: number, n: number): Promise<void> {
    const spare = this.shown.length;
    for (const s of this.shown) {
      if (era !== this.era) return;
      await Promise.all([this.begin(spare, s.arm, n), ...this.boxes(this.cost([s], n)).map((box) => this.tile(era, [[spare, s.arm]], n, box))]);
      const metrics = await this.metersOf(era, spare);
      if (!metrics) return;
      s.sampleCounts.push({ n, metrics });
      s.sampleCounts.sort((a, b) => a.n - b.n);
    }
  }

  /** Puts one tile of each arm into its film, [film, arm]; false if something else was opened meanwhile. */
  private async tile(era: number, films: [number, number][], n: number, box: Box): Promise<boolean> {
    const { bytes } = await this.pool.request({ kind: "tile", arms: films.map(([, arm]) => arm), n, box });
    if (era !== this.era || !bytes) return false;
    await this.filmWorker.request({ kind: "put", films: films.map(([film]) => film), box, bytes }, bytes);
    return era === this.era;
  }

  private metersOf(era: number, film: number): Promise<Metrics | undefined> { return this.parts<Metrics>(() => era === this.era, "metrics", undefined, [film]); }

  /** The metrics of every arm at the sample count that is complete. */
  private async measure(era: number): Promise<void> {
    const counts = this.shown.map((s) => s.n);
    const all = await Promise.all(this.shown.map((_, index) => this.metersOf(era, index)));
    if (era !== this.era || all.some((metrics) => !metrics)) return;
    this.shown.forEach((s, index) => s.sampleCounts.push({ n: counts[index]!, metrics: all[index]! }));
    this.viewer.measured();
  }

  /** The ends of the scales of maps: of |Y - Y_ref|, and of the variance. */
  async scales(): Promise<{ top: number; variance: number } | undefined> {
    const { era } = this;
    return this.parts(() => era === this.era, "scale", undefined, [this.shown.length]);
  }

  /** A disk that `call` paints, RGBA, `size` pixels across. */
  async disk(still: () => boolean, call: string, request: Record<string, unknown>, size: number): Promise<ImageData | undefined> {
    const answer = await this.wanted(still, () => this.filmWorker.request({ kind: "disk", call, request: { ...request, size }, size }));
    return answer && new ImageData(new Uint8ClampedArray(answer.bytes![0]!), size, size);
  }

  /** The reference is kept if only seeds, arms, regions or k have changed; returns whether it is complete. */
  private keep(opening: Opening): boolean {
    const key = JSON.stringify([opening.text, opening.given?.key, opening.set.filter((set) => !untouchedByReference.test(set))]);
    if (this.tiles.key !== key) this.tiles = { key, parts: [] };
    return this.tiles.parts.length === this.referenceBoxes().length;
  }
  /** Large ones: no code of the user runs, and ten thousand requests would block the page. */
  private referenceBoxes(): Box[] { return this.pool.tiles(this.described.width, this.described.height, this.described.reference_cost, mostSamples); }

  /** What is known is copied first. */
  private async reference(era: number): Promise<void> {
    const { parts } = this.tiles;
    const put = async (box: Box, bytes: ArrayBuffer): Promise<void> => {
      await this.filmWorker.request({ kind: "put", films: [-1], box, bytes: [bytes] });
      if (era === this.era) this.viewer.painted(-1, box);
    };
    const have = new Set(parts.map(({ box }) => `${box.x0} ${box.y0}`));
    const missing = this.referenceBoxes().filter((box) => !have.has(`${box.x0} ${box.y0}`));
    await Promise.all([...parts.map(({ box, bytes }) => put(box, bytes)), ...missing.map(async (box) => {
      const { bytes } = await this.pool.request({ kind: "reference", box });
      if (era !== this.era || !bytes) return;
      parts.push({ box, bytes: bytes[0]! });
      await put(box, bytes[0]!);
    })]);
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
        const tail = await this.request<Tail>("tail", { arm: s.name, region: region.name, box: region.box });
        if (era !== this.era) return;
        s.tails[region.name] = tail;
        this.viewer.tailed();
      }
  }

  /** The spread of the RMSE over seeds, one arm, region and sample count after another, up to a limit of work. */
  private async bands(era: number): Promise<void> {
    const most = 4e7; // samples of one band
    for (const region of this.described.regions) {
      const [x0, y0, x1, y1] = region.box, pixels = (x1 - x0 + 1) * (y1 - y0 + 1);
      if (this.described.reference === "paired" && pixels * this.described.reference_cost > most) continue;
      for (const s of this.shown)
        for (const { n } of s.sampleCounts) {
          if (era !== this.era) return;
          if (pixels * n * seedsOfBands > most || !this.described.arms[s.arm]!.sampler) continue;
          const found = await this.request<{ q05: number | string; q95: number | string }>("measure", { arm: s.name, n, region: region.name, box: region.box, seeds: seedsOfBands });
          if (era !== this.era) return;
          if (typeof found.q05 === "number" && typeof found.q95 === "number" && found.q05 > 0) (s.bands[region.name] ??= []).push([n, found.q05, found.q95]);
        }
      this.viewer.spread();
    }
  }

  /** A request to any worker, of another experiment if one is given: such a request survives other openings. */
  async request<T>(call: string, request: unknown, opening?: Opening): Promise<T> {
    if (!opening) return (await this.pool.request({ kind: "json", call, request })).response as T;
    return (await this.pool.request({ kind: "json", call, request, opening }, true)).response as T;
  }

  /** The reference of an experiment as a picture, RGBA of one box after another. The last request is computed first. */
  async photograph(opening: Opening, size: readonly [number, number], put: (box: Box, bytes: ArrayBuffer) => void): Promise<void> {
    await this.pool.ready;
    for (const box of this.boxes(quadratureCost + filmCost, size).reverse()) // and its colours
      this.pool.request({ kind: "photograph", box, opening }, true).then(({ bytes }) => put(box, bytes![0]!), () => {}); // the question works without it
  }

  /** RGBA of a box, rows from the top; undefined if it is no longer wanted. */
  async pixels(still: () => boolean, paint: Paint, box: Box): Promise<ImageData | undefined> {
    const answer = await this.wanted(still, () => this.filmWorker.request({ kind: "paint", paint, box }));
    return answer && new ImageData(new Uint8ClampedArray(answer.bytes![0]!), box.x1 - box.x0, box.y1 - box.y0);
  }

  /** All films at one pixel. */
  values(still: () => boolean, i: number, j: number): Promise<PixelValues | undefined> {
    return this.parts(still, "pixel_values", { i, j, count: this.shown.length, reference: this.referenceDone });
  }
}
