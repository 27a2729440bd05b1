// The page: reads the address, opens the experiment, shows it, writes the address.
import { showChoices } from "./choices";
import { controlRows } from "./controls";
import { Asker } from "./answers";
import { Box, EngineError } from "./api";
import { directions, domainOf, pointTemplates } from "./domains";
import { byId, copied, el, newTask, Speaker } from "./dom";
import { openPixel } from "./hemisphere";
import { showLadders } from "./ladders";
import { Lessons, lessonList, showLesson, showSheet } from "./lesson";
import { OwnScenes } from "./own";
import { Lesson, lessons, onBench } from "./lessons";
import { Faults, faultSheet } from "./faults";
import { exercises } from "./exercises";
import { FilmView } from "./film";
import { packed, unpacked } from "./packed";
import { shaderTemplates } from "./shader_templates";
import { Template, templates } from "./templates";
import { isShader, missingForShaders } from "./wgsl";
import { checkedCode, Work, Workshop } from "./workshop";
import { choice } from "./controls";
import { Described, Model, Shown, Viewer } from "./model";
import { byArrow, drawnRegion, Picture } from "./pictures";
import { FilmWorker, Pool } from "./pool";
import { samplers, startText } from "./text";
import { command, fresh, nativeHash, openingOf, overrides, read, Source, State, write } from "./state";

export interface Data { version: string; sources: Record<string, Source> }
const allTemplates: Readonly<Record<string, Template>> = { ...templates, ...shaderTemplates, ...pointTemplates };
/** The language and the domain of code. */
const kindOf = (code: string): string => `${isShader(code) ? "wgsl" : "javascript"} ${domainOf(code)}`;
type Opened = Pick<State, "experiment" | "set" | "arms">;
interface Sampler { name: string; label: string; summary: string }

export class Page implements Viewer {
  private state!: State;
  private model!: Model;
  private pictures: Picture[] = [];
  private samplers: Sampler[] = [];
  private top = 1;
  private timer = 0;
  private openedAt = 0;
  private seen: Described | undefined; // shown in the pictures; the model may have opened another
  private painting = 0; // counts repaints of the pictures, and opened pixels: only the last one continues
  private opening = 0;
  private offered: { key: string; state?: State } = { key: "" }; // the choices that are shown
  private names = ""; // of the samplers in the pictures
  private movedAt = 0; // time of the last change that is not open yet
  private awaited = 0; // and not painted yet
  private good: Opened | undefined; // the last one that opened
  private refused = false; // the settings since then are invalid
  private response: string[] = []; // from the address, until something is opened
  private idle = true; // nothing is computed while the bench is hidden
  private asRead = false; // an answered lesson that the address shows with its own settings
  private known: Asker | undefined;
  private film!: FilmView;
  private workshop: Workshop | undefined; // once it is opened
  private opensWorkshop: Promise<void> | undefined; // it takes several tasks
  private module!: WebAssembly.Module;
  private worker = "";
  private template = "cosine";
  private loaded = ""; // what the workshop shows: an exercise, packed code
  private readonly faults = new Faults((name) => this.goTo(name), (exercise) => this.begin(exercise));
  private readonly speaker = new Speaker(byId("status"));

  constructor(private readonly data: Data) {}

