// Runs jobs in workers. A new opening cancels all earlier requests: results under way are dropped. One worker, the film
// worker, assembles the films; it processes its jobs in the order of their arrival.
import { Box, EngineError } from "./api";
import { returning } from "./domains";
import { Answer, Fault, Job, Opening, Reply } from "./jobs";
import { isShader } from "./wgsl";

type Done = (answer: Answer) => void;
type Failed = (error: EngineError) => void;
interface Waiting { job: Job; done: Done; failed: Failed; lasting: boolean }
type Kept = Map<string, WorkerClient>; // which worker keeps the hits of a box
const boxOf = ({ job }: Waiting): string => (job.kind === "tile" ? Object.values(job.box).join() : "");

const underWay = 2; // jobs queued per worker, so that it never waits for the page
const side = 64; // of a tile, in pixels
/** Samples of one job, of one that runs no code of the user: a new setting has to wait for running jobs. */
export const mostSamples = 2_000_000;
const patience = 20_000; // ms for a worker to start

const errorOf = ({ kind, text, lines }: Fault): EngineError => new EngineError(kind, text, lines);

class WorkerClient {
  size = 0; // bytes allocated by its instance
  private readonly held = new Map<number, Waiting>();
  private next = 0;
  private since = 0;
  constructor(private readonly worker: Worker, private readonly free: () => void) {
    worker.onmessage = ({ data }: MessageEvent): void => this.take(data as Reply);
  }
  get room(): boolean { return this.held.size < underWay; }
  /** Since when it has been working without a sign, in ms; 0: it is idle. */
  get busy(): number { return this.held.size > 0 ? performance.now() - this.since : 0; }
  give(waiting: Waiting, transfer: Transferable[] = []): void {
    if (this.held.size === 0) this.since = performance.now();
    this.held.set(++this.next, waiting);
    this.worker.postMessage({ id: this.next, job: waiting.job }, transfer);
  }
  end(): void { this.worker.terminate(); this.held.clear(); }
  private take(reply: Reply): void {
    const waiting = this.held.get(reply.id);
    this.held.delete(reply.id);
    this.since = performance.now();
    this.size = reply.size ?? this.size;
    if (waiting && reply.answer) waiting.done(reply.answer);
    else if (waiting && reply.error) waiting.failed(errorOf(reply.error));
    this.free();
  }
}

type Compiled = WebAssembly.Module | Promise<WebAssembly.Module>;

/** Starts a worker with an instance of the module. Rejects if the browser refuses, or with the fault of the user's code. */
function started(module: Compiled, url: string, free: () => void): Promise<WorkerClient> {
  return new Promise((resolve, reject) => {
    const late = setTimeout(() => reject(new EngineError("worker", "a worker did not start")), patience);
    const failed = (error: EngineError): void => { clearTimeout(late); reject(error); };
    try {
      const worker = new Worker(url);
      worker.onerror = (event): void => {
        event.preventDefault();
        failed(new EngineError(event.lineno ? "user" : "worker", event.message, [[event.lineno, event.colno]]));
      };
      worker.onmessage = ({ data }: MessageEvent): void => {
        clearTimeout(late);
        const { error } = data as Reply;
        if (error) return failed(errorOf(error));
        resolve(new WorkerClient(worker, free));
      };
      Promise.resolve(module).then((ready) => worker.postMessage(ready), (error: unknown) => failed(new EngineError("bug", String(error))));
    } catch (error) {
      failed(new EngineError("worker", String(error)));
    }
  });
}

/** The worker that assembles films. */
export class FilmWorker {
  private client: Promise<WorkerClient>;
  constructor(module: Compiled, source: string) {
    const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    this.client = started(module, url, () => {}).finally(() => URL.revokeObjectURL(url));
    this.client.catch(() => {}); // the pool has none either
  }
  size = 0;
  async request(job: Job, transfer: Transferable[] = []): Promise<Answer> {
    const client = await this.client;
    return new Promise((done, failed) => client.give({ job, lasting: true, done: (answer) => { this.size = client.size; done(answer); }, failed }, transfer));
  }
}

/** The user's code behind the script of a worker: see apps/web/user.ts. `first`: the line of the script before its first. */
export function withUser(source: string, code: string): { source: string; first: number } {
  if (isShader(code)) return { source: `${source}\ncrescentUser(() => ({ wgsl: ${JSON.stringify(code)} }));`, first: 0 };
  const before = `${source}\ncrescentUser(() => { "use strict";\n`;
  return { source: `${before}${returning(code)} });`, first: before.split("\n").length - 1 };
}

