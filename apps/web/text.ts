// Text that the core formats: an instance of the module on the page's own thread, which has no experiment and computes
// no picture.
import { Api } from "./api";

let core: Api;

export function startText(module: WebAssembly.Module): void { core = new Api(module); }

/** Words with formulas between dollar signs as HTML. */
export const html = (words: string): string => core.say("html", words);
/** A number for reading. */
export const figures = (x: number): string => core.say("figures", undefined, x);
/** The colours of a scale of maps as a row of pixels. */
export const scaleBar = (picture: number, width: number): ImageData =>
  new ImageData(new Uint8ClampedArray(core.bytes("scale_bar", 4 * width, picture, width)), width, 1);
/** The samplers that an arm may have. */
export const samplers = (): { name: string; label: string; summary: string }[] => core.json("samplers");
