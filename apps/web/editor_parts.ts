// CodeMirror, which takes longer to evaluate than the rest of the page: scripts of its own, one for each of its packages
// (apps/web/vendor/codemirror/bundle.sh), that run when the first editor needs them.
import { newTask } from "./dom";
import type * as Parts from "./vendor/codemirror/editor";

const scope = globalThis as { crescentEditor?: typeof Parts };
let next = 0;

/** Runs the next script. */
function run(): void {
  const parts = document.querySelectorAll("script.editor"), script = document.createElement("script");
  script.textContent = parts[next]!.textContent;
  document.head.append(script); // runs it
  ++next;
}
const missing = (): boolean => !(scope.crescentEditor && "javascript" in scope.crescentEditor); // what the last one adds

/** Runs all of it, in a task for each package. */
export async function loadEditor(): Promise<void> {
  while (missing()) {
    run();
    await newTask();
  }
}

export function editorParts(): typeof Parts {
  while (missing()) run();
  return scope.crescentEditor!;
}