  /** The workers start while the module is compiled. Rejects if it cannot be. */
  async start(compiled: Promise<WebAssembly.Module>, worker: string): Promise<void> {
    const count = Math.max(1, Math.min(8, navigator.hardwareConcurrency || 2));
    this.model = new Model(new FilmWorker(compiled, worker), new Pool(compiled, worker, count), this);
    const module = await compiled, { pool } = this.model;
    startText(module);
    await newTask();
    Object.assign(this, { module, worker });
    pool.ready.then(() => { document.documentElement.dataset["workers"] = String(pool.workers); }, () => this.withoutWorkers());
    this.samplers = samplers();
    this.film = new FilmView({ model: this.model, choose: (pixel) => this.choose(pixel), region: (box) => this.change(drawnRegion, `[${box.join(", ")}]`) }, "main-film");
    byId("film").replaceChildren(this.film.root);
    await newTask();
    byId("copy").onclick = async (): Promise<void> => this.speaker.say(await copied(byId("command")));
    byId("reset").onclick = (): void => { this.state.set = {}; this.open(); };
    byId("tabs").onclick = (event): void => {
      const part = (event.target as HTMLElement).dataset["tab"];
      if (!part) return;
      event.preventDefault();
      Object.assign(this.state, { lesson: "", exercise: "", part });
      this.turn();
      this.show();
      if (this.idle && !byId("bench").hidden) this.open();
    };
    document.querySelector<HTMLElement>(".skip")!.onclick = (event): void => { event.preventDefault(); byId("main").focus(); }; // the address holds the state
    window.onhashchange = (): void => this.fromAddress();
    new OwnScenes(byId("own"), pool, this.speaker, (name, source) => this.openOwn(name, source));
    this.fromAddress();
  }

  private get source(): Source { return this.data.sources[this.state.experiment]!; }
  private get lesson(): Lesson | undefined { return lessons.find((l) => l.id === this.state.lesson); }

  /** A step that the browser's Back reverts: another part, lesson or choice. Dragging and typing are not steps. */
  private turn(): void {
    if (write(this.state) !== location.hash) history.pushState(null, "", write(this.state));
  }

  private fromAddress(): void {
    if (this.state && write(this.state) === location.hash) return;
    this.response = [];
    this.state = read(location.hash, this.data.sources, this.samplers.map((s) => s.name), this.response);
    const { answers, lesson } = this.state, answered = answers[lesson] !== undefined;
    this.asRead = answered && new URLSearchParams(location.hash.slice(1)).has("arms");
    this.show();
    if (this.response.length > 0) byId("wrong").replaceChildren(...this.response.map((line) => el("p", {}, line)));
    if (byId("bench").hidden) history.replaceState(null, "", write(this.state));
    else if (!answered) this.open(); // an answered lesson opens what it shows
  }

  /** Opens the state; settings that the core rejects are reported and omitted. */
  private open(response: string[] = this.response): void {
    const { state, source } = this;
    this.response = [];
    this.idle = false;
    this.openedAt = performance.now();
    const opening = openingOf(source, overrides(state, source));
    byId("wrong").replaceChildren(...response.map((line) => el("p", {}, line)));
    this.model.run(opening, state.arms, state.n).catch((error: unknown) => {
      const why = error instanceof EngineError ? error : new EngineError("bug", error instanceof Error ? error.message : String(error));
      if (why.kind === "worker") return this.withoutWorkers();
      const plain = fresh(state.experiment, source), { good } = this;
      const differs = (from: Opened): boolean => JSON.stringify([from.set, from.arms]) !== JSON.stringify([state.set, state.arms]);
      if (!differs(plain) || why.kind === "memory") return this.failed(why, true);
      const back = good?.experiment === state.experiment && differs(good) ? good : undefined, { set, arms } = back ?? plain;
      Object.assign(state, { set: { ...set }, arms: [...arms], arm: 0 });
      this.refused = true;
      this.open([...response, `These settings cannot be: ${why.message}. ${back ? "They are as they were before." : "The experiment is as it was written."}`]);
    });
  }

  /** A scene of the user on the bench. */
  private openOwn(name: string, source: Source): void {
    this.data.sources[name] = source;
    this.state = { ...fresh(name, source), answers: this.state.answers };
    this.turn();
    this.show();
    this.open();
  }

  /** Applies a setting: at once in the address, in the pictures at most thirty times a second. */
  private change(path: string, value: string | undefined): void {
    if (value === undefined) delete this.state.set[path];
    else this.state.set[path] = value;
    this.movedAt ||= performance.now();
    const wait = this.openedAt + 30 - performance.now();
    if (!this.timer) this.timer = window.setTimeout(() => { this.timer = 0; this.open(); }, Math.max(0, wait));
  }

