// What each value in the code of a sampler is: a number, an array of so many, a light, a draw. Found from the calls of
// sample(wo, u, at) and pdf(wo, wi, at) on; a statement in which it cannot be found is one that has no translation.
import { Declared, Expression, Fn, Kind, read, Statement, Target, Untranslated, Variable, variable } from "./syntax";

export const number: Kind = { is: "number" }, three: Kind = { is: "array", of: number, size: 3 };
const bool: Kind = { is: "bool" }, nothing: Kind = { is: "null" }, draw: Kind = { is: "draw" };
const constants = ["PI", "E", "SQRT2", "SQRT1_2", "LN2", "LN10", "LOG2E", "LOG10E"];
/** How many arguments each function of Math takes; 0: two or more. */
export const math: Readonly<Record<string, number>> = {
  abs: 1, sqrt: 1, cbrt: 1, sin: 1, cos: 1, tan: 1, asin: 1, acos: 1, atan: 1, atan2: 2, sinh: 1, cosh: 1, tanh: 1, asinh: 1, acosh: 1, atanh: 1,
  exp: 1, expm1: 1, log: 1, log1p: 1, log2: 1, log10: 1, pow: 2, floor: 1, ceil: 1, trunc: 1, round: 1, sign: 1, fround: 1, hypot: 2, min: 0, max: 0,
};
const members: Readonly<Record<string, Readonly<Record<string, Kind>>>> = {
  context: { s: number, alpha: number, rho_d: three, rho_s: number, lights: { is: "lights" } },
  light: { kind: { is: "string" }, radius: number, radiance: three, position: three, normal: three, edge_u: three, edge_v: three, shines: bool },
  draw: { wi: three, pdf: number },
};

export interface Program {
  statements: Statement[];
  numbers: number; // that a sample takes
  context: boolean; uses: string[]; // whether its functions take one, and what of it
  early: boolean; // functions are called while the file is read
  functions: ReadonlyMap<string, Fn>;
}

const same = (a: Kind, b: Kind): boolean => a.is === "array" && b.is === "array" ? a.size === b.size && same(a.of, b.of) : a.is === b.is;
const optional = (kind: Kind): boolean => kind.is === "draw" || kind.is === "light";
export const plain = (e: Expression): Expression => (e.is === "group" ? plain(e.of) : e);

class Scope {
  private readonly names = new Map<string, Variable>();
  constructor(private readonly outer: Scope | undefined, readonly fn: Fn | undefined) {}
  add(v: Variable): Variable {
    if (this.fn) v.owner = this.fn;
    this.names.set(v.name, v);
    return v;
  }
  find(name: string): Variable | undefined { return this.names.get(name) ?? this.outer?.find(name); }
}

class Finder {
  readonly uses = new Set<string>();
  early = false;
  private readonly scopes = new Map<Fn, Scope>(); // where a function was declared
  private temporaries = 0;

  private lost(e: { line: number }, what: string): never { throw new Untranslated(e.line, what); }
  private both(a: Kind, b: Kind, e: { line: number }): Kind {
    if (a.is === "null" && optional(b)) return b;
    return same(a, b) || (b.is === "null" && optional(a)) ? a : this.lost(e, "a value that is of one kind here and of another there");
  }

  /** All statements of a block: functions first, as in JavaScript; those that cannot be translated become comments. */
  block(list: Statement[], scope: Scope): void {
    for (const s of list) {
      if (s.is === "function") scope.add(s.v), this.scopes.set(s.v.fn!, scope);
      if (s.is === "lost") for (const [, name] of s.source.matchAll(/\b(?:const|let|var|function)\s+([A-Za-z_$][\w$]*)/g)) if (!scope.find(name!)) scope.add(variable(name!));
    }
    for (let k = 0; k < list.length; ++k) {
      const s = list[k]!;
      try {
        this.statement(s, scope);
      } catch (error) {
        if (!(error instanceof Untranslated)) throw error;
        list[k] = { is: "lost", line: error.line, what: error.what, source: s.source };
      }
    }
  }

