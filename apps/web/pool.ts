// Runs jobs in workers or, if a browser has none, in slices on the page's own thread. A new opening cancels all earlier
// requests: results under way are dropped.
import { Box, DoorError } from "./api";
import { Answer, Answering, failure, Job, Opening, Reply } from "./jobs";
import { Turns } from "./turns";

type Done = (answer: Answer) => void;
type Failed = (error: DoorError) => void;
interface Waiting { job: Job; done: Done; failed: Failed; lasting: boolean }
type Kept = Map<string, Hand>; // which worker keeps the hits of a box
const boxOf = ({ job }: Waiting): string => (job.kind === "tile" ? Object.values(job.box).join() : "");

const underWay = 2; // jobs queued per worker, so that it never waits for the page
const side = 64; // of a tile, in pixels

class Hand {
  size = 0; // bytes allocated by its instance
  private readonly held = new Map<number, Waiting>();
  private next = 0;
  constructor(private readonly worker: Worker, private readonly free: () => void) {
    worker.onmessage = ({ data }: MessageEvent): void => this.take(data as Reply);
  }
  get room(): boolean { return this.held.size < underWay; }
  give(waiting: Waiting): void {
    this.held.set(++this.next, waiting);
    this.worker.postMessage({ id: this.next, job: waiting.job });
  }
  private take(reply: Reply): void {
    const waiting = this.held.get(reply.id);
    this.held.delete(reply.id);
    this.size = reply.size ?? this.size;
    if (waiting && reply.answer) waiting.done(reply.answer);
    else if (waiting && reply.error) waiting.failed(new DoorError(reply.error.kind, reply.error.text));
    this.free();
  }
}

/** A queue without a worker: jobs in parts, one after another, each in an instance that no other job uses meanwhile. */
class Lane {
  readonly answering: Answering;
  queue: Waiting[] = [];
  private current: Waiting | undefined;
  constructor(module: WebAssembly.Module) { this.answering = new Answering(module); }

  get busy(): boolean { return this.current !== undefined || this.queue.length > 0; }
  drop(): void { this.queue = []; this.current = undefined; }

  /** Does one part of a job. Returns its work, in samples. */
  part(): number {
    const fresh = this.current === undefined, waiting = (this.current ??= this.queue.shift()!);
    try {
      const answer = fresh ? this.answering.begin(waiting.job) : this.answering.goOn();
      if (!answer) return this.answering.worked;
      this.current = undefined;
      waiting.done(answer);
    } catch (error) {
      this.current = undefined;
      const { kind, text } = failure(error);
      waiting.failed(new DoorError(kind, text));
    }
    return this.answering.worked;
  }
}

export class Pool {
  private hands: Hand[] = [];
  private alone: { lasting: Lane; passing: Lane } | undefined; // an opening in between does not break a lasting request
  private queue: Waiting[] = [];
  private kept: Kept = new Map();
  private opened: Opening | undefined;
  private era = 0;
  private slicing = false;
  private settled = false;
  readonly ready: Promise<void>; // resolved once it is known whether there are workers: requests wait for it

  /** `source`: the worker's script. */
  constructor(module: WebAssembly.Module, source: string, count: number, private readonly turns: Turns) {
    const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    this.ready = Promise.all(Array.from({ length: count }, () => this.startOne(module, url))).then((started) => {
      URL.revokeObjectURL(url);
      if (!started.some(Boolean)) {
        this.alone = { lasting: new Lane(module), passing: new Lane(module) };
        if (this.opened) this.alone.passing.answering.about(this.opened);
      }
      this.settled = true;
    });
  }

  private startOne(module: WebAssembly.Module, url: string): Promise<boolean> {
    return new Promise((resolve) => {
      const late = setTimeout(() => resolve(false), 4000);
      const settle = (good: boolean): void => { clearTimeout(late); resolve(good); };
      try {
        const worker = new Worker(url);
        worker.onerror = (event): void => { event.preventDefault(); settle(false); };
        worker.onmessage = (): void => {
          const hand = new Hand(worker, () => this.pump());
          if (this.opened) this.openIn(hand, this.opened);
          this.hands.push(hand);
          settle(true);
        };
        worker.postMessage(module);
      } catch {
        settle(false);
      }
    });
  }