  opened(d: Described, shown: Shown[]): void {
    if (this.movedAt) (this.awaited = this.movedAt), (this.movedAt = 0);
    this.seen = d;
    this.good = { experiment: this.state.experiment, set: { ...this.state.set }, arms: [...this.state.arms] };
    delete document.documentElement.dataset["took"];
    const at = this.state.pixel;
    if (at && (at[0] >= d.width || at[1] >= d.height)) {
      this.state.pixel = undefined;
      byId("wrong").append(el("p", {}, `The address says pixel=${at.join(",")}, which lies outside the picture: none is open.`));
    }
    history.replaceState(null, "", write(this.state));
    byId("command").textContent = command(this.state, this.source);
    this.choices();
    const names = shown.map(({ name }) => name).join();
    const same = this.names === names && this.pictures[0]?.canvas.width === d.width && this.pictures[0].canvas.height === d.height;
    this.names = names;
    this.film.opened(d, shown);
    this.film.select(this.state.pixel);
    if (same) this.pictures = this.pictures.map((picture) => { picture.opened(d); return picture; }); // a new list ends repaints
    else this.newPictures(d, shown);
    for (const picture of this.pictures) {
      picture.outlines(this.state.pixel);
      if (picture.index < 0) picture.name("reference", d.reference === "paired" ? "the mean of two estimates" : "by quadrature, no samples");
      else picture.about(d.arms[shown[picture.index]!.arm]!), this.metrics(picture.index);
    }
    if (byId("charts").childElementCount !== d.regions.length)
      byId("charts").replaceChildren(...d.regions.map(() => el("figure", { class: "narrow chart-to-come" })));
    if (this.refused || !document.activeElement?.closest("[data-path]"))
      void newTask().then(() => { if (d === this.model.described) this.knobs(); });
    this.refused = false;
  }

  private newPictures(d: Described, shown: Shown[]): void {
    const picking = {
      pixel: (i: number, j: number): void => this.choose([i, j]),
      region: (box: number[]): void => this.change(drawnRegion, `[${box.join(", ")}]`),
    };
    this.pictures = [...shown.map((_, index) => new Picture(index, d, picking)), new Picture(-1, d, picking)];
    for (const picture of this.pictures)
      picture.canvas.addEventListener("keydown", (event) => { const to = byArrow(event, this.state.pixel, d); if (to) this.choose(to); });
    byId("pictures").replaceChildren(...this.pictures.map((p) => p.root));
  }

  /** All settings, or those that a lesson allows to change. They are not created again while the user moves one of
   *  them. */
  private knobs(): void {
    const { described } = this.model, held = document.activeElement?.closest("[data-path]") && document.activeElement.getAttribute("aria-label");
    if (described) byId("knobs").replaceChildren(...controlRows(described, (path, value) => this.change(path, value), this.lesson?.play));
    if (held) document.querySelector<HTMLElement>(`#knobs [aria-label="${CSS.escape(held)}"]`)?.focus();
  }

  /** Creates the choices again if they have changed. */
  private choices(): void {
    const { experiment, arms, n, view } = this.state, key = JSON.stringify([experiment, arms, n, view, this.lesson?.play]);
    if (this.offered.key === key && this.offered.state === this.state) return;
    this.offered = { key, state: this.state };
    const move = (how: () => void) => (): void => { this.turn(); how(); };
    showChoices(byId("choices"), {
      state: this.state, sources: this.data.sources, samplers: this.samplers, only: this.lesson?.play,
      open: move(() => this.open()), show: move(() => this.repaint()),
    });
  }

  painted(index: number, box: Box): void {
    const picture = index < 0 ? this.pictures.at(-1) : this.pictures[index];
    const info = document.documentElement.dataset;
    info["first"] ??= String(Math.round(performance.now()));
    if (this.awaited && index >= 0) (info["moved"] = String(Math.round(performance.now() - this.awaited))), (this.awaited = 0);
    this.film.painted(index, box);
    if (index < 0 || this.state.view === "photograph") picture?.paint(this.model, this.state, this.top, box, () => this.pictures.includes(picture)).catch(() => {}); // the model reports what fails
  }

