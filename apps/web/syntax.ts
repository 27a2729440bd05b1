// The code of a sampler as a tree of the part of JavaScript that can be translated into other languages
// (apps/web/to_cpp.ts, apps/web/to_python.ts). What cannot is kept as text, at the place of its statement.
import { editorParts } from "./editor_parts";
import type { SyntaxNode } from "./vendor/codemirror/editor";

/** What a value is: `apps/web/kinds.ts` finds it. */
export type Kind =
  | { is: "number" | "bool" | "string" | "null" | "draw" | "light" | "lights" | "context" | "void" }
  | { is: "array"; of: Kind; size: number };

export interface Variable {
  name: string; constant: boolean;
  kind?: Kind; fn?: Fn; owner?: Fn; // the function that has it; none: the file
  reads: number; writes: number; edited: boolean; // an element was assigned
  counts: boolean; // an integer: of a counting loop
}
export interface Fn { name: string; parameters: Target[]; body: Statement[] | Expression; line: number; state: "new" | "busy" | "done"; takes: Kind[]; returns?: Kind }
export type Target = { is: "one"; v: Variable } | { is: "list"; all: Variable[] } | { is: "fields"; all: [string, Variable][] };

interface Typed { kind?: Kind; line: number }
export type Expression = Typed & (
  | { is: "number"; text: string } | { is: "string"; value: string } | { is: "bool"; value: boolean } | { is: "null" }
  | { is: "name"; name: string; v?: Variable } | { is: "group"; of: Expression } | { is: "sign" | "not"; op: string; of: Expression }
  | { is: "step"; by: 1 | -1; before: boolean; of: Expression } | { is: "arithmetic" | "compare" | "logic"; op: string; a: Expression; b: Expression }
  | { is: "choice"; test: Expression; yes: Expression; no: Expression } | { is: "assign"; op: string; to: Expression; value: Expression }
  | { is: "member"; of: Expression; name: string } | { is: "element"; of: Expression; index: Expression }
  | { is: "call"; callee: Expression; args: Expression[]; fn?: Fn; math?: string; method?: "map" | "slice" }
  | { is: "array"; items: Expression[] } | { is: "object"; fields: [string, Expression][] } | { is: "function"; fn: Fn });

export type Declared = { target: Target; value?: Expression };
export type Statement = { line: number; source: string; note?: string } & (
  | { is: "declare"; all: Declared[] } | { is: "do"; all: Expression[] } | { is: "return"; value?: Expression }
  | { is: "if"; test: Expression; yes: Statement[]; no?: Statement[] }
  | { is: "count"; from: Declared[]; test?: Expression; step: Expression[]; body: Statement[] }
  | { is: "each"; v: Variable; of: Expression; body: Statement[] } | { is: "while"; test: Expression; body: Statement[] } | { is: "repeat"; test: Expression; body: Statement[] }
  | { is: "leave"; word: "break" | "continue" } | { is: "block"; body: Statement[] } | { is: "function"; v: Variable }
  | { is: "comment"; text: string } | { is: "lost"; what: string });

/** What has no translation: `what` in the words of a sentence. */
export class Untranslated extends Error {
  constructor(readonly line: number, readonly what: string) { super(what); }
}

export const variable = (name: string, constant = true): Variable => ({ name, constant, reads: 0, writes: 0, edited: false, counts: false });

class Reader {
  constructor(private readonly code: string) {}

  private text(n: SyntaxNode): string { return this.code.slice(n.from, n.to); }
  private line(n: SyntaxNode): number { return this.code.slice(0, n.from).split("\n").length; }
  private lost(n: SyntaxNode, what: string): never { throw new Untranslated(this.line(n), what); }
  private parts(n: SyntaxNode): SyntaxNode[] {
    const out: SyntaxNode[] = [];
    for (let c = n.firstChild; c; c = c.nextSibling) if (!/Comment$/.test(c.name)) out.push(c);
    return out;
  }
  /** Those between its punctuation. */
  private inner(n: SyntaxNode): SyntaxNode[] { return this.parts(n).filter(({ name }) => !["(", ")", "[", "]", "{", "}", ",", ";"].includes(name)); }

  statements(block: SyntaxNode): Statement[] {
    const out: Statement[] = [];
    for (let n = block.firstChild; n; n = n.nextSibling) {
      const last = out[out.length - 1];
      if (/Comment$/.test(n.name)) this.comment(n, last, out);
      else if (!["{", "}", ";"].includes(n.name)) out.push(this.statement(n, out));
    }
    return out;
  }
  private comment(n: SyntaxNode, last: Statement | undefined, out: Statement[]): void {
    const text = this.text(n).replace(/^\/\/ ?|^\/\*+ ?| ?\*+\/$/g, "").replace(/\n\s*\* ?/g, "\n");
    const before = this.code.slice(this.code.lastIndexOf("\n", n.from) + 1, n.from).trim();
    if (last && before && !before.endsWith("{") && !last.note && n.name === "LineComment") last.note = text;
    else out.push({ is: "comment", text, line: this.line(n), source: "" });
  }

