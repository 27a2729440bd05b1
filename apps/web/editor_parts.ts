// CodeMirror, which takes longer to evaluate than the rest of the page: a script of its own that runs when the first editor
// or the first export needs it (apps/web/pack.mjs).
import type * as Parts from "./vendor/codemirror/editor";

const scope = globalThis as { crescentEditor?: typeof Parts };

export function editorParts(): typeof Parts {
  if (!scope.crescentEditor) {
    const script = document.createElement("script");
    script.textContent = document.getElementById("editor")!.textContent;
    document.head.append(script); // runs it
  }
  return scope.crescentEditor!;
}