  private metrics(index: number): void { this.pictures[index]?.metrics(this.model.shown[index]!, (key) => nativeHash(this.state, this.source, key)); }
  tailed(): void { this.model.shown.forEach((_, index) => this.metrics(index)); }

  spread(): void { void showLadders(byId("charts"), this.model); }

  measured(): void {
    const { shown } = this.model, painted = this.model.referenceDone && this.state.view !== "photograph" ? this.repaint() : undefined;
    this.tailed();
    const filmed = this.film.measured();
    const region = this.model.described.regions[0]?.name;
    const lines = shown.filter((s) => s.sampleCounts.length > 0).map((s) => {
      const last = s.sampleCounts.at(-1)!;
      return `${s.name}, N = ${last.n}${region ? `: RMSE of ${region} ${last.metrics.metrics[`rmse.${region}`]!.text}` : ""}`;
    });
    this.speaker.say(lines.join("; "));
    if (this.state.pixel) this.film.select(this.state.pixel);
    if (!this.model.finished) return void showLadders(byId("charts"), this.model);
    void this.finished(Promise.all([painted, filmed, showLadders(byId("charts"), this.model), this.state.pixel && this.openPixel()]));
  }

  /** Notifies the tests once everything is shown. */
  private async finished(shown: Promise<unknown>): Promise<void> {
    const { described, took } = this.model, info = document.documentElement.dataset;
    info["films"] = String(Math.round(this.model.filmsTook));
    await shown;
    if (described !== this.model.described || this.idle) return;
    info["memory"] = `${this.model.filmWorker.size} ${this.model.pool.size}`; // of the film worker's instance, of the workers
    info["took"] = String(Math.round(took));
  }

  /** All pictures, unless others are requested meanwhile. */
  private async repaint(): Promise<void> {
    const { pictures, model, seen } = this, mine = ++this.painting;
    const stands = (): boolean => mine === this.painting && pictures === this.pictures && seen === model.described;
    if (!stands()) return;
    const top = (model.referenceDone ? await model.scales() : undefined)?.top ?? 1;
    if (!stands()) return;
    this.top = top;
    pictures.at(-1)?.legend(model, this.state, top);
    await Promise.all(pictures.map((picture) => picture.repaint(model, this.state, top, stands)));
  }

  private choose(pixel: [number, number]): void {
    this.state.pixel = pixel;
    history.replaceState(null, "", write(this.state));
    for (const picture of this.pictures) picture.outlines(pixel);
    this.film.select(pixel);
    void this.openPixel();
  }

  private openPixel(): Promise<void> {
    const mine = ++this.opening;
    return openPixel(byId("pixel"), this.model, this.state, () => mine === this.opening, () => {
      history.replaceState(null, "", write(this.state));
      void this.openPixel();
    });
  }

  /** The page has no second engine. */
  private withoutWorkers(): void {
    document.documentElement.dataset["workers"] = "0";
    for (const id of ["bench", "write", "lessons", "sheet"]) byId(id).hidden = true;
    byId("wrong").replaceChildren(el("p", {}, "This browser refuses workers, in which this page computes: allow them for this file, or open it in another browser."));
  }

  /** A message with the next step; `all`: nothing can be shown for these settings except their command. */
  failed(error: EngineError, all = false): void {
    if (error.kind === "worker") return this.withoutWorkers();
    if (all) {
      byId("command").textContent = command(this.state, this.source);
      for (const id of ["pictures", "charts", "pixel"]) byId(id).replaceChildren();
      this.pictures = [];
      this.names = "";
      this.choices();
    }
    byId("wrong").replaceChildren(el("p", {}, error.sentence));
  }

