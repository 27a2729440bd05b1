// Text compressed for the address: deflate, then base64 with the letters that an address may have.
declare const CompressionStream: new (format: "deflate-raw") => ReadableWritablePair<Uint8Array, Uint8Array>;
declare const DecompressionStream: new (format: "deflate-raw") => ReadableWritablePair<Uint8Array, Uint8Array>;

const through = async (bytes: Uint8Array, stream: ReadableWritablePair<Uint8Array, Uint8Array>): Promise<Uint8Array> =>
  new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());

export async function packed(text: string): Promise<string> {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** Throws if it is not such a text. */
export async function unpacked(words: string): Promise<string> {
  const plain = atob(words.replaceAll("-", "+").replaceAll("_", "/"));
  return new TextDecoder().decode(await through(Uint8Array.from(plain, (c) => c.charCodeAt(0)), new DecompressionStream("deflate-raw")));
}