export class Pool {
  private clients: WorkerClient[] = [];
  private queue: Waiting[] = [];
  private kept: Kept = new Map();
  private opened: Opening | undefined;
  private era = 0;
  private ended = false;
  readonly ready: Promise<void>; // rejects if there is no worker: requests wait for it

  /** `source`: the worker's script; `most`: samples of one job. */
  constructor(private readonly module: Compiled, source: string, count: number, private readonly most = mostSamples) {
    const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    this.ready = Promise.allSettled(Array.from({ length: count }, () => this.startOne(url))).then((all) => {
      URL.revokeObjectURL(url);
      const [first] = all;
      if (this.clients.length === 0 && !this.ended) throw first?.status === "rejected" ? first.reason : new EngineError("worker", "no worker");
    });
    this.ready.catch(() => {});
  }

  private async startOne(url: string): Promise<void> {
    const client = await started(this.module, url, () => this.pump());
    if (this.ended) return client.end();
    if (this.opened) this.openIn(client, this.opened);
    this.clients.push(client);
    this.pump();
  }

  get workers(): number { return this.clients.length; }
  /** The longest time that one of the workers has given no sign at its job, ms. */
  get busy(): number { return Math.max(0, ...this.clients.map((client) => client.busy)); }

  /** Drops all requests except lasting ones. */
  cancel(): void {
    ++this.era;
    this.queue = this.queue.filter((waiting) => waiting.lasting);
  }

  /** Ends all workers: nothing is answered any more. */
  end(): void {
    this.ended = true;
    this.queue = [];
    for (const client of this.clients) client.end();
    this.clients = [];
  }

  /** Bytes allocated by the instances of all workers. */
  get size(): number { return this.clients.reduce((sum, client) => sum + client.size, 0); }

  /** Every instance opens this experiment; earlier requests are dropped. */
  open(opening: Opening): void {
    this.cancel();
    this.opened = opening;
    this.kept.clear();
    for (const client of this.clients) this.openIn(client, opening);
  }
  private openIn(client: WorkerClient, opening: Opening): void { // what they reject, the film worker rejects too
    client.give({ job: { kind: "open", opening }, lasting: true, done: () => {}, failed: () => {} });
  }

  /** `lasting`: the request survives other openings, and comes before all others. */
  async request(job: Job, lasting = false): Promise<Answer> {
    const era = this.era;
    await this.ready;
    return new Promise((resolve, reject) => {
      const here = (): boolean => lasting || era === this.era;
      const waiting: Waiting = { job, lasting, done: (a) => here() && resolve(a), failed: (e) => here() && reject(e) };
      if (lasting) this.queue.unshift(waiting);
      else this.queue.push(waiting);
      this.pump();
    });
  }

  /** The picture cut into boxes, one per job, from the middle. `cost`: samples per pixel; `most`: samples of one job. */
  tiles(width: number, height: number, cost: number, most = this.most): Box[] {
    const pixels = Math.max(1, Math.floor(most / cost));
    const across = Math.min(side, pixels), up = Math.max(1, Math.min(side, Math.floor(pixels / across)));
    const all: Box[] = [];
    for (let y0 = 0; y0 < height; y0 += up)
      for (let x0 = 0; x0 < width; x0 += across)
        all.push({ x0, y0, x1: Math.min(x0 + across, width), y1: Math.min(y0 + up, height) });
    const far = (b: Box): number => Math.hypot(b.x0 + b.x1 - width, (b.y0 + b.y1 - height) * 1.5);
    return all.sort((a, b) => far(a) - far(b));
  }

  private pump(): void {
    for (let client = this.next(); client && this.queue.length > 0; client = this.next()) client.give(this.nextFor(client));
  }
  /** The next job for a worker: a box whose points it holds already, else one that no worker holds, else one of another
   *  worker. */
  private nextFor(client: WorkerClient): Waiting {
    const good = (waiting: Waiting): boolean => [client, undefined].includes(this.kept.get(boxOf(waiting)));
    const [waiting] = this.queue.splice(Math.max(0, this.queue.findIndex(good)), 1);
    if (waiting!.job.kind === "tile") this.kept.set(boxOf(waiting!), client);
    return waiting!;
  }
  private next(): WorkerClient | undefined { return this.clients.find((client) => client.room); }
}
