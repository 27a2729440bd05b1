// One instance of the WebAssembly module, as apps/web/api.h describes it. All computation happens in the module.

/** The kinds of error: "input" is the user's mistake, "user" one in the user's sampler; "memory" and "bug" are not. */
export class EngineError extends Error {
  /** `lines`: places in the script of a worker, line and column, of an error in the user's sampler. */
  constructor(readonly kind: string, text: string, readonly lines?: [number, number][]) {
    super(text);
  }

  /** The error and the next step. */
  get sentence(): string {
    if (this.kind === "memory") return "There is not enough memory for this scene here. Choose a smaller image or fewer arms, or run the command below.";
    if (this.kind === "input") return `This cannot be: ${this.message}.`;
    return `The kernels stopped: ${this.message}. Reload the page; the address holds your settings.`;
  }
}

export interface Box { x0: number; y0: number; x1: number; y1: number }
export const pixelsOf = (b: Box): number => (b.x1 - b.x0) * (b.y1 - b.y0);

export type Call = (...numbers: number[]) => number | Promise<number>;
type Export = (...numbers: number[]) => number;
const text = new TextDecoder();

/** The part of WASI that the C++ library needs: no files, no real clock, no input. */
function wasi(memory: () => WebAssembly.Memory): Record<string, Call> {
  const nothing: Call = () => 52; // ENOSYS
  const sized: Call = (count, size) => {
    const view = new DataView(memory().buffer);
    view.setUint32(count ?? 0, 0, true);
    view.setUint32(size ?? 0, 0, true);
    return 0;
  };
  const known: Record<string, Call> = {
    environ_sizes_get: sized,
    environ_get: () => 0,
    clock_time_get: (_id, _precision, at) => {
      new DataView(memory().buffer).setBigUint64(at ?? 0, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    proc_exit: () => {
      throw new EngineError("bug", "the kernels stopped");
    },
  };
  return new Proxy(known, { get: (all, name) => all[String(name)] ?? nothing, has: () => true });
}

/** What the module calls of the user's sampler, apps/web/user_sampler.cpp and user_points.cpp. `suspends`: the calls answer later, and the
 *  module waits for them (JSPI). */
export type UserCalls = ((memory: () => WebAssembly.Memory) => typeof noCalls) & { suspends?: boolean };
/** What TypeScript's library does not have. */
const suspension = WebAssembly as unknown as { Suspending: new (call: Call) => Call; promising(call: Export): (...numbers: number[]) => Promise<number> };
const none: Call = () => { throw new EngineError("bug", "there is no sampler of the user here"); };
export const noCalls = { user_sample: none, user_pdf: none, point_drawn: none, point_value: none };

export class Api {
  private readonly calls: Record<string, Export>;
  private readonly suspends: boolean;
  private readonly memory: WebAssembly.Memory;

  constructor(module: WebAssembly.Module, user: UserCalls = () => noCalls) {
    const memory = (): WebAssembly.Memory => this.memory;
    const failed = (kind: number, kindSize: number, at: number, size: number): never => {
      throw new EngineError(this.words(kind, kindSize), this.words(at, size));
    };
    const system = wasi(memory);
    this.suspends = user.suspends ?? false;
    const given = Object.entries(user(memory)).map(([name, call]) => [name, this.suspends ? new suspension.Suspending(call) : call] as const);
    const imports: WebAssembly.Imports = { api: { failed, ...Object.fromEntries(given) }, wasi_snapshot_preview1: {} };
    for (const { module: from, name } of WebAssembly.Module.imports(module))
      if (from === "wasi_snapshot_preview1") imports[from]![name] = system[name]!;
    const instance = new WebAssembly.Instance(module, imports);
    this.calls = instance.exports as unknown as Record<string, Export>;
    this.memory = instance.exports["memory"] as WebAssembly.Memory;
    this.calls["_initialize"]!();
  }

  /** Bytes of memory of the instance. */
  get size(): number { return this.memory.buffer.byteLength; }

  private words(at: number, size: number): string {
    return text.decode(new Uint8Array(this.memory.buffer, at, size));
  }

  /** A call that takes and returns numbers. A trap becomes an error with a message. */
  number(name: string, ...given: number[]): number {
    try {
      return this.calls[name]!(...given);
    } catch (error) {
      throw Api.fault(error);
    }
  }
  private static fault(error: unknown): EngineError {
    if (error instanceof EngineError) return error;
    const full = error instanceof RangeError || /memory|unreachable/.test(String(error));
    return new EngineError(full ? "memory" : "bug", String(error));
  }

  /** The same for a call that may reach the user's sampler. One at a time. */
  private async later(name: string, ...given: number[]): Promise<number> {
    if (!this.suspends) return this.number(name, ...given);
    try {
      return await suspension.promising(this.calls[name]!)(...given);
    } catch (error) {
      throw Api.fault(error);
    }
  }

  private request(request: unknown): void {
    const bytes = new TextEncoder().encode(JSON.stringify(request));
    const at = this.number("request_buffer", bytes.length);
    new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
  }

  /** A call that returns text. */
  say(name: string, request?: unknown, ...given: number[]): string {
    if (request !== undefined) this.request(request);
    this.number(name, ...given);
    return this.words(this.number("response_data"), this.number("response_size"));
  }

  /** Of a call that may reach the user's sampler. */
  async sayLater(name: string, request?: unknown, ...given: number[]): Promise<string> {
    if (request !== undefined) this.request(request);
    await this.later(name, ...given);
    return this.words(this.number("response_data"), this.number("response_size"));
  }
  async jsonLater(name: string, request?: unknown, ...given: number[]): Promise<unknown> {
    return JSON.parse(await this.sayLater(name, request, ...given));
  }
  async bytesLater(name: string, size: number, ...given: number[]): Promise<ArrayBuffer> {
    const at = await this.later(name, ...given);
    return this.memory.buffer.slice(at, at + size);
  }

  json<T>(name: string, request?: unknown, ...given: number[]): T {
    return JSON.parse(this.say(name, request, ...given)) as T;
  }

  /** A call that returns bytes: a copy of them, which may be transferred. */
  bytes(name: string, size: number, ...given: number[]): ArrayBuffer {
    const at = this.number(name, ...given);
    return this.memory.buffer.slice(at, at + size);
  }

  /** Copies bytes into the module, for the next call. */
  give(bytes: ArrayBuffer): void {
    const at = this.number("tile_buffer", bytes.byteLength);
    new Uint8Array(this.memory.buffer, at, bytes.byteLength).set(new Uint8Array(bytes));
  }
}
