// A lesson on the page: it asks, measures, shows the guess next to the measurement, and lets the user experiment. The
// sheet for teachers is made of the same data and of numbers that are measured when it is opened.
import { Asker, Found } from "./answers";
import { boxQuestion } from "./box";
import { checkPanel, paintDraws, samplerPictures } from "./check";
import { el, made, minus } from "./dom";
import { furnacePanel } from "./furnace";
import { Lesson, lessons } from "./lessons";
import { Model } from "./model";
import { html } from "./text";

export interface Lessons {
  root: HTMLElement;
  model: Model;
  asker(): Asker;
  answered(lesson: Lesson, answer: string): void;
  open(pixel: [number, number]): void; // its hemisphere, if none is open
  go(lesson: string): void;
  say(line: string): void;
}

const wide = 240, high = 135; // pixels of a picture in the list

/** What a lesson is about: the strips of its arms, or a sampler's draws over its pdf. Computed once. */
const drawn = new Map<string, HTMLCanvasElement>();
function lessonPicture(to: Lessons, lesson: Lesson): HTMLCanvasElement {
  const known = drawn.get(lesson.id);
  if (known) return known;
  const { answer } = lesson, disk = "samplers" in answer;
  const canvas = el("canvas", { width: disk ? 176 : wide, height: disk ? 176 : high, class: disk ? "disk" : "", role: "img", "aria-label": disk ? `draws of ${answer.samplers[0]} over its pdf` : `the gallery by ${lesson.arms.join(", ")}` });
  drawn.set(lesson.id, canvas);
  const paint = async (): Promise<void> => {
    if ("samplers" in answer) return paintDraws(to.model, canvas, { value: answer.samplers[0]!, words: answer.samplers[0]! }, answer.theta);
    let x = 0;
    for (const strip of await to.asker().strips(lesson.arms, 16, wide, high)) {
      canvas.getContext("2d")!.putImageData(strip, x, 0);
      x += strip.width;
    }
  };
  void Promise.resolve().then(paint).catch(() => drawn.delete(lesson.id)); // the list works without it
  return canvas;
}

export function lessonList(to: Lessons, answers: Record<string, string>): void {
  const items = lessons.map((lesson) => el("li", {}, lessonPicture(to, lesson),
    el("a", { href: `#lesson=${lesson.id}`, "data-lesson": lesson.id, onclick: (e) => { e.preventDefault(); to.go(lesson.id); } }, lesson.title),
    el("p", {}, set(lesson.aim)), el("small", {}, `${lesson.minutes} minutes${answers[lesson.id] ? ", answered" : ""}`)));
  to.root.replaceChildren(el("h2", {}, "Lessons"),
    el("p", {}, `In this order, ${lessons.reduce((sum, { minutes }) => sum + minutes, 0)} minutes in all. Each asks first, then measures, then lets you play. Answers live in the address.`),
    el("ol", { class: "cards pictured" }, ...items));
}

function question(lesson: Lesson, asker: Asker, given: string | undefined, take: (answer: string) => void): HTMLElement {
  const ask = lesson.ask;
  let inside: HTMLElement[], read: () => string;
  if (ask.kind === "region") ({ inside, read } = boxQuestion(asker, given));
  else if (ask.kind === "choice") {
    const inputs = ask.options.map(({ value }) => el("input", { type: "radio", name: "answer", id: `answer-${value}`, value, checked: value === given }));
    inside = ask.options.map(({ words }, k) => el("div", { class: "option" }, inputs[k], el("label", { for: inputs[k]!.id }, words)));
    read = (): string => inputs.find((input) => input.checked)?.value ?? "";
  } else {
    const middle = given ?? String(Math.round(((ask.low + ask.high) / 2) / ask.step) * ask.step);
    const output = el("output", { for: "guess" }, `${middle} ${ask.unit}`);
    const input = el("input", {
      type: "range", id: "guess", min: ask.low, max: ask.high, step: ask.step, value: middle, "aria-label": `your guess, ${ask.unit}`,
      oninput: () => { output.textContent = `${input.value} ${ask.unit}`; },
    });
    inside = [el("div", { class: "row" }, input, output)];
    read = (): string => input.value;
  }
  const hint = el("p", { role: "alert" });
  const submit = (event: Event): void => {
    event.preventDefault();
    const answer = read();
    if (answer) take(answer);
    else hint.textContent = ask.kind === "region" ? "Draw a box of this picture first, or type its corners." : "Choose one first.";
  };
  return el("form", { onsubmit: submit }, el("fieldset", {}, el("legend", {}, lesson.question), ...inside),
    hint, el("button", { type: "submit", class: "main", id: "measure" }, "Measure"));
}

const unsaid = "The lines above say what was found; this lesson has no sentence for it.";

/** Words with formulas, formatted by the core. */
const set = (words: string): DocumentFragment => made(html(words));

