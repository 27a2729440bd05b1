// A user's sampler in WGSL: a file for `crescent check FILE.wgsl`, whose comments `// crescent: KEY = VALUE` have the
// snippets. The text around them is that of the program (python/crescent_shader), in shader_text.json. It is evaluated by
// WebGPU, whose answers come later: the module waits for them (JSPI).
import { Call, EngineError, noCalls, UserCalls } from "./api";
import texts from "./shader_text.json";

interface Line { text: string; number: number } // of the file, from 1; 0: a line of the page
interface Operation { columns_in: number; columns_out: number; lines: string[]; context: Record<string, string> }
interface Shader { code: string; sample: Line[]; pdf: Line[]; set: [string, string][]; let: Line[]; numbers: number; uses: string[] }

const comment = /^(\s*\/\/\s*crescent:)(.*)$/, keys = ["sample", "pdf", "set", "let", "numbers", "uses"];
const without = ["f", "f-cos", "name"]; // the page has those of the surface, and another name
const names = Object.keys(texts.context), columnsOfContext = Object.values(texts.context).reduce((sum, n) => sum + n, 0);
const mostRows = 1 << 16;

/** Whether this is WGSL and not JavaScript. */
export const isShader = (code: string): boolean => code.split("\n").some((line) => comment.test(line));

/** What this browser lacks for WGSL; "" if nothing is known to be missing. */
export function missingForShaders(): string {
  if (!(globalThis.navigator as { gpu?: unknown } | undefined)?.gpu) return "this browser has no WebGPU";
  return "Suspending" in WebAssembly ? "" : "this browser cannot suspend WebAssembly (JSPI)";
}

const fault = (text: string, line = 0, column = 1): EngineError => new EngineError("user", text, line > 0 ? [[line, column]] : []);

// ---- The text.