  private statement(s: Statement, scope: Scope): void {
    const inner = (): Scope => new Scope(scope, scope.fn);
    switch (s.is) {
      case "declare": s.all = s.all.flatMap((one) => this.declare(one, scope, s.line)); return;
      case "do": for (const e of s.all) this.kind(e, scope); return;
      case "return": {
        const kind: Kind = s.value ? this.kind(s.value, scope) : { is: "void" }, fn = scope.fn;
        if (!fn) return this.lost(s, "a return outside of a function");
        fn.returns = fn.returns ? this.both(fn.returns, kind, s) : kind;
        return;
      }
      case "if": this.test(s.test, scope); this.block(s.yes, inner()); if (s.no) this.block(s.no, inner()); return;
      case "while": case "repeat": this.test(s.test, scope); this.block(s.body, inner()); return;
      case "block": this.block(s.body, inner()); return;
      case "each": {
        const of = this.kind(s.of, scope), within = inner();
        if (of.is !== "array" && of.is !== "lights") this.lost(s, "a loop over what is no array");
        within.add(s.v).kind = of.is === "array" ? of.of : { is: "light" };
        return this.block(s.body, within);
      }
      case "count": {
        const within = inner();
        s.from = s.from.flatMap((one) => this.declare(one, within, s.line));
        if (s.from.some(({ target }) => target.is !== "one" || target.v.kind?.is !== "number")) this.lost(s, "a loop whose counters are no numbers");
        if (s.test) this.test(s.test, within);
        for (const e of s.step) this.kind(e, within);
        this.block(s.body, new Scope(within, scope.fn));
        const counter = counted(s);
        if (counter) counter.v.counts = true;
        return;
      }
      case "function": return;
      default:
    }
  }

  private declare({ target, value }: Declared, scope: Scope, line: number): Declared[] {
    if (value?.is === "function" && target.is === "one") {
      this.scopes.set(value.fn, scope);
      scope.add(target.v);
      if (!target.v.constant) this.lost({ line }, "a function in a variable");
      return [{ target, value }];
    }
    if (!value) {
      if (target.is === "one") scope.add(target.v);
      return [{ target }];
    }
    const kind = this.kind(value, scope);
    if (target.is === "one") {
      if (kind.is === "null" || kind.is === "void") this.lost({ line }, "a variable whose kind is not known from its first value");
      scope.add(target.v).kind = kind;
      return [{ target, value }];
    }
    return this.unpacked(target, kind, value, scope, line);
  }
  /** A pattern as what it represents, but for a whole array, which both languages have. */
  private unpacked(target: Exclude<Target, { is: "one" }>, kind: Kind, value: Expression, scope: Scope, line: number): Declared[] {
    const out: Declared[] = [];
    if (target.is === "list" && kind.is === "array" && kind.size === target.all.length) {
      for (const v of target.all) scope.add(v).kind = kind.of;
      return [{ target, value }];
    }
    let from = plain(value);
    if (from.is !== "name") {
      const v = variable(`parts${++this.temporaries > 1 ? this.temporaries : ""}`);
      scope.add(v).kind = kind;
      out.push({ target: { is: "one", v }, value });
      from = { is: "name", name: v.name, line };
    }
    const source = from, take = (v: Variable, e: Expression): void => {
      const kind = this.kind(e, scope);
      scope.add(v).kind = kind;
      out.push({ target: { is: "one", v }, value: e });
    };
    if (target.is === "fields") for (const [name, v] of target.all) take(v, { is: "member", of: { ...source }, name, line });
    else target.all.forEach((v, k) => take(v, { is: "element", of: { ...source }, index: { is: "number", text: String(k), line }, line }));
    return out;
  }

  private test(e: Expression, scope: Scope): void {
    const kind = this.kind(e, scope, true);
    if (!["bool", "number", "light", "draw"].includes(kind.is)) this.lost(e, "a condition that is no comparison");
  }

  kind(e: Expression, scope: Scope, condition = false): Kind { return (e.kind = this.found(e, scope, condition)); }
  private numeric(e: Expression, scope: Scope): Kind { return this.kind(e, scope).is === "number" ? number : this.lost(e, "arithmetic with what is no number"); }

