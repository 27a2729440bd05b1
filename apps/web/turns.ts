// Turns of the page's own thread: the work between two checks for input. A turn ends after a limit of work, which the
// core counts in samples (apps/web/parts.h), or of milliseconds, whichever comes first.

const mostMs = 4; // the last task of a turn ends within the 10 that a user may wait
const mostParts = 4; // of apps/web/parts.h
const bins = 64; // ms

export class Turns {
  private largest = 0; // work of a turn so far, read by the tests
  /** How many turns took this many ms; the last bin has the longer ones. */
  private readonly took = new Array<number>(bins).fill(0);
  private work = 0;
  private promised = 0; // to those whom pass() released in this turn, who have not counted yet: a part each
  private since = 0;
  private open = false;
  private readonly waiting: (() => void)[] = [];
  private readonly channel = new MessageChannel(); // setTimeout waits for 4 ms when called repeatedly

  /** `part`: the largest work of one part, in samples. */
  constructor(private readonly part: number) {
    this.channel.port1.onmessage = (): void => this.next();
  }

  private begin(): void {
    if (this.open) return;
    this.open = true;
    this.work = this.promised = 0;
    this.since = performance.now();
    this.channel.port2.postMessage(0);
  }

  /** Ends a turn; the next one belongs to the task that has waited longest. */
  private next(): void {
    if (this.work > this.largest) document.documentElement.dataset["turn"] = String((this.largest = this.work));
    this.took[Math.min(bins - 1, Math.floor(performance.now() - this.since))]!++;
    this.open = false;
    const go = this.waiting.shift();
    if (!go) return;
    this.begin();
    go();
  }

  /** The work done in this turn. */
  count(work: number): void {
    this.begin();
    this.work += work;
    this.promised = Math.max(0, this.promised - this.part);
  }

  /** Continues in this turn if it has room, else in one of the next. */
  async pass(): Promise<void> {
    this.begin();
    while (this.work + this.promised >= mostParts * this.part || performance.now() - this.since >= mostMs)
      await new Promise<void>((go) => this.waiting.push(go));
    this.promised += this.part;
  }

  /** The smallest number of ms within which this share of the turns ended. */
  within(share: number): number {
    const all = this.took.reduce((sum, count) => sum + count, 0);
    let sum = 0;
    return this.took.findIndex((count) => (sum += count) >= share * all) + 1;
  }
}