  /** The bench, the lessons or the sheet. A lesson has its own arms and keeps the bench below it. */
  private show(): void {
    const { part, answers } = this.state, { lesson } = this;
    for (const link of document.querySelectorAll<HTMLElement>("#tabs a"))
      link.dataset["tab"] === part ? link.setAttribute("aria-current", "page") : link.removeAttribute("aria-current");
    byId("lessons").hidden = part !== "lessons";
    byId("write").hidden = part !== "write" && part !== "faults";
    byId("sheet").hidden = part !== "sheet";
    byId("bench").hidden = part === "sheet" || part === "write" || part === "faults" || (part === "lessons" && (!lesson || !onBench(lesson) || answers[lesson.id] === undefined));
    if (byId("bench").hidden && !this.idle) this.rest();
    byId<HTMLDetailsElement>("controls").open = part === "lessons";
    this.choices();
    this.knobs();
    this.showWrite();
    if (part === "sheet") showSheet(byId("sheet"), this.asker(), faultSheet((code, ground) => checkedCode(this.module, this.worker, code, ground)));
    if (part === "lessons") lesson ? showLesson(this.lessons(), lesson, answers[lesson.id]) : lessonList(this.lessons(), answers);
  }

  // ---- Write a sampler, and find the fault.

  private showWrite(): void {
    const { part, exercise } = this.state, at = byId("task"), found = exercises.find(({ name }) => name === exercise);
    const writes = part === "write" || (part === "faults" && found !== undefined);
    if (writes && !this.workshop) {
      this.opensWorkshop ??= this.openWorkshop();
      return;
    }
    byId("workshop").hidden = part !== "write";
    if (part !== "write") this.workshop?.show(false), (this.loaded = "");
    if (part === "faults") return found ? this.faults.show(at, found) : this.faults.list(at);
    if (part !== "write") return;
    at.replaceChildren(el("h2", {}, "Write a sampler"),
      el("p", {}, "In JavaScript: ", el("code", {}, "sample(wo, u)"), " returns a direction w_i and its density, ", el("code", {}, "pdf(wo, wi)"), " the density of any direction. Local frame, n = +z; w_o is given, w_i is drawn, both leave the surface; pdf in 1/sr. A third argument, if the functions have one, has the surface and the lights. In WGSL: a file for ", el("code", {}, "crescent check FILE.wgsl"), ", whose comments call its functions; f is that of the surface. Over another domain, ", el("code", {}, "const domain = \"disk\";"), ", ", el("code", {}, "sample(u)"), " returns a point x and its density, and ", el("code", {}, "pdf(x)"), " that of any point; an ", el("code", {}, "f(x)"), " is an integrand."),
      this.templateChoices(this.state.code ? "" : allTemplates[this.template]!.code));
    this.workshop!.show(true);
    void this.loadCode();
  }

  /** The language and the domain of a sampler, and what it starts from. */
  private templateChoices(code: string): HTMLElement {
    const open = (template: string): void => {
      this.template = template;
      Object.assign(this.state, { code: "", ground: "" });
      this.loaded = "";
      this.turn();
      void this.loadCode();
    };
    const lacks = missingForShaders(), wgsl = isShader(code), domain = domainOf(code);
    const of = wgsl ? shaderTemplates : domain === directions ? templates : Object.fromEntries(Object.entries(pointTemplates).filter(([name]) => name === domain));
    const names = Object.keys(of), language = wgsl ? "wgsl" : "javascript";
    const domains = wgsl ? [] : Object.keys(pointTemplates), own = [directions, ...domains].includes(domain) ? [] : [domain];
    return el("div", { class: "choices", id: "templates", "data-of": kindOf(code) },
      choice("language", "language", [["javascript", "JavaScript"], ["wgsl", lacks ? `WGSL: ${lacks}` : "WGSL", lacks !== ""]], language, (value) => open(value === "wgsl" ? "wgsl-cosine" : "cosine")),
      choice("domain", "domain", [[directions, "directions, hemisphere"], ...[...domains, ...own].map((name): [string, string] => [name, name])], domain, (value) => open(value === directions ? "cosine" : value)),
      ...(names.length > 0 ? [choice("template", "start from", names.map((name) => [name, of[name]!.title]), names.includes(this.template) ? this.template : names[0]!, open)] : []));
  }

