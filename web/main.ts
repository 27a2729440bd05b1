// Unpacks the module and starts the page; a browser that cannot run it is told so.
import { byId, el } from "./dom";
import { Data, Page } from "./page";

declare const DecompressionStream: new (format: "gzip") => ReadableWritablePair<Uint8Array, Uint8Array>;

async function main(): Promise<void> {
  const words = (id: string): string => byId(id).textContent ?? "";
  try {
    const packed = Uint8Array.from(atob(words("module")), (c) => c.charCodeAt(0));
    const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const module = await WebAssembly.compile(await new Response(unpacked).arrayBuffer());
    await new Page(JSON.parse(words("data")) as Data).start(module, words("worker"));
  } catch (error) {
    byId("wrong").replaceChildren(el("p", {}, `This browser cannot run the kernels (${error instanceof Error ? error.message : error}). It must know WebAssembly with 128-bit vectors: any browser since 2023 does.`));
  }
}
void main();