  private found(e: Expression, scope: Scope, condition: boolean): Kind {
    switch (e.is) {
      case "number": return number;
      case "string": return { is: "string" };
      case "bool": return bool;
      case "null": return nothing;
      case "group": return this.kind(e.of, scope, condition);
      case "name": {
        const v = scope.find(e.name);
        if (!v) return e.name === "NaN" || e.name === "Infinity" ? number : this.lost(e, `\`${e.name}\``);
        if (v.fn || !v.kind) return this.lost(e, v.fn ? "a function as a value" : `\`${e.name}\`, which has no value with a translation,`);
        e.v = v;
        ++v.reads;
        return v.kind;
      }
      case "sign": return this.numeric(e.of, scope);
      case "not": this.test(e.of, scope); return bool;
      case "step": this.assigned(e.of, number, scope); return number;
      case "arithmetic": this.numeric(e.a, scope); return this.numeric(e.b, scope);
      case "compare": {
        const a = this.kind(e.a, scope), b = this.kind(e.b, scope);
        if (e.op === "==" || e.op === "!=") this.both(a, b, e);
        else if (a.is !== "number" || b.is !== "number") this.lost(e, "a comparison of what are no numbers");
        if (a.is === "array" || a.is === "context") this.lost(e, "a comparison of arrays");
        return bool;
      }
      case "logic":
        this.test(e.a, scope), this.test(e.b, scope);
        if (!condition && (e.a.kind!.is !== "bool" || e.b.kind!.is !== "bool")) this.lost(e, `${e.op} as a value`);
        return bool;
      case "choice": this.test(e.test, scope); return this.both(this.kind(e.yes, scope), this.kind(e.no, scope), e);
      case "assign": {
        const kind = e.op === "=" ? this.kind(e.value, scope) : this.numeric(e.value, scope);
        this.assigned(e.to, kind, scope);
        return kind;
      }
      case "array": {
        if (e.items.length === 0) this.lost(e, "an array without elements");
        const of = e.items.map((item) => this.kind(item, scope)).reduce((a, b) => this.both(a, b, e));
        if (of.is !== "number" && of.is !== "array" && of.is !== "bool") this.lost(e, "an array of this");
        return { is: "array", of, size: e.items.length };
      }
      case "object": {
        const of = (name: string): Kind | undefined => { const field = e.fields.find(([key]) => key === name); return field && this.kind(field[1], scope); };
        const wi = of("wi"), pdf = of("pdf");
        if (e.fields.length !== 2 || !wi || !pdf || !same(wi, three) || pdf.is !== "number") this.lost(e, "an object other than { wi: [x, y, z], pdf: number }");
        return draw;
      }
      case "member": return this.member(e, scope);
      case "element": {
        const of = this.kind(e.of, scope);
        this.numeric(e.index, scope);
        if (of.is === "lights") return { is: "light" };
        if (of.is !== "array") return this.lost(e, "an element of what is no array");
        const index = plain(e.index);
        if (index.is === "number" && !(Number(index.text) < of.size)) this.lost(e, `element ${index.text} of ${of.size}`);
        return of.of;
      }
      case "call": return this.call(e, scope);
      case "function": return this.lost(e, "a function as a value");
    }
  }

  private assigned(to: Expression, kind: Kind, scope: Scope): void {
    const at = plain(to);
    let root = at;
    while (root.is === "element") root = plain(root.of);
    if (root.is !== "name") return this.lost(to, "this assignment");
    const v = scope.find(root.name);
    if (!v || v.fn) return this.lost(to, `\`${root.name}\``);
    if (v.owner !== scope.fn) this.lost(to, "an assignment to a variable outside of the function");
    if (at.is === "name") {
      v.kind = v.kind ? this.both(v.kind, kind, to) : kind;
      at.v = v, at.kind = v.kind;
      ++v.writes;
      return;
    }
    const { reads } = v;
    this.both(this.kind(at, scope), kind, to);
    v.reads = reads;
    if (v.owner && v.owner.parameters.some((p) => p.is === "one" && p.v === v)) this.lost(to, "an assignment to an element of an argument");
    v.edited = true;
  }

