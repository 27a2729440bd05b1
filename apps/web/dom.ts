// Short functions that make elements.
type Child = Node | string | undefined;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void) | undefined>;

/** An element with attributes, listeners ("onclick") and children. */
export function el<K extends keyof HTMLElementTagNameMap>(tag: K, given: Attributes = {}, ...inside: Child[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(given)) {
    if (typeof value === "function") made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== undefined) made.setAttribute(name, String(value));
  }
  made.append(...inside.filter((child): child is Node | string => child !== undefined));
  return made;
}

/** Markup made by the core: charts, formulas. No part of the address is in it unescaped. */
export function made(markup: string): DocumentFragment {
  const holder = document.createElement("template");
  holder.innerHTML = markup;
  return holder.content;
}

/** Numbers in words with their minus sign; commands, which are typed, keep the hyphen. */
export const minus = (words: string): string => words.replace(/(^|[\s(=,[±])-(?=\.?\d)/g, "$1−");

/** The sign that the program writes as +-. */
export const plusMinus = (words: string): string => words.replaceAll("+-", "±");

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

/** Copies an element's text, or selects it if the browser denies access to the clipboard. Returns what was done, in
 *  words. */
export async function copied(from: HTMLElement): Promise<string> {
  try {
    await navigator.clipboard.writeText(from.textContent ?? "");
    return "Copied.";
  } catch {
    window.getSelection()?.selectAllChildren(from);
    return "Selected: copy it with the keyboard.";
  }
}

let channel: MessageChannel | undefined;
const waiting: (() => void)[] = [];

/** Ends the task of the page's thread: what follows is another one, before which the browser may paint. */
export function newTask(): Promise<void> {
  if (!channel) (channel = new MessageChannel()).port1.onmessage = (): void => waiting.shift()?.();
  return new Promise((done) => { waiting.push(done); channel!.port2.postMessage(0); });
}

/** Saves text as a file of the user. */
export function download(name: string, text: string): void {
  const url = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** Announces a line to screen readers, at most once a second, the last one always. */
export class Speaker {
  private reported = 0;
  private timer = 0;
  constructor(private readonly at: HTMLElement) {}
  say(line: string): void {
    window.clearTimeout(this.timer);
    const wait = Math.max(0, this.reported + 1000 - performance.now());
    this.timer = window.setTimeout(() => {
      this.reported = performance.now();
      if (this.at.textContent !== line) this.at.textContent = line;
    }, wait);
  }
}