  /** The number of workers; 0: slices of the page's own thread. */
  get workers(): number { return this.hands.length; }

  /** Drops all requests except lasting ones. */
  cancel(): void {
    ++this.era;
    this.queue = this.queue.filter((waiting) => waiting.lasting);
    this.alone?.passing.drop();
  }

  /** Bytes allocated by the instances of all workers; the largest part done without workers, in samples. */
  get size(): number { return this.hands.reduce((sum, hand) => sum + hand.size, 0); }
  get most(): number { return Math.max(this.alone?.lasting.answering.most ?? 0, this.alone?.passing.answering.most ?? 0); }

  /** Every instance opens this experiment; earlier requests are dropped. */
  open(opening: Opening): void {
    this.cancel();
    this.opened = opening;
    if (this.alone) { this.alone.passing.answering.about(opening); return; } // opened by the first job that needs it
    this.kept.clear();
    for (const hand of this.hands) this.openIn(hand, opening);
  }
  private openIn(hand: Hand, opening: Opening): void { // what they reject is rejected on the page's own thread too
    hand.give({ job: { kind: "open", opening }, lasting: true, done: () => {}, failed: () => {} });
  }

  /** `lasting`: the request survives other openings, and comes before all others. */
  async ask(job: Job, lasting = false): Promise<Answer> {
    const era = this.era;
    if (!this.settled) await this.ready;
    return new Promise((resolve, reject) => {
      const here = (): boolean => lasting || era === this.era;
      const waiting: Waiting = { job, lasting, done: (a) => here() && resolve(a), failed: (e) => here() && reject(e) };
      const queue = this.alone ? this.alone[lasting ? "lasting" : "passing"].queue : this.queue;
      if (lasting) queue.unshift(waiting);
      else queue.push(waiting);
      this.pump();
    });
  }

  /** The picture cut into boxes, one per job. `cost`: samples per pixel. A job has at most `most` samples, or in a worker
   *  twenty times as many, because a new setting has to wait for running jobs. */
  tiles(width: number, height: number, cost: number, most: number): Box[] {
    const pixels = Math.max(1, Math.floor((this.alone ? most : 20 * most) / cost));
    const across = Math.min(side, pixels), up = Math.max(1, Math.min(side, Math.floor(pixels / across)));
    const all: Box[] = [];
    for (let y0 = 0; y0 < height; y0 += up)
      for (let x0 = 0; x0 < width; x0 += across)
        all.push({ x0, y0, x1: Math.min(x0 + across, width), y1: Math.min(y0 + up, height) });
    const far = (b: Box): number => Math.hypot(b.x0 + b.x1 - width, (b.y0 + b.y1 - height) * 1.5);
    return all.sort((a, b) => far(a) - far(b));
  }

  private pump(): void {
    if (this.alone) {
      void this.slices();
      return;
    }
    for (let hand = this.next(); hand && this.queue.length > 0; hand = this.next()) hand.give(this.nextFor(hand));
  }
  /** The next job for a worker: a box whose points it holds already, else one that no worker holds, else one of another
   *  worker. */
  private nextFor(hand: Hand): Waiting {
    const good = (waiting: Waiting): boolean => [hand, undefined].includes(this.kept.get(boxOf(waiting)));
    const [waiting] = this.queue.splice(Math.max(0, this.queue.findIndex(good)), 1);
    if (waiting!.job.kind === "tile") this.kept.set(boxOf(waiting!), hand);
    return waiting!;
  }
  private next(): Hand | undefined { return this.hands.find((hand) => hand.room); }

  /** Runs parts of jobs, as many in each turn as it has room for. */
  private async slices(): Promise<void> {
    if (this.slicing) return;
    this.slicing = true;
    const { lasting, passing } = this.alone!, info = document.documentElement.dataset;
    while (lasting.busy || passing.busy) {
      await this.turns.pass();
      if (lasting.busy || passing.busy) this.turns.count((lasting.busy ? lasting : passing).part());
      info["part"] = String(this.most);
    }
    this.slicing = false;
  }
}