const plain = (text: string): string => text.replace(/\/\/[^\n]*|\/\*[^]*?\*\//g, (all) => all.replace(/[^\n]/g, " "));
const assigns = (lines: readonly Line[], name: string): boolean => new RegExp(`(?<![\\w.])${name}\\b(?!\\s*\\()`).test(plain(textOf(lines)));
const textOf = (lines: readonly Line[]): string => lines.map(({ text }) => text).join("\n");

/** The keys of the comments. Throws EngineError with the line. */
export function readShader(code: string): Shader {
  const out: Shader = { code, sample: [], pdf: [], set: [], let: [], numbers: 2, uses: [] };
  code.split("\n").forEach((line, k) => {
    const found = comment.exec(line), number = k + 1;
    if (!found) return;
    const [, head, rest] = found as unknown as [string, string, string], equals = rest.indexOf("="), key = rest.slice(0, equals).trim();
    const value = rest.slice(equals + 1), first = value.length - value.trimStart().length, text = " ".repeat(head.length + equals + 1) + value;
    if (equals < 0 || !value.trim()) throw fault("expected '// crescent: KEY = VALUE'", number);
    if (without.includes(key)) return;
    if (!keys.includes(key)) throw fault(`the page has no key '${key}': expected one of ${keys.join(", ")}; crescent check has the others`, number);
    if (key === "sample") out.sample.push({ text, number });
    else if (key === "let") out.let.push({ text: closed(text), number });
    else if (key === "pdf" && out.pdf.length > 0) throw fault("the key 'pdf' is given twice", number);
    else if (key === "pdf") out.pdf.push({ text, number });
    else if (key === "set") {
      const [name, given] = value.trim().split(/\s*=\s*/) as [string, string | undefined];
      if (!/^[A-Za-z_]\w*$/.test(name) || !/^([-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|true|false)$/.test(given ?? "")) throw fault("expected NAME=VALUE with 0.3, 3 or true", number, head.length + equals + first + 2);
      if (new RegExp(`\\boverride\\s+${name}\\b`).test(plain(code))) throw fault(`'${name}' is an override: the page sets constants of the snippets alone, crescent check overrides too`, number);
      out.set.push([name, given!]);
    } else if (key === "numbers") {
      out.numbers = Number(value);
      if (!(Number.isInteger(out.numbers) && out.numbers >= 1 && out.numbers <= texts.numbers)) throw fault(`numbers: expected 1 to ${texts.numbers}`, number);
    } else {
      out.uses = value.split(",").map((name) => name.trim());
      for (const name of out.uses) if (!names.includes(name)) throw fault(`uses: expected names from ${names.join(", ")}, not '${name}'`, number);
    }
  });
  if (out.sample.length === 0) throw fault("expected a line '// crescent: sample = STATEMENTS' that assign wi");
  if (out.pdf.length === 0) throw fault("expected a line '// crescent: pdf = EXPRESSION', the density of wi");
  return out;
}

/** Statements with the last semicolon. */
function closed(text: string): string {
  const code = plain(text).trimEnd();
  return code === "" || /[;}]$/.test(code) ? text : `${text.slice(0, code.length)};${text.slice(code.length)}`;
}
const closedLines = (lines: readonly Line[]): Line[] => lines.map((line, k) => (k + 1 < lines.length ? line : { ...line, text: closed(line.text) }));

/** The statements that assign pdf: those of the snippet, or its value. */
function pdfLines(lines: readonly Line[]): Line[] {
  const text = plain(textOf(lines));
  if (text.includes(";") || /(?<![\w.])pdf\s*=[^=]/.test(text)) return closedLines(lines);
  const { number } = lines[0]!;
  return [{ text: "    pdf = (", number }, ...lines, { text: "    );", number }];
}

/** The module of one operation, each line with its place. */
export function moduleOf(shader: Shader, operation: "sample" | "pdf"): { lines: Line[]; columns_in: number; columns_out: number } {
  const form: Operation = operation === "pdf" ? texts.pdf : assigns(shader.sample, "pdf") ? texts.sample_with_pdf : texts.sample;
  const made = (text: string): Line => ({ text, number: 0 });
  const parts: Record<string, () => Line[]> = {
    "<file>": () => shader.code.split("\n").map((text, k) => ({ text, number: k + 1 })),
    "<let>": () => [...shader.uses.map((name) => made(form.context[name]!)), ...shader.set.map(([name, value]) => made(`const ${name} = ${value};`)), ...shader.let],
    "<sample>": () => closedLines(shader.sample),
    "<pdf>": () => pdfLines(shader.pdf),
  };
  return { ...form, lines: form.lines.flatMap((line) => parts[line]?.() ?? [made(line)]) };
}

// ---- The device. What is used of WebGPU, which TypeScript's library does not have.

interface Buffer { mapAsync(mode: number): Promise<void>; getMappedRange(from: number, size: number): ArrayBuffer; unmap(): void }
interface Pass { setPipeline(p: unknown): void; setBindGroup(at: number, group: unknown): void; dispatchWorkgroups(n: number): void; end(): void }
interface Encoder { beginComputePass(): Pass; copyBufferToBuffer(from: Buffer, at: number, to: Buffer, to_at: number, size: number): void; finish(): unknown }
interface Message { type: string; message: string; lineNum: number; linePos: number }
interface Device {
  createBuffer(d: { size: number; usage: number }): Buffer;
  createBindGroupLayout(d: unknown): unknown; createBindGroup(d: unknown): unknown; createPipelineLayout(d: unknown): unknown;
  createShaderModule(d: { code: string }): { getCompilationInfo(): Promise<{ messages: Message[] }> };
  createComputePipelineAsync(d: unknown): Promise<unknown>;
  createCommandEncoder(): Encoder;
  pushErrorScope(filter: string): void; popErrorScope(): Promise<unknown>;
  queue: { writeBuffer(to: Buffer, at: number, data: Float32Array): void; submit(all: unknown[]): void };
}
interface Gpu { requestAdapter(): Promise<{ requestDevice(): Promise<Device> } | null> }
const usage = { read: 1, copyFrom: 4, copyTo: 8, storage: 128 }, compute = 4, forReading = 1; // GPUBufferUsage, GPUShaderStage, GPUMapMode

type Evaluate = (rows: Float32Array) => Promise<Float32Array>;

async function evaluator(device: Device, shader: Shader, operation: "sample" | "pdf"): Promise<Evaluate> {
  const { lines, columns_in, columns_out } = moduleOf(shader, operation);
  device.pushErrorScope("validation"); // else the console has a mistake of the user's too
  const module = device.createShaderModule({ code: textOf(lines) });
  await device.popErrorScope();
  const [error] = (await module.getCompilationInfo()).messages.filter(({ type }) => type === "error");
  if (error) throw fault(error.message, lines[error.lineNum - 1]?.number ?? 0, error.linePos);
  const made = (columns: number, how: number): Buffer => device.createBuffer({ size: 4 * mostRows * columns, usage: how });
  const given = made(columns_in, usage.storage | usage.copyTo), answer = made(columns_out, usage.storage | usage.copyFrom), back = made(columns_out, usage.read | usage.copyTo);
  const layout = device.createBindGroupLayout({ entries: [[texts.in, "read-only-storage"], [texts.out, "storage"]].map(([binding, type]) => ({ binding, visibility: compute, buffer: { type } })) });
  const empty = device.createBindGroupLayout({ entries: [] }), before = Array.from({ length: texts.set }, () => empty);
  const group = device.createBindGroup({ layout, entries: [[texts.in, given], [texts.out, answer]].map(([binding, buffer]) => ({ binding, resource: { buffer } })) });
  const nothing = device.createBindGroup({ layout: empty, entries: [] });
  let pipeline: unknown;
  try {
    pipeline = await device.createComputePipelineAsync({ layout: device.createPipelineLayout({ bindGroupLayouts: [...before, layout] }), compute: { module, entryPoint: "crescent_main" } });
  } catch (error) {
    throw fault(error instanceof Error ? error.message : String(error));
  }
  const evaluated = async (rows: Float32Array): Promise<Float32Array> => {
    const count = rows.length / columns_in, bytes = 4 * count * columns_out;
    device.queue.writeBuffer(given, 0, rows);
    const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    before.forEach((_, k) => pass.setBindGroup(k, nothing));
    pass.setBindGroup(texts.set, group);
    pass.dispatchWorkgroups(Math.ceil(count / texts.rows_in_group));
    pass.end();
    encoder.copyBufferToBuffer(answer, 0, back, 0, bytes);
    device.queue.submit([encoder.finish()]);
    try {
      await back.mapAsync(forReading);
    } catch (error) {
      throw fault(`the graphics processor did not answer (${error instanceof Error ? error.message : error}): does a loop never end?`);
    }
    const out = new Float32Array(back.getMappedRange(0, bytes).slice(0));
    back.unmap();
    return out;
  };
  return async (rows) => {
    const out = new Float32Array((rows.length / columns_in) * columns_out);
    for (let at = 0; at < rows.length; at += mostRows * columns_in)
      out.set(await evaluated(rows.subarray(at, at + mostRows * columns_in)), (at / columns_in) * columns_out);
    return out;
  };
}

/** The calls of a file: rows in single precision. Throws EngineError with the line. */
export async function openedShader(code: string, proceeds: () => void): Promise<{ calls: UserCalls; numbers: number; context: boolean; bits: number }> {
  const shader = readShader(code), lacks = missingForShaders();
  if (lacks) throw fault(`WGSL cannot run here: ${lacks}`);
  const adapter = await (navigator as unknown as { gpu: Gpu }).gpu.requestAdapter();
  if (!adapter) throw fault("WGSL cannot run here: WebGPU has no adapter in this browser");
  const device = await adapter.requestDevice(), sample = await evaluator(device, shader, "sample"), pdf = await evaluator(device, shader, "pdf");
  const context = shader.uses.length > 0;
  const calls: UserCalls = (memory) => {
    const doubles = (at: number, count: number): Float64Array => new Float64Array(memory().buffer, at, count);
    const user_sample: Call = async (runsAt, count, stride, uAt, numbers, wiAt, pdfAt) => {
      const runs = doubles(runsAt!, count! * stride!), columns = texts.sample.columns_in;
      let total = 0;
      for (let k = 0; k < count!; ++k) total += runs[k * stride! + 3]!;
      const u = doubles(uAt!, total * numbers!), rows = new Float32Array(total * columns);
      for (let k = 0, i = 0; k < count!; ++k) {
        const run = k * stride!;
        for (const end = i + runs[run + 3]!; i < end; ++i) {
          rows.set(runs.subarray(run, run + 3), i * columns);
          rows.set(u.subarray(i * numbers!, (i + 1) * numbers!), i * columns + 3);
          if (context) rows.set(runs.subarray(run + 4, run + 4 + columnsOfContext), i * columns + 3 + texts.numbers);
        }
      }
      proceeds();
      const out = await sample(rows), wi = doubles(wiAt!, 3 * total), p = doubles(pdfAt!, total);
      for (let i = 0; i < total; ++i) {
        wi.set(out.subarray(4 * i, 4 * i + 3), 3 * i);
        p[i] = out[4 * i + 3]!;
      }
      return 0;
    };
    const user_pdf: Call = async (pairsAt, count, contextAt, columns, outAt) => {
      const pairs = doubles(pairsAt!, 6 * count!), wide = texts.pdf.columns_in, rows = new Float32Array(count! * wide);
      const surface = context && columns! >= columnsOfContext ? doubles(contextAt!, columnsOfContext) : new Float64Array(columnsOfContext);
      for (let i = 0; i < count!; ++i) {
        rows.set(pairs.subarray(6 * i, 6 * i + 6), i * wide);
        rows.set(surface, i * wide + 6);
      }
      proceeds();
      const out = await pdf(rows);
      doubles(outAt!, count!).set(out);
      return 0;
    };
    return { ...noCalls, user_sample, user_pdf };
  };
  calls.suspends = true;
  return { calls, numbers: shader.numbers, context, bits: 24 };
}