  private member(e: Expression & { is: "member" }, scope: Scope): Kind {
    const from = plain(e.of);
    if (from.is === "name" && from.name === "Math" && !scope.find("Math")) return constants.includes(e.name) ? number : this.lost(e, `Math.${e.name}`);
    const of = this.kind(e.of, scope);
    if (e.name === "length" && (of.is === "array" || of.is === "lights")) return number;
    const kind = members[of.is]?.[e.name];
    if (of.is === "context" && kind) this.uses.add(e.name);
    return kind ?? this.lost(e, `.${e.name}`);
  }

  private call(e: Expression & { is: "call" }, scope: Scope): Kind {
    const to = plain(e.callee);
    if (to.is === "name") {
      const v = scope.find(to.name);
      if (!v?.fn) return this.lost(e, `${to.name}()`);
      e.fn = v.fn;
      return this.called(v.fn, e.args.map((arg) => this.kind(arg, scope)), e, scope);
    }
    if (to.is !== "member") return this.lost(e, "this call");
    const from = plain(to.of), count = math[to.name];
    if (from.is === "name" && from.name === "Math" && !scope.find("Math")) {
      if (count === undefined || (count > 0 ? e.args.length !== count : e.args.length < 2)) this.lost(e, `Math.${to.name} of ${e.args.length} argument${e.args.length === 1 ? "" : "s"}`);
      for (const arg of e.args) this.numeric(arg, scope);
      e.math = to.name;
      return number;
    }
    if (from.is === "name" && !scope.find(from.name)) return this.lost(e, `${from.name}.${to.name}()`);
    const of = this.kind(to.of, scope);
    if (of.is === "array" && to.name === "slice") {
      const [first, end] = e.args.map((arg) => (arg.is === "number" ? Number(arg.text) : NaN)), last = e.args.length > 1 ? end! : of.size;
      if (e.args.length < 1 || e.args.length > 2 || !(first! < last && last <= of.size)) this.lost(e, "a slice by other than two constants");
      e.method = "slice";
      return { is: "array", of: of.of, size: last - first! };
    }
    const fn = e.args[0]?.is === "function" ? e.args[0].fn : undefined;
    if (of.is !== "array" || to.name !== "map" || !fn || e.args.length !== 1 || Array.isArray(fn.body)) return this.lost(e, `.${to.name}()`);
    this.scopes.set(fn, scope);
    const kind = this.called(fn, [of.of, number].slice(0, fn.parameters.length), e, scope), [, index] = fn.parameters;
    if (kind.is !== "number" && kind.is !== "array") this.lost(e, ".map() to what is no number");
    if (index?.is === "one") index.v.counts = true;
    e.method = "map";
    return { is: "array", of: kind, size: of.size };
  }

  /** What a function returns for arguments of these kinds. */
  called(fn: Fn, given: Kind[], at: { line: number }, from?: Scope): Kind {
    if (from && !from.fn) this.early = true;
    const takes = given.slice(0, fn.parameters.length);
    if (takes.length < fn.parameters.length) this.lost(at, `a call of ${fn.name} without all of its arguments`);
    if (fn.state === "new") {
      fn.state = "busy", fn.takes = takes;
      if (fn.name && !Array.isArray(fn.body)) fn.body = [{ is: "return", value: fn.body, line: fn.line, source: "" }];
      const scope = new Scope(this.scopes.get(fn), fn);
      fn.parameters.forEach((target, k) => {
        if (target.is === "one") scope.add(target.v).kind = takes[k]!;
        else this.pattern(fn, k, target, scope);
      });
      if (Array.isArray(fn.body)) this.block(fn.body, scope);
      else fn.returns = this.kind(fn.body, scope);
      fn.state = "done";
    } else if (takes.some((kind, k) => !same(kind, fn.takes[k]!))) this.lost(at, `a call of ${fn.name} with arguments of other kinds than before`);
    return fn.returns ?? (fn.state === "busy" ? number : { is: "void" });
  }
  /** A pattern in place of a parameter: a parameter, and its declaration. */
  private pattern(fn: Fn, k: number, target: Exclude<Target, { is: "one" }>, scope: Scope): void {
    const v = variable(`argument${k + 1}`);
    scope.add(v).kind = fn.takes[k]!;
    fn.parameters[k] = { is: "one", v };
    if (Array.isArray(fn.body)) fn.body.unshift({ is: "declare", all: [{ target, value: { is: "name", name: v.name, line: fn.line } }], line: fn.line, source: "" });
    else this.lost(fn, "this pattern");
  }
}

