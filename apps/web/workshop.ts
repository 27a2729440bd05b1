// Where a sampler is written: the editor; its draws over its pdf; its film next to that of a built-in sampler, and their
// convergence; the verdicts of `check`. The code runs in workers of its own, which are ended when it changes or takes
// too long.
import { Box, EngineError } from "./api";
import { choice } from "./controls";
import { byId, copied, download, el, minus, newTask, plusMinus, Speaker } from "./dom";
import { Editor } from "./editor";
import { directions, domainOf } from "./domains";
import { exported, exports } from "./export";
import { FilmView } from "./film";
import { showLadders } from "./ladders";
import { Described, Model, Shown, Viewer } from "./model";
import { drawPoints, pointLayers, PointPicture } from "./points";
import { FilmWorker, Pool, withUser } from "./pool";
import { openingOf, Source } from "./state";
import { grounds } from "./templates";
import { samplers } from "./text";
import { isShader } from "./wgsl";
import { evaluations, four } from "./workshop_settings";

export interface Verdict {
  name: string; question: string; state: string; message: string; cause: string; theta: number; azimuth: number; states: string[]; found: string[];
}
export interface Checked { state: string; evaluations: number; verdicts: Verdict[] }
export interface Work { code: string; ground: string }

const size = 320, draws = 1024;
// ms without a sign that the code's functions return: at least these, and that many times what a worker took to start, so
// that a busy machine ends no code.
const longest = { film: 30_000, check: 60_000 }, startups = { film: 40, check: 80 };
const yours = "yours";
/** What a verdict speaks of, as a picture. */
const pictures: Record<string, string> = { support: "lost", normalised: "ratio", density: "ratio", physics: "f", tail: "f", mean: "f" };
const layers: [string, string][] = [["pdf", "its pdf, with its draws"], ["ratio", "draws over what the pdf implies"], ["f", "f L cos, with its draws"], ["lost", "light that is never drawn"]];
const captions: Record<string, string> = {
  pdf: "four decades of the pdf; a dot is a draw", ratio: "blue: half as many draws as the pdf implies, or fewer; orange: twice as many, or more",
  f: "four decades of f L cos; the area of a dot is the weight of the draw", lost: "where f L cos is not 0 and the pdf is",
};

/** What a right verdict could have missed: the size of each kind of fault that is found in nine of ten cases. */
function power({ state, found }: Verdict): string {
  return state === "right" && found.length > 0 ? ` In nine of ten cases it finds ${found.join(", ")}.` : "";
}

export interface Workplace {
  module: WebAssembly.Module; worker: string; filmWorker: FilmWorker; sources: Record<string, Source>; speaker: Speaker;
  changed(work: Work): void; // by the user
  checked(result: Checked): void;
}

export class Workshop implements Viewer {
  readonly root: HTMLElement;
  private readonly model: Model;
  private readonly film: FilmView;
  private readonly fault = el("p", { id: "fault-line", role: "alert" });
  private readonly hemisphere = el("canvas", { id: "draws", width: size, height: size, class: "disk large", role: "img", "aria-label": "the hemisphere" });
  private readonly caption = el("figcaption");
  private readonly verdicts = el("div", { id: "verdicts", "aria-live": "polite" });
  private readonly charts = el("div", { class: "charts" });
  private readonly options = el("div", { class: "choices" });
  private readonly views = el("div", { class: "choices" });
  private readonly besideBuiltIn = el("div");
  private readonly out = el("pre", {}, el("code", { id: "exported", tabindex: 0 }));
  private ground = "lambert";
  private scene: string;
  private beside = "cosine";
  private n = 16;
  private layer = "pdf";
  private shownDomain = directions;
  private wo: [number, number] = [30, 0];
  private films: Pool | undefined;
  private probe: Pool | undefined;
  private first = 0; // lines of the script before the code
  private startup = 0; // ms that the worker took to start
  private era = 0;
  private looks = 0;
  private timer = 0;
  private watch = 0;
  private checking = false;
  private active = false;

  /** In several tasks. */
  static async opened(at: Workplace): Promise<Workshop> {
    const place = el("div", { class: "editor" });
    return new Workshop(at, place, await Editor.opened(place, "the code of your sampler"));
  }