  private async openWorkshop(): Promise<void> {
    this.workshop = await Workshop.opened({
      module: this.module, worker: this.worker, filmWorker: this.model.filmWorker, sources: this.data.sources, speaker: this.speaker,
      changed: (work) => void this.written(work), checked: (result) => this.faults.checked(result),
    });
    byId("workshop").replaceChildren(this.workshop.root);
    await newTask();
    this.showWrite();
  }

  /** The code of the address, or a template. */
  private async loadCode(): Promise<void> {
    const { code, ground } = this.state, { code: plain, ground: own } = allTemplates[this.template]!;
    if (this.loaded === (code || "template")) return;
    this.loaded = code || "template";
    let text = plain;
    try {
      if (code) text = await unpacked(code);
    } catch {
      byId("wrong").append(el("p", {}, "The address has a sampler's code that cannot be read: a template is open."));
    }
    if (this.state.part !== "write") return;
    this.showTemplates(text);
    await this.workshop!.load({ code: text, ground: ground || own });
  }

  /** The choices are those of the code's language and domain. */
  private showTemplates(code: string): void {
    if (byId("templates").dataset["of"] !== kindOf(code)) byId("templates").replaceWith(this.templateChoices(code));
  }

  /** The user has changed the code, or what it is shown on. */
  private async written({ code, ground }: Work): Promise<void> {
    if (this.state.part !== "write") return this.faults.forget();
    this.showTemplates(code);
    const words = await packed(code);
    if (this.state.part !== "write") return;
    Object.assign(this.state, { code: words, ground });
    this.loaded = words;
    history.replaceState(null, "", write(this.state));
  }

  private begin(exercise: typeof exercises[number]): void {
    byId("workshop").hidden = false;
    this.workshop!.show(true);
    this.faults.forget();
    void this.workshop!.load(exercise);
  }

  private goTo(exercise: string): void {
    Object.assign(this.state, { exercise, part: "faults" });
    this.turn();
    this.show();
    const focus = (): void => byId("write").querySelector<HTMLElement>("a, input, button")?.focus();
    if (this.opensWorkshop) void this.opensWorkshop.then(focus);
    else focus();
  }

  private rest(): void {
    this.idle = true;
    window.clearTimeout(this.timer);
    this.timer = 0;
    this.model.stop();
    this.speaker.say("");
  }

  private asker(): Asker {
    const [, source] = Object.entries(this.data.sources)[0]!;
    const opening = openingOf(source, []);
    return (this.known ??= new Asker(this.model, opening, source));
  }

  private lessons(): Lessons {
    return {
      root: byId("lessons"),
      model: this.model,
      asker: () => this.asker(),
      say: (line) => this.speaker.say(line),
      open: (pixel) => { if (!this.state.pixel) this.choose(pixel); },
      answered: (lesson, answer) => {
        const kept = this.asRead;
        this.asRead = false;
        if (this.state.answers[lesson.id] !== answer) {
          this.state.answers[lesson.id] = answer;
          this.turn();
        }
        if (!onBench(lesson)) return history.replaceState(null, "", write(this.state)); // it uses samplers, not pictures
        if (!kept) Object.assign(this.state, { experiment: Object.keys(this.data.sources)[0]!, arms: [...lesson.arms], n: lesson.n, view: lesson.view ?? "photograph", arm: 0 });
        byId("bench").hidden = false;
        this.open();
      },
      go: (id) => {
        byId("wrong").replaceChildren();
        Object.assign(this.state, { lesson: id, part: "lessons", set: {} });
        this.turn();
        this.show();
        byId("lessons").querySelector<HTMLElement>("a, input, button")?.focus();
      },
    };
  }
}
