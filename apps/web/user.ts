// The user's sampler in a worker: its functions, called for many rows of the module's memory, or for one point of a domain.
// The page puts the code behind the script of the worker, as the argument of crescentUser (apps/web/pool.ts).
import { Call, EngineError, noCalls, UserCalls } from "./api";
import { directions } from "./domains";
import { openedShader } from "./wgsl";

type Vector = [number, number, number];
interface Light { kind: string; radius: number; radiance: Vector; position: Vector; normal: Vector; edge_u: Vector; edge_v: Vector; shines: boolean }
interface Context { s: number; alpha: number; rho_d: Vector; rho_s: number; lights: Light[] }
type Drawn = { wi: ArrayLike<number>; pdf: number } | null | undefined;
interface Functions {
  sample?: (wo: Vector, u: number[], context?: Context) => Drawn;
  pdf?: (wo: Vector, wi: Vector, context?: Context) => number;
  numbers?: unknown;
  domain?: string; // that the code declares; of points, in place of these functions, Points
  f?: unknown;
  wgsl?: string; // in their place: a file of WGSL
}
type Point = number | number[]; // a number where there is one coordinate
interface Points {
  sample: (u: number[]) => { x: Point; pdf: number } | null | undefined;
  pdf: (x: Point) => number;
  f?: (x: Point) => number;
}
/** `bits`: of the answers' precision. `points`: the domain, if it is not of directions, and whether there is an integrand. */
export interface UserSampler { calls: UserCalls; numbers: number; context: boolean; bits: number; points?: { domain: string; integrand: boolean } }

const kinds = ["disk", "sphere", "rectangle"];

/** The context of a surface point: the columns of apps/web/user_sampler.cpp from `at`. */
function contextAt(row: Float64Array, at: number): Context {
  const vector = (from: number): Vector => [row[from]!, row[from + 1]!, row[from + 2]!];
  const lights: Light[] = [];
  for (let k = 0; k < row[at + 6]!; ++k) {
    const from = at + 7 + 18 * k;
    lights.push({
      kind: kinds[row[from]!] ?? "light", radius: row[from + 1]!, radiance: vector(from + 2), position: vector(from + 5), normal: vector(from + 8),
      edge_u: vector(from + 11), edge_v: vector(from + 14), shines: row[from + 17] === 1,
    });
  }
  return { s: row[at]!, alpha: row[at + 1]!, rho_d: vector(at + 2), rho_s: row[at + 5]!, lights };
}

/** The places of an error in scripts, line and column, the innermost first. */
function placesOf(error: unknown): [number, number][] {
  const stack = error instanceof Error ? error.stack ?? "" : "";
  return [...stack.matchAll(/:(\d+):(\d+)\)?\s*$/gm)].map((m) => [Number(m[1]), Number(m[2])]);
}

function fault(error: unknown): EngineError {
  if (error instanceof EngineError) return error;
  return new EngineError("user", error instanceof Error ? `${error.name}: ${error.message}` : `it threw ${String(error)}`, placesOf(error));
}

function shown(value: unknown): string {
  try {
    return (JSON.stringify(value) ?? String(value)).slice(0, 60);
  } catch {
    return String(value).slice(0, 60);
  }
}

const wrongDraw = (d: unknown): EngineError => new EngineError("user", `sample returned ${shown(d)}; expected { wi: [x, y, z], pdf: number }, or null where nothing is drawn`);
const wrongPdf = (p: unknown): EngineError => new EngineError("user", `pdf returned ${shown(p)}; expected a number`);

/** The user's functions are about to be called once more: those called before have returned. */
export type Proceeds = () => void;

/** One point at a time. */
function callsOfPoints({ sample, pdf, f }: Points, proceeds: Proceeds): UserCalls {
  return (memory) => {
    const doubles = (at: number, count: number): Float64Array => new Float64Array(memory().buffer, at, count);
    const point_drawn: Call = (uAt, numbers, xAt, coordinates) => {
      proceeds();
      try {
        const drawn = sample(Array.from(doubles(uAt!, numbers!)));
        if (drawn === null) return 0;
        const x = typeof drawn?.x === "number" ? [drawn.x] : drawn?.x ?? [];
        if (typeof drawn?.pdf !== "number" || x.length !== coordinates || !Array.prototype.every.call(x, (one) => typeof one === "number"))
          throw new EngineError("user", `sample returned ${shown(drawn)}; expected { x: ${coordinates === 1 ? "a number" : `${coordinates} numbers`}, pdf: number }, or null where nothing is drawn`);
        doubles(xAt!, coordinates!).set(x);
        return drawn.pdf;
      } catch (error) {
        throw fault(error);
      }
    };
    const point_value: Call = (integrand, xAt, coordinates) => {
      proceeds();
      try {
        const x = doubles(xAt!, coordinates!), value = (integrand ? f! : pdf)(coordinates === 1 ? x[0]! : Array.from(x));
        if (typeof value !== "number") throw integrand ? new EngineError("user", `f returned ${shown(value)}; expected a number`) : wrongPdf(value);
        return value;
      } catch (error) {
        throw fault(error);
      }
    };
    return { ...noCalls, point_drawn, point_value };
  };
}

