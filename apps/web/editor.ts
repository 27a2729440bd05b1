// The editor of a sampler's code: CodeMirror 6 with the language's colours, and errors at their line.
import { newTask } from "./dom";
import { editorParts, loadEditor } from "./editor_parts";
import type { EditorView } from "./vendor/codemirror/editor";

/** The colours of the language. */
function colours(): object {
  const { HighlightStyle, tags } = editorParts();
  return HighlightStyle.define([
    { tag: tags["keyword"], color: "var(--code-word)" }, { tag: [tags["number"], tags["bool"], tags["null"]], color: "var(--code-number)" },
    { tag: [tags["string"], tags["regexp"]], color: "var(--code-text)" }, { tag: tags["comment"], color: "var(--soft)", fontStyle: "italic" },
  ]);
}

const theme = {
  "&": { fontSize: "0.86rem", border: "1px solid var(--soft)", borderRadius: "4px", background: "var(--ground)", color: "var(--ink)" },
  "&.cm-focused": { outline: "3px solid var(--accent)", outlineOffset: "2px" },
  ".cm-scroller": { fontFamily: "ui-monospace, 'DejaVu Sans Mono', monospace", lineHeight: "1.5", maxHeight: "34rem", minHeight: "14rem", overflow: "auto" },
  ".cm-content": { caretColor: "var(--ink)" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  ".cm-gutters": { background: "var(--tint)", color: "var(--soft)", border: "none" },
  ".cm-activeLine, .cm-activeLineGutter": { background: "color-mix(in srgb, var(--tint) 60%, transparent)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { background: "color-mix(in srgb, var(--accent) 30%, transparent)" },
  ".cm-matchingBracket": { outline: "1px solid var(--accent)" },
  ".cm-diagnostic": { color: "var(--ink)", background: "var(--ground)" }, ".cm-tooltip": { background: "var(--ground)", border: "1px solid var(--soft)" },
};

export class Editor {
  private readonly view: EditorView;
  private quiet = false;
  changed = (): void => {}; // called when the user has changed the code

  /** In several tasks: the packages, the view, the language. */
  static async opened(parent: HTMLElement, label: string): Promise<Editor> {
    await loadEditor();
    const { Compartment, javascript, syntaxHighlighting } = editorParts(), language = new Compartment(), editor = new Editor(parent, label, language.of([]));
    for (const extension of [javascript(), [javascript(), syntaxHighlighting(colours())]]) {
      await newTask();
      editor.view.dispatch({ effects: language.reconfigure(extension) });
    }
    await newTask();
    return editor;
  }

  private constructor(parent: HTMLElement, label: string, language: object) {
    const parts = editorParts(), { EditorState, EditorView, keymap } = parts;
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        doc: "",
        extensions: [
          parts.lineNumbers(), parts.highlightSpecialChars(), parts.history(), parts.drawSelection(), parts.indentOnInput(), parts.bracketMatching(),
          parts.highlightActiveLine(), parts.lintGutter(), language, parts.indentUnit.of("  "),
          keymap.of([...parts.defaultKeymap, ...parts.historyKeymap]), EditorView.theme(theme),
          EditorView.contentAttributes.of({ "aria-label": label, spellcheck: "false" }),
          EditorView.updateListener.of((update) => { if (update.docChanged && !this.quiet) this.changed(); }),
        ],
      }),
    });
    const { scrollDOM } = this.view as unknown as { scrollDOM: HTMLElement };
    scrollDOM.tabIndex = -1; // its content has the focus
  }

  get code(): string { return this.view.state.doc.toString(); }
  set code(code: string) {
    this.quiet = true;
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: code } });
    this.quiet = false;
  }

  focus(): void { this.view.focus(); }

  /** The line of the first place that is no JavaScript; 0 if there is none. */
  get brokenLine(): number {
    let from = -1;
    editorParts().syntaxTree(this.view.state).iterate({ enter: (node) => { if (node.type.isError && from < 0) from = node.from; } });
    if (from < 0) return 0;
    return this.code.slice(0, from).split("\n").length;
  }

  /** Marks a line, from 1, with a message; 0: none is marked. */
  mark(line: number, message: string, column = 0): void {
    const { doc } = this.view.state, { setDiagnostics } = editorParts();
    if (line < 1 || line > doc.lines) return this.view.dispatch(setDiagnostics(this.view.state, []));
    const at = doc.line(line), from = Math.min(at.to, at.from + Math.max(0, column - 1));
    this.view.dispatch(setDiagnostics(this.view.state, [{ from: Math.min(from, Math.max(at.from, at.to - 1)), to: at.to, severity: "error", message }]));
  }
}