  private constructor(private readonly at: Workplace, place: HTMLElement, readonly editor: Editor) {
    this.scene = Object.keys(at.sources)[0]!;
    this.model = new Model(at.filmWorker, new Pool(at.module, at.worker, 0), this);
    this.film = new FilmView({ model: this.model, choose: (pixel) => this.film.select(pixel) }, "your-film", ["film 0", "film 1"]);
    editor.changed = (): void => this.edited();
    const button = (id: string, words: string, act: () => void, css = ""): HTMLElement => el("button", { type: "button", id, class: css, onclick: act }, words);
    const formats = choice("export-format", "export as", exports, exports[0]![0], () => this.export());
    this.root = el("div", { class: "workshop" },
      el("div", { class: "columns" },
        el("div", {}, place, this.fault,
          el("div", { class: "row-wrap" }, button("check-yours", "Check", () => void this.check(), "main"), button("copy-address", "Copy the address", () => void this.copyAddress()), button("save-code", "Save as a file", () => this.save()),
            el("label", { class: "file" }, "Open a file", el("input", { type: "file", id: "open-code", accept: ".js,.mjs,.wgsl,.txt", onchange: (e: Event) => void this.openFile(e) })))),
        el("div", {}, this.views, el("figure", { class: "hemisphere" }, this.hemisphere, this.caption))),
      this.verdicts,
      this.besideBuiltIn,
      el("details", { id: "export", ontoggle: () => this.export() }, el("summary", {}, "Export: the program, a frame for C++ or Python"), formats,
        this.out, el("p", {}, button("copy-export", "Copy", () => void this.copyExport()), " ", button("save-export", "Save as a file", () => this.saveExport()))));
    this.besideBuiltIn.append(el("h3", {}, "Its film beside a built-in one"), this.options, this.film.root, this.charts);
    window.setInterval(() => this.guard(), 500);
  }

  /** Shows this code; it is checked when asked. What is computed of it begins a few tasks later. */
  async load({ code, ground }: Work): Promise<void> {
    this.end();
    const { era } = this;
    this.editor.code = code;
    this.ground = ground in grounds ? ground : "lambert";
    this.verdicts.replaceChildren();
    this.layer = this.drawsPoints ? "deviation" : "pdf";
    for (const step of [(): void => this.controls(), (): void => this.restart()]) {
      await newTask();
      if (era !== this.era) return;
      step();
    }
  }

  /** The code's domain: a film and w_o exist for directions alone. */
  private get domain(): string { return domainOf(this.editor.code); }
  private get drawsPoints(): boolean { return this.domain !== directions; }

  get work(): Work { return { code: this.editor.code, ground: this.ground }; }

  /** Nothing is computed while it is not shown. */
  show(active: boolean): void {
    this.active = active;
    if (!active) this.end();
  }

  private edited(): void {
    this.end(); // what ran is not the code in the editor any more: a fault of it must not be shown
    this.verdicts.replaceChildren();
    this.at.changed(this.work);
    this.restartSoon();
  }

