// Unpacks the module and starts the page; a browser that cannot run it shows a message.
import { byId, el, newTask } from "./dom";
import { Data, Page } from "./page";

declare const DecompressionStream: new (format: "gzip") => ReadableWritablePair<Uint8Array, Uint8Array>;

/** Decodes base64. */
function bytesOf(base64: string): Uint8Array {
  const { fromBase64 } = Uint8Array as unknown as { fromBase64?: (words: string) => Uint8Array }; // of 2025, ten times as fast
  if (fromBase64) return fromBase64.call(Uint8Array, base64);
  const plain = atob(base64), bytes = new Uint8Array(plain.length);
  for (let k = 0; k < bytes.length; ++k) bytes[k] = plain.charCodeAt(k);
  return bytes;
}

/** A task of its own for each piece: one of all bytes blocks the page for 20 ms. */
function inPieces(bytes: Uint8Array, size = 1 << 17): ReadableStream<Uint8Array> {
  let from = 0;
  return new ReadableStream({
    async pull(to): Promise<void> {
      if (from > 0) await newTask();
      to.enqueue(bytes.subarray(from, (from += size)));
      if (from >= bytes.length) to.close();
    },
  });
}

/** Compiles while it unpacks. */
function compiled(base64: string): Promise<WebAssembly.Module> {
  const unpacked = inPieces(bytesOf(base64)).pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compileStreaming(new Response(unpacked, { headers: { "Content-Type": "application/wasm" } }));
}

async function main(): Promise<void> {
  const words = (id: string): string => byId(id).textContent ?? "";
  try {
    const page = new Page(JSON.parse(words("data")) as Data);
    await newTask();
    await page.start(compiled(words("module")), words("worker"));
  } catch (error) {
    byId("wrong").replaceChildren(el("p", {}, `This browser cannot run the kernels (${error instanceof Error ? error.message : error}). It must know WebAssembly with 128-bit vectors: any browser since 2023 does.`));
  }
}
void main();
