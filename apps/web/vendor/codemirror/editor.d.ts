// The parts of CodeMirror that the page uses, without the types of its packages, which need a later compiler.
export interface Text { readonly length: number; readonly lines: number; line(n: number): { from: number; to: number; text: string }; toString(): string }
export type Extension = object;
export interface EditorState { readonly doc: Text }
export const EditorState: { create(config: { doc: string; extensions: Extension[] }): EditorState; tabSize: { of(n: number): Extension } };
export class Compartment { of(extension: Extension): Extension; reconfigure(extension: Extension): object }
export interface ViewUpdate { docChanged: boolean; state: EditorState }
export class EditorView {
  constructor(config: { state: EditorState; parent: HTMLElement });
  readonly state: EditorState;
  readonly dom: HTMLElement;
  readonly contentDOM: HTMLElement;
  dispatch(...changes: object[]): void;
  focus(): void;
  destroy(): void;
  static updateListener: { of(f: (update: ViewUpdate) => void): Extension };
  static contentAttributes: { of(attributes: Record<string, string>): Extension };
  static theme(spec: Record<string, Record<string, string>>): Extension;
  static lineWrapping: Extension;
}
export interface KeyBinding { key?: string; run?: (view: EditorView) => boolean }
export const keymap: { of(bindings: readonly KeyBinding[]): Extension };
export function lineNumbers(): Extension;
export function highlightActiveLine(): Extension;
export function highlightSpecialChars(): Extension;
export function drawSelection(): Extension;
export const defaultKeymap: readonly KeyBinding[];
export const historyKeymap: readonly KeyBinding[];
export function history(): Extension;
/** A node of a syntax tree: of the grammar in @lezer/javascript. */
export interface SyntaxNode { readonly name: string; readonly from: number; readonly to: number; readonly firstChild: SyntaxNode | null; readonly nextSibling: SyntaxNode | null }
export function javascript(): Extension & { language: { parser: { parse(code: string): { topNode: SyntaxNode } } } };
export const HighlightStyle: { define(rules: { tag: unknown; [style: string]: unknown }[]): object };
export function syntaxHighlighting(style: object): Extension;
export function bracketMatching(): Extension;
export function indentOnInput(): Extension;
export const indentUnit: { of(unit: string): Extension };
export interface Node { name: string; from: number; to: number; type: { isError: boolean } }
export function syntaxTree(state: EditorState): { iterate(walk: { enter(node: Node): void }): void };
export interface Diagnostic { from: number; to: number; severity: "error" | "warning"; message: string }
export function setDiagnostics(state: EditorState, all: readonly Diagnostic[]): object;
export function lintGutter(): Extension;
export const tags: Record<string, unknown>;
