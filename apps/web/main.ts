// Unpacks the module and starts the page; a browser that cannot run it shows a message.
import { byId, el } from "./dom";
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

async function main(): Promise<void> {
  const words = (id: string): string => byId(id).textContent ?? "";
  try {
    const packed = bytesOf(words("module"));
    const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const module = await WebAssembly.compile(await new Response(unpacked).arrayBuffer());
    new Page(JSON.parse(words("data")) as Data).start(module, words("worker"));
  } catch (error) {
    byId("wrong").replaceChildren(el("p", {}, `This browser cannot run the kernels (${error instanceof Error ? error.message : error}). It must know WebAssembly with 128-bit vectors: any browser since 2023 does.`));
  }
}
void main();