  private restartSoon(): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.restart(), 350);
  }

  private end(): void {
    ++this.era;
    window.clearTimeout(this.timer);
    this.model.stop();
    this.films?.end();
    this.probe?.end();
    this.films = this.probe = undefined;
    this.checking = false;
  }

  /** Workers with the code as it is now. */
  private restart(): void {
    this.end();
    if (!this.active) return;
    const { era } = this, { source, first } = withUser(this.at.worker, this.editor.code);
    if (this.shownDomain !== this.domain) {
      this.layer = this.drawsPoints ? "deviation" : "pdf";
      this.controls();
    }
    this.first = first;
    this.watch = performance.now();
    this.probe = new Pool(this.at.module, source, 1);
    this.probe.ready.then(() => {
      if (era !== this.era) return;
      this.startup = performance.now() - this.watch;
      this.watch = 0;
      this.say();
      void this.look();
      if (!this.drawsPoints) this.render(source);
    }, (error: unknown) => { this.watch = 0; this.failedIn(era, error); });
    this.export();
  }

  /** Ends code that takes too long. */
  private guard(): void {
    const busy = Math.max(this.watch > 0 ? performance.now() - this.watch : 0, this.films?.busy ?? 0), checked = this.probe?.busy ?? 0;
    const most = (of: "film" | "check"): number => Math.max(longest[of], startups[of] * this.startup);
    const film = most("film"), check = this.checking ? most("check") : film, limit = busy > film ? film : checked > check ? check : 0;
    if (limit === 0) return;
    this.end();
    this.watch = 0;
    this.say(`The code did not return within ${Math.round(limit / 1000)} s and was ended: look for a loop that does not end.`, this.lineOf(/\b(while|for|do)\b/));
  }
  /** The first line of the code that has it; 0 if none has. */
  private lineOf(words: RegExp): number { return this.editor.code.split("\n").findIndex((line) => words.test(line)) + 1; }

  /** A fault with its line, or none. */
  private say(words = "", line = 0, column = 0): void {
    if (words) this.verdicts.replaceChildren();
    this.editor.mark(line, words, column);
    this.fault.textContent = words ? `${line > 0 ? `Line ${line}: ` : ""}${words}` : "";
    this.fault.className = words ? "bad" : "";
    document.documentElement.dataset["code"] = words ? "fault" : "runs";
  }

  private failedIn(era: number, error: unknown): void {
    if (era !== this.era) return;
    this.end(); // one fault is enough: the other workers would report it again
    const why = error instanceof EngineError ? error : new EngineError("bug", String(error));
    if (why.kind !== "user") return this.say(why.sentence, why.kind === "input" && this.drawsPoints ? this.lineOf(/\bdomain\b/) : 0);
    const lines = this.editor.code.split("\n").length, text = why.message.replace(/^Uncaught /, "").replace(/\.?$/, ".");
    const [line, column] = (why.lines ?? []).map(([l, c]) => [l - this.first, c] as const).find(([l]) => l >= 1 && l <= lines) ?? [0, 0];
    const syntax = /SyntaxError/.test(text), broken = syntax ? this.editor.brokenLine || lines : 0;
    this.say(text, line || broken, line ? column : 0);
  }

  // ---- The hemisphere.

  private request(): Record<string, unknown> {
    const { lobe, lambert, sharpness, light } = grounds[this.ground]!;
    return { sampler: "", surface: { lobe, lambert, sharpness }, light };
  }

  /** The draws at the chosen w_o, over the chosen picture. */
  private async look(): Promise<void> {
    const { probe, era, layer } = this, mine = ++this.looks, request = { ...this.request(), wo: [this.wo] };
    if (!probe) return this.restartSoon();
    if (this.drawsPoints) return this.lookAtPoints(probe);
    try {
      const [disk, drawn] = await Promise.all([
        probe.request({ kind: "disk", call: "user_disk", request: { ...request, what: layer, size }, size }),
        probe.request({ kind: "json", call: "user_drawn", request: { ...request, n: draws } })]);
      if (era !== this.era || mine !== this.looks) return;
      const { draws: all, below, case: on } = drawn.response as { draws: [number, number, number][]; below: number; case: string };
      const pen = this.hemisphere.getContext("2d")!;
      pen.putImageData(new ImageData(new Uint8ClampedArray(disk.bytes![0]!), size, size), 0, 0);
      pen.fillStyle = "#fff";
      pen.strokeStyle = "#141517";
      if (layer === "pdf" || layer === "f")
        for (const [x, y, side] of all) {
          pen.beginPath();
          pen.arc((size * (1 + x)) / 2, (size * (1 - y)) / 2, layer === "f" ? 0.6 + 4 * side : 1.5, 0, 2 * Math.PI);
          pen.fill();
          pen.stroke();
        }
      this.hemisphere.setAttribute("aria-label", `${layers.find(([key]) => key === layer)![1]}: ${all.length} draws at ${on}`);
      this.caption.replaceChildren(el("b", {}, on), `: ${captions[layer]}. ${below > 0 ? `${below} of ${draws} draws fell below the horizon or drew nothing. ` : ""}The mirror direction is to the right.`);
      document.documentElement.dataset["looked"] = String(era);
    } catch (error) {
      this.failedIn(era, error);
    }
  }

  /** Points by bins, and what the pdf expects there. */
  private async lookAtPoints(probe: Pool): Promise<void> {
    const { era, layer } = this, mine = ++this.looks;
    try {
      const { response } = await probe.request({ kind: "json", call: "user_points_drawn", request: { evaluations } }, true);
      if (era !== this.era || mine !== this.looks) return;
      const picture = response as PointPicture, words = drawPoints(this.hemisphere, picture, layer);
      this.views.hidden = picture.kind !== "map"; // the others have one layer
      this.hemisphere.setAttribute("aria-label", `draws over ${this.domain}: ${words}`);
      this.caption.replaceChildren(el("b", {}, this.domain), `: ${words}.`);
      document.documentElement.dataset["looked"] = String(era);
    } catch (error) {
      this.failedIn(era, error);
    }
  }

  // ---- The film.

  private render(source: string): void {
    const { era } = this, count = Math.max(1, Math.min(4, navigator.hardwareConcurrency || 2)), from = this.at.sources[this.scene]!;
    const pool = (this.films = new Pool(this.at.module, source, count, 100_000));
    this.model.pool = pool;
    const counts = `[4, 16${this.n > 16 ? ", 64" : ""}]`;
    const opening = openingOf({ ...from, published: "" }, [`arms.${yours}.exec="page"`, `arms.${yours}.n=${counts}`, `arms.${this.beside}.n=${counts}`]);
    this.model.run(opening, [yours, this.beside], this.n).catch((error: unknown) => this.failedIn(era, error));
  }
  opened(d: Described, shown: Shown[]): void { this.film.opened(d, shown); }
  painted(index: number, box: Box): void {
    document.documentElement.dataset["filmed"] = String(this.era);
    this.film.painted(index, box);
  }
  measured(): void {
    void this.film.measured();
    void showLadders(this.charts, this.model);
    if (this.model.finished) document.documentElement.dataset["written"] = String(this.era);
  }
  tailed(): void {}
  spread(): void { void showLadders(this.charts, this.model); }
  failed(error: EngineError): void { this.failedIn(this.era, error); }

  private controls(): void {
    const again = (): void => { this.at.changed(this.work); this.restart(); }, look = (value: string): void => { this.layer = value; void this.look(); };
    this.shownDomain = this.domain;
    this.besideBuiltIn.hidden = this.drawsPoints;
    this.views.hidden = false;
    this.hemisphere.classList.toggle("disk", !this.drawsPoints);
    if (this.drawsPoints) return this.views.replaceChildren(choice("your-layer", "the picture shows", pointLayers, this.layer, look));
    this.options.replaceChildren(
      choice("your-scene", "scene", Object.entries(this.at.sources).filter(([, source]) => source.reference !== "note" || source.regions.length > 0).map(([name, s]) => [name, s.title]), this.scene, (value) => { this.scene = value; again(); }),
      choice("your-beside", "beside", samplers().map(({ name, label }) => [name, label]), this.beside, (value) => { this.beside = value; again(); }),
      choice("your-n", "samples a pixel", [["4", "4"], ["16", "16"], ["64", "64"]], String(this.n), (value) => { this.n = Number(value); again(); }));
    const angle = el("output", { for: "your-theta" }, `${this.wo[0]}°`);
    const theta = el("input", {
      type: "range", id: "your-theta", min: 0, max: 89, step: 1, value: this.wo[0], "aria-label": "w_o, degrees from the normal",
      oninput: () => { this.wo = [Number(theta.value), 0]; angle.textContent = `${theta.value}°`; void this.look(); },
    });
    this.views.replaceChildren(
      choice("your-ground", "surface and light", Object.entries(grounds).map(([key, { words }]) => [key, words]), this.ground, (value) => { this.ground = value; this.verdicts.replaceChildren(); again(); }),
      choice("your-layer", "the hemisphere shows", layers, this.layer, look),
      el("div", { class: "choice" }, el("span", { class: "label" }, "w_o ", angle), theta));
  }

  // ---- The verdicts.

  private async check(): Promise<void> {
    if (!this.probe) this.restart();
    const { probe, era } = this;
    if (!probe || this.checking) return;
    this.checking = true;
    const start = performance.now();
    this.verdicts.replaceChildren(el("p", {}, "Checking …"));
    try {
      const { response } = await probe.request({ kind: "json", call: "user_checked", request: { ...this.request(), wo: four, evaluations } }, true);
      if (era !== this.era) return;
      const result = response as Checked, took = performance.now() - start;
      document.documentElement.dataset["checked"] = String(Math.round(took));
      this.table(result, took);
      this.at.checked(result);
    } catch (error) {
      this.failedIn(era, error);
    }
    this.checking = false;
  }

  private table(result: Checked, took: number): void {
    const rows = result.verdicts.map((v) => el("tr", { "data-verdict": v.name, "data-state": v.state },
      el("th", { scope: "row" }, el("button", { type: "button", class: "plain", title: v.question, onclick: () => this.picture(v) }, v.name)),
      el("td", { class: v.state === "wrong" || v.state === "error" ? "bad" : v.state === "right" ? "good" : "" }, v.state),
      el("td", {}, minus(plusMinus(v.message)), power(v), ...(v.cause ? [` ${minus(plusMinus(v.cause))}`] : []))));
    const where = this.drawsPoints ? `over ${this.domain}` : `at w_o of ${four.map(([theta]) => `${theta}°`).join(", ")}`;
    const first = result.verdicts.find(({ state }) => state === "wrong" || state === "error");
    this.verdicts.replaceChildren(
      el("p", {}, el("b", { "data-result": result.state }, result.state), first ? `: fix ${first.name} first. ` : ". ",
        `${result.evaluations.toLocaleString("en")} evaluations ${where} in ${(took / 1000).toFixed(1)} s. A right verdict says what it could have missed; the program, with ten times as many, misses less.${this.drawsPoints ? "" : " Click a verdict for its picture."}`),
      el("table", { class: "verdicts" }, el("caption", {}, this.drawsPoints ? this.domain : grounds[this.ground]!.words), el("tbody", {}, ...rows)));
    if (first) this.picture(first);
  }

  /** The draws or directions that a verdict speaks of. */
  private picture(v: Verdict): void {
    if (this.drawsPoints) return;
    this.wo = [v.theta, v.azimuth];
    this.layer = pictures[v.name] ?? "pdf";
    this.controls();
    void this.look();
  }

  // ---- The code as a file, in the address, in other languages.

  private async copyAddress(): Promise<void> {
    const words = el("span", {}, location.href);
    this.at.speaker.say(await copied(words));
  }
  private save(): void { download(isShader(this.editor.code) ? "sampler.wgsl" : "sampler.js", this.editor.code); }
  private async openFile(event: Event): Promise<void> {
    const [file] = (event.target as HTMLInputElement).files ?? [];
    if (!file || file.size > 200_000) return;
    this.editor.code = await file.text();
    this.edited();
  }
  private get format(): string { return byId<HTMLSelectElement>("export-format")?.value ?? exports[0]![0]; }
  private export(): void {
    const details = this.root.querySelector<HTMLDetailsElement>("#export")!;
    if (details.open) this.out.firstElementChild!.textContent = exported(this.format, this.editor.code, this.ground).text;
  }
  private async copyExport(): Promise<void> { this.at.speaker.say(await copied(this.out)); }
  private saveExport(): void {
    const { name, text } = exported(this.format, this.editor.code, this.ground);
    download(name, text);
  }
}

/** The verdicts on some code, in a worker of its own. */
export async function checkedCode(module: WebAssembly.Module, worker: string, code: string, ground: string): Promise<Checked> {
  const pool = new Pool(module, withUser(worker, code).source, 1), { lobe, lambert, sharpness, light } = grounds[ground]!;
  try {
    const request = { sampler: "", surface: { lobe, lambert, sharpness }, light, wo: four, evaluations };
    return (await pool.request({ kind: "json", call: "user_checked", request })).response as Checked;
  } finally {
    pool.end();
  }
}