  private statement(n: SyntaxNode, out: Statement[]): Statement {
    const line = this.line(n), source = this.text(n);
    let made: Statement;
    try {
      if (this.isBroken(n)) this.lost(n, "what is no JavaScript");
      made = { ...this.plain(n), line, source } as Statement;
    } catch (error) {
      if (!(error instanceof Untranslated)) throw error;
      return { is: "lost", line: error.line, what: error.what, source };
    }
    const within = (at: SyntaxNode): void => { // comments outside of its blocks
      for (let c = at.firstChild; c; c = c.nextSibling)
        if (/Comment$/.test(c.name)) this.comment(c, c.from > n.from && !c.nextSibling ? made : undefined, out);
        else if (!/Block|Statement|Declaration$/.test(c.name)) within(c);
    };
    within(n);
    return made;
  }

  /** Whether there is an error in it, outside of its blocks. */
  private isBroken(n: SyntaxNode): boolean { return n.name === "⚠" || this.parts(n).some((part) => part.name !== "Block" && this.isBroken(part)); }

  private plain(n: SyntaxNode): Parts {
    const parts = this.parts(n);
    switch (n.name) {
      case "VariableDeclaration": return { is: "declare", all: this.declared(n) };
      case "FunctionDeclaration": {
        const v = variable(this.text(parts[1]!));
        v.fn = this.fn(n, v.name);
        return { is: "function", v };
      }
      case "ExpressionStatement": return { is: "do", all: this.sequence(parts[0]!) };
      case "ReturnStatement": {
        const value = parts.find(({ name }) => name !== "return" && name !== ";");
        return value ? { is: "return", value: this.expression(value) } : { is: "return" };
      }
      case "IfStatement": {
        const [, test, yes, , no] = parts;
        return { is: "if", test: this.expression(test!), yes: this.body(yes!), ...(no ? { no: this.body(no) } : {}) };
      }
      case "ForStatement": return this.loop(parts);
      case "WhileStatement": return { is: "while", test: this.expression(parts[1]!), body: this.body(parts[2]!) };
      case "DoStatement": return { is: "repeat", body: this.body(parts[1]!), test: this.expression(parts[3]!) };
      case "BreakStatement": case "ContinueStatement":
        if (parts.some(({ name }) => name === "Label")) this.lost(n, "a labelled jump");
        return { is: "leave", word: n.name === "BreakStatement" ? "break" : "continue" };
      case "Block": return { is: "block", body: this.statements(n) };
      default: return this.lost(n, `a ${n.name.replace(/Statement|Declaration/, "").toLowerCase()} statement`);
    }
  }
  private body(n: SyntaxNode): Statement[] {
    if (n.name === "Block") return this.statements(n);
    return [this.statement(n, [])];
  }
  private loop(parts: SyntaxNode[]): Parts {
    const [, spec, body] = parts, inside = this.parts(spec!).filter(({ name }) => name !== "(" && name !== ")");
    if (spec!.name === "ForOfSpec") {
      const [word, name, , of] = inside;
      if (name!.name !== "VariableDefinition") this.lost(spec!, "a pattern in a loop");
      return { is: "each", v: variable(this.text(name!), this.text(word!) === "const"), of: this.expression(of!), body: this.body(body!) };
    }
    if (spec!.name !== "ForSpec") this.lost(spec!, "a loop over the keys of an object");
    const first = inside[0]?.name === "VariableDeclaration" ? inside.shift()! : undefined;
    if (!first && inside[0]?.name !== ";") this.lost(spec!, "a loop that declares no counter");
    if (inside[0]?.name === ";") inside.shift(); // of `for (; ...)`
    const at = inside.findIndex(({ name }) => name === ";"), test = at > 0 ? inside[0] : undefined, step = inside[at + 1];
    return { is: "count", from: first ? this.declared(first) : [], ...(test ? { test: this.expression(test) } : {}), step: step ? this.sequence(step) : [], body: this.body(body!) };
  }

