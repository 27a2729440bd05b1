// Scenes of the user: packs that `crescent import` made, and an experiment that names them, dropped on the page or chosen.
// Nothing leaves the browser. Each worker gets the files with the first experiment that it opens of them.
import { EngineError } from "./api";
import { byId, download, el, Speaker } from "./dom";
import { Given, Opening } from "./jobs";
import { Described } from "./model";
import { Pool } from "./pool";
import { Source } from "./state";

const packs = /\.(mesh|image)$/, longest = 4 << 20; // bytes of an experiment, as in the program

export class OwnScenes {
  private held: Given["files"] = []; // of the last scene
  private count = 0;
  private readonly said = el("p", { class: "row-wrap" });

  constructor(root: HTMLElement, private readonly pool: Pool, private readonly speaker: Speaker, private readonly open: (name: string, source: Source) => void) {
    const input: HTMLInputElement = el("input", { type: "file", id: "own-files", multiple: true, accept: ".mesh,.image,.toml", onchange: () => {
      const files = [...(input.files ?? [])];
      input.value = ""; // so that the same files can be chosen again
      void this.take(files);
    } });
    const code = (text: string): HTMLElement => el("code", {}, text);
    root.append(
      el("p", {}, "Drop files anywhere on the page, or choose them here: meshes of up to 300,000 triangles and images that ", code("crescent import"), " packed (", code(".mesh"), ", ", code(".image"), "), and the experiment that names them (", code(".toml"), "). Without an experiment, one is made. The files stay in this browser."),
      el("label", { class: "file" }, "Choose files", input), this.said);
    const withFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
    window.addEventListener("dragover", (event) => { if (withFiles(event)) event.preventDefault(); });
    window.addEventListener("drop", (event) => {
      if (!withFiles(event)) return;
      event.preventDefault();
      void this.take([...event.dataTransfer!.files]);
    });
  }

  /** Opens what these files are, or says why not: then the page stays as it is. */
  private async take(files: File[]): Promise<void> {
    if (files.length === 0) return;
    const mine = ++this.count;
    byId("wrong").replaceChildren();
    this.speaker.say(`Reading ${files.map(({ name }) => name).join(", ")} …`);
    try {
      const [name, source] = await this.read(files);
      if (mine !== this.count) return;
      this.said.replaceChildren(el("b", {}, name), " is open. ",
        el("button", { type: "button", id: "save-own", onclick: () => download(name, source.text) }, `Save ${name}`));
      this.open(name, source);
    } catch (error) {
      if (mine !== this.count) return;
      const why = error instanceof EngineError && error.kind !== "input" ? error.sentence : `These files cannot be opened: ${error instanceof Error ? error.message : error}.`;
      byId("wrong").replaceChildren(...why.split("\n").map((line) => el("p", {}, line))); // a line for each mistake
      this.speaker.say("");
    }
  }

  private async read(files: File[]): Promise<[string, Source]> {
    const texts = files.filter(({ name }) => name.endsWith(".toml")), [toml] = texts, fresh = files.filter(({ name }) => packs.test(name));
    const other = files.find((file) => !texts.includes(file) && !fresh.includes(file));
    if (other) throw new EngineError("input", `${other.name}: expected packs (.mesh, .image) or an experiment (.toml); crescent import makes packs of models and of OpenEXR images`);
    if (texts.length > 1) throw new EngineError("input", `${texts.map(({ name }) => name).join(", ")}: expected one experiment at a time`);
    if (toml && toml.size > longest) throw new EngineError("input", `${toml.name}: expected an experiment file of at most 4 MiB, found more`);
    const earlier = toml ? this.held.filter(({ name }) => !fresh.some((file) => file.name === name)) : [];
    const given: Given = { key: `files ${this.count}`, files: [...earlier, ...fresh.map((file) => ({ name: file.name, bytes: file }))] };
    const name = toml?.name ?? `${(fresh.find((file) => file.name.endsWith(".mesh")) ?? fresh[0]!).name.replace(packs, "")}.toml`;
    const opening: Opening = { file: name, text: (await toml?.text()) ?? "", set: [], published: "", given };
    const { text, described: d } = (await this.pool.request({ kind: "look", opening }, true)).response as { text: string; described: Described };
    // Copies: a file that changes on the disk can no longer be read.
    given.files = await Promise.all(given.files.map(async (file) => ({ name: file.name, bytes: new Blob([await file.bytes.arrayBuffer()]) })));
    this.held = given.files;
    const arms = Object.fromEntries(d.arms.map((arm) => [arm.name, arm.n]));
    return [name, { file: name, title: `${d.title || name} (yours)`, text, published: "", arms, regions: d.regions, size: [d.width, d.height], reference: d.reference, films: {}, given }];
  }
}