/** A loop `for (let i = 0; i < 8; ++i)` over integers: its parts. */
export function counted(s: Statement & { is: "count" }): { v: Variable; from: string; op: string; to: Expression; by: number } | undefined {
  const [first, second] = s.from, [step, more] = s.step, test = s.test && plain(s.test);
  if (!first || second || more || first.target.is !== "one" || first.value?.is !== "number" || !step || test?.is !== "compare") return undefined;
  const { v } = first.target, left = plain(test.a), to = plain(test.b), moved = step.is === "step" || step.is === "assign" ? plain(step.is === "step" ? step.of : step.to) : undefined;
  const by = step.is === "step" ? step.by : step.is === "assign" && step.value.is === "number" && /^[+-]=$/.test(step.op) ? Number(`${step.op[0]}${step.value.text}`) : NaN;
  const whole = (e: Expression): boolean => (e.is === "number" && Number.isInteger(Number(e.text))) || (e.is === "member" && e.name === "length");
  if (left.is !== "name" || left.v !== v || moved?.is !== "name" || moved.v !== v || v.writes !== 1 || !whole(to) || !whole(first.value) || !Number.isInteger(by)) return undefined;
  return (by > 0 ? /^<=?$/ : /^>=?$/).test(test.op) ? { v, from: first.value.text, op: test.op, to, by } : undefined;
}

/** The program that this code is: `code` has the functions sample and pdf, and f if there is one. */
export function understood(code: string): Program {
  const statements = read(code), finder = new Finder(), file = new Scope(undefined, undefined);
  for (const s of statements) if (s.is === "declare") for (const { target, value } of s.all) if (target.is === "one" && value?.is === "function") file.add(target.v);
  finder.block(statements, file);
  const numbers = file.find("numbers"), given = statements.flatMap((s) => (s.is === "declare" ? s.all : [])).find(({ target }) => target.is === "one" && target.v === numbers)?.value;
  const count = given?.is === "number" ? Number(given.text) : 2, functions = new Map<string, Fn>();
  const roots: Record<string, Kind[]> = { sample: [three, { is: "array", of: number, size: count }], pdf: [three, three], f: [three, three] };
  for (const [name, kinds] of Object.entries(roots)) {
    const fn = file.find(name)?.fn;
    if (!fn) continue;
    functions.set(name, fn);
    try {
      if (fn.state === "new") finder.called(fn, [...kinds, { is: "context" }], fn);
    } catch (error) {
      if (!(error instanceof Untranslated)) throw error;
      fn.state = "done", fn.body = [{ is: "lost", line: error.line, what: error.what, source: "" }];
    }
  }
  const context = [...functions.values()].some(({ parameters }) => parameters.length > 2);
  return { statements, numbers: count, context, uses: Object.keys(members["context"]!).filter((name) => finder.uses.has(name)), early: finder.early, functions };
}

/** A name that the other language does not use otherwise. */
export const spelled = (name: string, reserved: ReadonlySet<string>): string => {
  const plain = name.replaceAll("$", "_S");
  return reserved.has(plain) ? `${plain}_` : plain;
};

/** A statement without a translation, in comments. */
export function lostLines(s: Statement & { is: "lost" }, mark: string): string[] {
  return [`${mark} line ${s.line}: ${s.what} has no translation:`, ...s.source.split("\n").map((line) => `${mark}   ${line}`.trimEnd())];
}
/** What is printed has no effect on the numbers. */
export const prints = (s: Statement): boolean => /^console\.\w+\(/.test(s.source);