  private declared(n: SyntaxNode): Declared[] {
    const [word, ...rest] = this.parts(n).filter(({ name }) => name !== ";" && name !== ","), constant = this.text(word!) === "const", out: Declared[] = [];
    for (let k = 0; k < rest.length; ++k) {
      const target = this.target(rest[k]!, constant);
      if (rest[k + 1]?.name !== "Equals") { out.push({ target }); continue; }
      const value = this.expression(rest[k += 2]!);
      if (value.is === "function" && target.is === "one") target.v.fn = value.fn, value.fn.name = target.v.name;
      out.push({ target, value });
    }
    return out;
  }
  private target(n: SyntaxNode, constant: boolean): Target {
    const one = (at: SyntaxNode): Variable => at.name === "VariableDefinition" ? variable(this.text(at), constant) : this.lost(at, "this pattern");
    if (n.name === "VariableDefinition") return { is: "one", v: one(n) };
    if (n.name === "ArrayPattern") return { is: "list", all: this.inner(n).map(one) };
    if (n.name !== "ObjectPattern") return this.lost(n, "this pattern");
    return { is: "fields", all: this.inner(n).map((property) => {
      const [key, , to] = this.parts(property);
      return [this.text(key!), one(to ?? key!)];
    }) };
  }
  private fn(n: SyntaxNode, name: string): Fn {
    const parts = this.parts(n), list = parts.find((part) => part.name === "ParamList"), body = parts[parts.length - 1]!;
    if (!list || parts.some((part) => part.name === "async" || part.name === "Star")) return this.lost(n, "this function");
    const parameters = this.inner(list).map((part) => this.target(part, false));
    return { name, parameters, body: body.name === "Block" ? this.statements(body) : this.expression(body), line: this.line(n), state: "new", takes: [] };
  }

  private sequence(n: SyntaxNode): Expression[] { return n.name === "SequenceExpression" ? this.inner(n).map((part) => this.expression(part)) : [this.expression(n)]; }
  private expression(n: SyntaxNode): Expression { return { ...this.bare(n), line: this.line(n) } as Expression; }
  private bare(n: SyntaxNode): DistributiveOmit<Expression, "line"> {
    const parts = this.parts(n), text = this.text(n), at = (k: number): Expression => this.expression(parts[k]!);
    switch (n.name) {
      case "Number": {
        if (/n$/.test(text) && !/^0x/i.test(text)) this.lost(n, "a BigInt");
        return { is: "number", text: /^(0[xob]|.*_)/i.test(text) ? String(Number(text.replaceAll("_", ""))) : text.replace(/^\./, "0.").replace(/\.$/, "") };
      }
      case "String": return { is: "string", value: text.slice(1, -1) };
      case "BooleanLiteral": return { is: "bool", value: text === "true" };
      case "null": return { is: "null" };
      case "VariableName": return text === "undefined" ? { is: "null" } : { is: "name", name: text };
      case "ParenthesizedExpression": return { is: "group", of: at(1) };
      case "UnaryExpression": case "PostfixExpression": {
        const before = n.name === "UnaryExpression", op = this.text(parts[before ? 0 : 1]!), of = at(before ? 1 : 0);
        if (op === "++" || op === "--") return { is: "step", by: op === "++" ? 1 : -1, before, of };
        if (op === "!") return { is: "not", op, of };
        return op === "-" || op === "+" ? { is: "sign", op, of } : this.lost(n, `the operator ${op}`);
      }
      case "BinaryExpression": {
        const op = this.text(parts[1]!), a = at(0), b = at(2);
        if (["+", "-", "*", "/", "%", "**"].includes(op)) return { is: "arithmetic", op, a, b };
        if (["<", "<=", ">", ">=", "==", "===", "!=", "!=="].includes(op)) return { is: "compare", op: op.replace(/^([=!]=)=$/, "$1"), a, b };
        return op === "&&" || op === "||" ? { is: "logic", op, a, b } : this.lost(n, `the operator ${op}`);
      }
      case "ConditionalExpression": return { is: "choice", test: at(0), yes: at(2), no: at(4) };
      case "AssignmentExpression": {
        const op = this.text(parts[1]!);
        if (!["=", "+=", "-=", "*=", "/="].includes(op)) this.lost(n, `the operator ${op}`);
        return { is: "assign", op, to: at(0), value: at(2) };
      }
      case "MemberExpression":
        if (parts[1]!.name === ".") return { is: "member", of: at(0), name: this.text(parts[2]!) };
        return parts[1]!.name === "[" ? { is: "element", of: at(0), index: at(2) } : this.lost(n, "optional chaining");
      case "CallExpression": return { is: "call", callee: at(0), args: this.inner(parts[1]!).map((part) => this.expression(part)) };
      case "ArrayExpression": return { is: "array", items: this.inner(n).map((part) => this.expression(part)) };
      case "ObjectExpression": return { is: "object", fields: this.inner(n).map((property) => {
        const [key, colon, value] = this.parts(property), name = this.text(key!);
        if (!colon) return [name, { is: "name", name, line: this.line(key!) }];
        return colon.name === ":" ? [name, this.expression(value!)] : this.lost(property, "a method in an object");
      }) };
      case "ArrowFunction": case "FunctionExpression": return { is: "function", fn: this.fn(n, "") };
      default: return this.lost(n, n.name === "Spread" ? "the spread ..." : `\`${text.split("\n")[0]}\``);
    }
  }
}
type Parts = DistributiveOmit<Statement, "line" | "source">;
type DistributiveOmit<T, K extends string> = T extends unknown ? Omit<T, K> : never;

export function read(code: string): Statement[] { return new Reader(code).statements(editorParts().javascript().language.parser.parse(code).topNode); }