/** An answer in the words of the question. */
function worded({ ask }: Lesson, value: string): string {
  if (ask.kind === "slider") return `${value} ${ask.unit}`;
  if (ask.kind === "choice") return ask.options.find((o) => o.value === value)?.words ?? (value === "overlap" ? "none: the intervals of the seeds overlap" : value);
  const [x0, y0, x1, y1] = value.split(",");
  return y1 ? `the box from (${x0}, ${y0}) to (${x1}, ${y1})` : value === "overlap" ? "none is the noisiest: the intervals of the seeds overlap" : `${value} is the noisiest`;
}

function revealed(lesson: Lesson, answer: string, found: Found, commands: string[]): HTMLElement {
  const again = commands.length > 0 ? [el("p", { class: "again" }, "The same numbers from the program: ", ...commands.flatMap((words, k) => [k > 0 ? ", " : "", el("code", {}, words)]))] : [];
  return el("div", { class: "reveal", id: "reveal", tabindex: -1 },
    el("p", {}, "You said ", el("b", {}, worded(lesson, answer)), "; measured here: ", el("b", {}, worded(lesson, found.answer)), "."),
    el("ul", {}, ...found.lines.map((line) => el("li", {}, minus(line)))), el("p", { "data-kind": found.kind }, set(lesson.says[found.kind] ?? unsaid)), ...again);
}

export function showLesson(to: Lessons, lesson: Lesson, given: string | undefined): void {
  const result = el("div");
  const next = lessons[lessons.indexOf(lesson) + 1];
  const measure = async (answer: string): Promise<void> => {
    to.answered(lesson, answer);
    result.replaceChildren(el("p", {}, "Measuring …"));
    try {
      const found = await to.asker().find(lesson, answer);
      const shown = revealed(lesson, answer, found, to.asker().commands(lesson, answer));
      const play = lesson.check ? checkPanel(to.asker(), lesson) : lesson.furnace ? furnacePanel(to.asker(), lesson) : el("p", {}, "Now play: the pictures and settings below are this lesson's.");
      result.replaceChildren(shown, play, el("p", {},
        el("button", { type: "button", id: "next", onclick: () => to.go(next ? next.id : "") }, next ? `Next: ${next.title}` : "All lessons")));
      shown.focus();
      if (found.pixel) to.open(found.pixel);
      to.say(`Measured: ${worded(lesson, found.answer)}`);
    } catch (error) {
      result.replaceChildren(el("p", { class: "bad" }, `This could not be measured: ${error instanceof Error ? error.message : error}.`));
    }
  };
  to.root.replaceChildren(
    el("p", {}, el("a", { href: "#", onclick: (e) => { e.preventDefault(); to.go(""); } }, "All lessons")),
    el("h2", {}, lesson.title), el("div", { class: "asking" }, el("p", {}, set(lesson.aim)),
      ...(lesson.answer.by === "which" ? [samplerPictures(to.model, lesson.check!.samplers, lesson.answer.theta)] : []), question(lesson, to.asker(), given, (a) => void measure(a)), result));
  if (given !== undefined) void measure(given);
}

export function showSheet(root: HTMLElement, asker: Asker, more: HTMLElement): void {
  const articles = lessons.map((lesson, k) => {
    const place = el("div", {}, el("p", {}, "Expected: being measured …")), say = el("p");
    return { lesson, place, say, article: el("article", {}, el("h3", {}, `${k + 1}. ${lesson.title}`),
      el("p", { class: "footnote" }, `${lesson.minutes} minutes`), el("p", {}, el("b", {}, "Aim. "), set(lesson.aim)),
      el("p", {}, el("b", {}, "Question. "), lesson.question), place, say) };
  });
  delete root.dataset["measured"];
  root.replaceChildren(el("h2", {}, "For teachers"),
    el("p", {}, `${lessons.length} lessons of ${lessons.reduce((sum, l) => sum + l.minutes, 0)} minutes in all. The answers below were measured now, by this page. `,
      el("button", { type: "button", onclick: () => window.print() }, "Print this sheet")), ...articles.map((a) => a.article), more);
  void (async (): Promise<void> => {
    for (const { lesson, place, say } of articles) {
      try {
        const found = await asker.find(lesson);
        place.replaceChildren(el("p", {}, el("b", {}, "Expected. "), `${worded(lesson, found.answer)}${lesson.ask.kind === "region" ? ` in ${lesson.answer.by === "largest" ? lesson.answer.of[0]!.region : ""}` : ""}.`), el("ul", {}, ...found.lines.map((line) => el("li", {}, minus(line)))));
        say.replaceChildren(el("b", {}, "Say. "), set(lesson.says[found.kind] ?? unsaid));
      } catch (error) {
        place.textContent = `This could not be measured: ${error instanceof Error ? error.message : error}.`;
      }
    }
    root.dataset["measured"] = "all";
  })();
}