function callsOf(sample: NonNullable<Functions["sample"]>, pdf: NonNullable<Functions["pdf"]>, context: boolean, proceeds: Proceeds): UserCalls {
  return (memory) => {
    const doubles = (at: number, count: number): Float64Array => new Float64Array(memory().buffer, at, count);
    const user_sample: Call = (runsAt, count, stride, uAt, numbers, wiAt, pdfAt) => {
      try {
        const runs = doubles(runsAt!, count! * stride!);
        let rows = 0;
        for (let k = 0; k < count!; ++k) rows += runs[k * stride! + 3]!;
        const given = doubles(uAt!, rows * numbers!), wi = doubles(wiAt!, 3 * rows), p = doubles(pdfAt!, rows);
        const u = new Array<number>(numbers!).fill(0);
        for (let k = 0, i = 0; k < count!; ++k) {
          const run = k * stride!, wo: Vector = [runs[run]!, runs[run + 1]!, runs[run + 2]!];
          const third = context ? contextAt(runs, run + 4) : undefined;
          for (const end = i + runs[run + 3]!; i < end; ++i) {
            for (let n = 0; n < numbers!; ++n) u[n] = given[i * numbers! + n]!;
            proceeds();
            const d = sample(wo, u, third);
            if (d === null || d === undefined) {
              if (d === undefined) throw wrongDraw(d);
              wi[3 * i] = 0, wi[3 * i + 1] = 0, wi[3 * i + 2] = 1, p[i] = 0;
              continue;
            }
            const w = d.wi, value = d.pdf;
            if (typeof value !== "number" || w === undefined || w === null || typeof w[0] !== "number" || typeof w[1] !== "number" || typeof w[2] !== "number") throw wrongDraw(d);
            wi[3 * i] = w[0], wi[3 * i + 1] = w[1], wi[3 * i + 2] = w[2], p[i] = value;
          }
        }
        return 0;
      } catch (error) {
        throw fault(error);
      }
    };
    const user_pdf: Call = (pairsAt, count, contextAt_, columns, outAt) => {
      try {
        const pairs = doubles(pairsAt!, 6 * count!), out = doubles(outAt!, count!);
        const third = context && columns! > 0 ? contextAt(doubles(contextAt_!, columns!), 0) : undefined;
        for (let i = 0; i < count!; ++i) {
          proceeds();
          const at = 6 * i, value = pdf([pairs[at]!, pairs[at + 1]!, pairs[at + 2]!], [pairs[at + 3]!, pairs[at + 4]!, pairs[at + 5]!], third);
          if (typeof value !== "number") throw wrongPdf(value);
          out[i] = value;
        }
        return 0;
      } catch (error) {
        throw fault(error);
      }
    };
    return { ...noCalls, user_sample, user_pdf };
  };
}

/** Receives the user's code; the returned function gives its calls, undefined without code. Throws EngineError. */
export function userSampler(proceeds: Proceeds): () => UserSampler | Promise<UserSampler> | undefined {
  let functions: Functions | undefined, failed: EngineError | undefined;
  (self as unknown as { crescentUser: (make: () => Functions) => void }).crescentUser = (make) => {
    try {
      functions = make();
    } catch (error) {
      failed = fault(error);
    }
  };
  return () => {
    if (failed) throw failed;
    if (!functions) return undefined;
    const { sample, pdf, f, numbers = 2, domain = directions, wgsl } = functions, points = domain !== directions;
    if (wgsl !== undefined) return openedShader(wgsl, proceeds);
    if (!sample) throw new EngineError("user", `there is no function ${points ? "sample(u)" : "sample(wo, u)"}`);
    if (!pdf) throw new EngineError("user", `there is no function ${points ? "pdf(x)" : "pdf(wo, wi)"}`);
    if (typeof numbers !== "number" || !(numbers >= 1 && numbers <= 8 && Number.isInteger(numbers))) throw new EngineError("user", `numbers is ${shown(numbers)}; expected how many random numbers a sample takes, 1 to 8`);
    if (points) {
      const integrand = typeof f === "function";
      return { calls: callsOfPoints({ sample, pdf, ...(integrand ? { f } : {}) } as unknown as Points, proceeds), numbers, context: false, bits: 53, points: { domain, integrand } };
    }
    const context = sample.length > 2 || pdf.length > 2;
    return { calls: callsOf(sample, pdf, context, proceeds), numbers, context, bits: 53 };
  };
}
