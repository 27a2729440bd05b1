// The code of a sampler in Python, for one row of numbers at a time; apps/web/export.ts adds the loop over arrays.
// Numbers are NumPy's where they come from arguments, so that a division by 0 and the root of -1 are what JavaScript has.
import { counted, lostLines, plain, prints, Program, spelled } from "./kinds";
import { Declared, Expression, Fn, Statement, Variable } from "./syntax";

const reserved = new Set(("False None True and as assert async await break class continue def del elif else except finally for from global if import in is lambda nonlocal not or pass raise return try " +
  "while with yield abs bool crescent element enumerate float int len max min nonzero np range rows sampler draws values").split(" "));
const constants: Readonly<Record<string, string>> = {
  PI: "np.pi", E: "np.e", SQRT2: "np.sqrt(2)", SQRT1_2: "np.sqrt(0.5)", LN2: "np.log(2)", LN10: "np.log(10)", LOG2E: "np.log2(np.e)", LOG10E: "np.log10(np.e)",
};
const functions: Readonly<Record<string, string>> = {
  asin: "arcsin", acos: "arccos", atan: "arctan", atan2: "arctan2", asinh: "arcsinh", acosh: "arccosh", atanh: "arctanh", abs: "abs",
};
const helpers: readonly [string, string[]][] = [
  ["nonzero", ["def nonzero(x):", "    return x < 0 or x > 0"]],
  ["element", ["def element(items, k):", "    return items[int(k)] if 0 <= k < len(items) else None"]],
];

class Printer {
  readonly out: string[] = [];
  private readonly names = new Map<Variable, string>();
  private active: Set<string>[] = [new Set()]; // the names of the blocks around, of this function
  private steps: string[][] = []; // what each loop around does before it continues
  constructor(private readonly program: Program, private readonly file: ReadonlySet<string>) {}

  /** A name of its own, unless no block around has it: a function of Python has one scope. */
  private add(v: Variable, parameter = false): string {
    const first = spelled(v.name, reserved), taken = (name: string): boolean => (this.active.length > 1 && !parameter && this.file.has(name)) || this.active.some((names) => names.has(name));
    let name = first;
    for (let k = 2; taken(name); ++k) name = `${first}_${k}`;
    this.active[this.active.length - 1]!.add(name);
    this.names.set(v, name);
    return name;
  }
  private name(v: Variable): string { return this.names.get(v) ?? this.outer?.name(v) ?? spelled(v.name, reserved); }
  private outer: Printer | undefined;

  // ---- Expressions.

  private test(e: Expression): string {
    const at = plain(e), kind = e.kind?.is;
    if (kind === "number") return `nonzero(${this.text(e)})`;
    return (kind === "light" || kind === "draw") && at.is !== "not" ? `${this.text(e)} is not None` : this.text(e);
  }
  private index(e: Expression): string {
    const at = plain(e);
    return at.is === "number" || (at.is === "name" && at.v?.counts) ? this.text(at) : `int(${this.text(at)})`;
  }
  private operand(e: Expression, ...within: string[]): string { return within.includes(e.is) ? `(${this.text(e)})` : this.text(e); }

  text(e: Expression): string {
    switch (e.is) {
      case "number": return e.text;
      case "string": return JSON.stringify(e.value);
      case "bool": return e.value ? "True" : "False";
      case "null": return "None";
      case "name": return e.v ? this.name(e.v) : e.name === "NaN" ? "np.nan" : "np.inf";
      case "group": return `(${this.text(e.of)})`;
      case "sign": return `${e.op}${this.text(e.of)}`;
      case "not": return e.of.kind?.is === "light" || e.of.kind?.is === "draw" ? `${this.text(e.of)} is None` : `not ${this.test(e.of)}`;
      case "step": return e.before ? `(${this.text(e.of)} := ${this.text(e.of)} ${e.by > 0 ? "+" : "-"} 1)` : `((${this.text(e.of)} := ${this.text(e.of)} ${e.by > 0 ? "+" : "-"} 1) ${e.by > 0 ? "-" : "+"} 1)`;
      case "arithmetic": return e.op === "%" ? `np.fmod(${this.text(e.a)}, ${this.text(e.b)})` : e.op === "**" ? this.power(e.a, e.b) : `${this.text(e.a)} ${e.op} ${this.text(e.b)}`;
      case "compare": {
        const none = e.a.is === "null" || e.b.is === "null";
        return `${this.operand(e.a, "compare", "not")} ${none ? (e.op === "==" ? "is" : "is not") : e.op} ${this.operand(e.b, "compare", "not")}`;
      }
      case "logic": return `${this.test(e.a)} ${e.op === "&&" ? "and" : "or"} ${this.test(e.b)}`;
      case "choice": return `${this.text(e.yes)} if ${this.test(e.test)} else ${this.text(e.no)}`;
      case "assign": return `(${this.text(e.to)} := ${this.assigned(e)})`;
      case "array": return `[${e.items.map((item) => this.text(item)).join(", ")}]`;
      case "object": return `(${this.drawn(e)})`;
      case "member":
        if (!e.of.kind) return constants[e.name]!;
        if (e.name === "length") return `len(${this.text(e.of)})`;
        return e.of.kind.is === "draw" ? `${this.text(e.of)}[${e.name === "wi" ? 0 : 1}]` : `${this.text(e.of)}.${e.name}`;
      case "element": return e.of.kind?.is === "lights" ? `element(${this.text(e.of)}, ${this.text(e.index)})` : `${this.text(e.of)}[${this.index(e.index)}]`;
      case "call": return this.call(e);
      case "function": return "None";
    }
  }
  private drawn(e: Expression & { is: "object" }): string { return ["wi", "pdf"].map((name) => this.operand(e.fields.find(([key]) => key === name)![1], "choice")).join(", "); }
  private assigned(e: Expression & { is: "assign" }): string { return e.op === "=" ? this.text(e.value) : `${this.text(e.to)} ${e.op[0]} (${this.text(e.value)})`; }
  private power(a: Expression, b: Expression): string {
    const simple = (e: Expression): boolean => ["name", "group", "member", "element"].includes(e.is) || (e.is === "number" && !/e/i.test(e.text)) || (e.is === "call" && e.math !== "pow");
    return `${simple(a) ? this.text(a) : `(${this.text(a)})`} ** ${simple(b) ? this.text(b) : `(${this.text(b)})`}`;
  }

  private call(e: Expression & { is: "call" }): string {
    const callee = plain(e.callee);
    if (e.method === "slice" && callee.is === "member") return `${this.text(callee.of)}[${e.args.map((arg) => this.text(arg)).join(":")}${e.args.length === 1 ? ":" : ""}]`;
    if (e.method && callee.is === "member") return this.mapped((e.args[0] as { fn: Fn }).fn, callee.of);
    const args = e.args.map((arg) => this.text(arg));
    if (!e.math) return `${this.called(e)}(${args.slice(0, e.fn!.parameters.length).join(", ")})`;
    if (e.math === "pow") return this.power(e.args[0]!, e.args[1]!);
    if (e.math === "round") return `np.floor(${args[0]} + 0.5)`;
    if (e.math === "fround") return `np.float64(np.float32(${args[0]}))`;
    if (e.math !== "min" && e.math !== "max") return `np.${functions[e.math] ?? e.math}(${args.join(", ")})`;
    // max(a, b) gives a where a is NaN, as Math.max does: what may be NaN comes first.
    const constant = (k: number): boolean => plain(e.args[k]!).is === "number", free = args.filter((_, k) => !constant(k)), fixed = args.filter((_, k) => constant(k));
    const one = free.length > 0 ? [free.reduce((all, next) => `np.${e.math}imum(${all}, ${next})`)] : [];
    return one.length + fixed.length > 1 ? `${e.math}(${[...one, ...fixed].join(", ")})` : one[0]!;
  }
  private called(e: Expression & { is: "call" }): string {
    const callee = plain(e.callee);
    return callee.is === "name" ? spelled(callee.name, reserved) : "";
  }
  private mapped(fn: Fn, of: Expression): string {
    this.active.push(new Set());
    const over = this.text(of), [item, index] = fn.parameters.map((target) => this.add((target as { v: Variable }).v));
    const value = this.text(fn.body as Expression);
    this.active.pop();
    return index ? `[${value} for ${index}, ${item} in enumerate(${over})]` : `[${value} for ${item ?? "_"} in ${over}]`;
  }

  // ---- Statements.

  private say(depth: number, text: string, note?: string): void { this.out.push(`${"    ".repeat(depth)}${text}${note ? `  # ${note}` : ""}`); }
  private block(list: Statement[], depth: number, inside = true): void {
    if (inside) this.active.push(new Set());
    const before = this.out.length;
    for (const s of list) this.statement(s, depth);
    if (this.out.slice(before).every((line) => line.trim().startsWith("#"))) this.say(depth, "pass");
    if (inside) this.active.pop();
  }

  private declared({ target, value }: Declared): string[] {
    if (target.is !== "one") {
      const given = value ? this.text(value) : "";
      return [`${(target as { all: Variable[] }).all.map((v) => this.add(v)).join(", ")} = ${given}`];
    }
    const { v } = target;
    if (v.fn) {
      const inner = new Printer(this.program, this.file);
      inner.outer = this;
      inner.function(v.fn, 0);
      return inner.out;
    }
    if (!value) { this.add(v); return []; }
    const given = this.text(value);
    return [`${this.add(v)} = ${given}`];
  }

  private effect(e: Expression): string {
    const at = plain(e);
    if (at.is === "step") return `${this.text(at.of)} ${at.by > 0 ? "+=" : "-="} 1`;
    if (at.is !== "assign") return this.text(at);
    const value = plain(at.value);
    return value.is === "assign" && at.op === "=" && value.op === "=" ? `${this.text(at.to)} = ${this.effect(value)}` : `${this.text(at.to)} ${at.op} ${this.text(at.value)}`;
  }

  private statement(s: Statement, depth: number): void {
    const { note } = s, loop = (body: Statement[], steps: string[], tail: () => void = () => {}): void => {
      this.steps.push(steps);
      this.block(body, depth + 1);
      tail();
      this.steps.pop();
    };
    switch (s.is) {
      case "comment": for (const line of s.text.split("\n")) this.say(depth, `# ${line}`.trimEnd()); return;
      case "lost":
        for (const line of lostLines(s, "#")) this.say(depth, line);
        if (!prints(s)) this.say(depth, `raise NotImplementedError("line ${s.line} of the JavaScript has no translation")`);
        return;
      case "declare": {
        const lines = s.all.flatMap((one) => this.declared(one));
        lines.forEach((line, k) => this.say(depth, line, k === lines.length - 1 ? note : undefined));
        return;
      }
      case "do": s.all.forEach((e, k) => this.say(depth, this.effect(e), k === s.all.length - 1 ? note : undefined)); return;
      case "return": {
        const value = s.value && plain(s.value);
        this.say(depth, !value ? "return None" : value.is === "object" ? `return ${this.drawn(value)}` : `return ${this.text(value)}`, note);
        return;
      }
      case "if":
        this.say(depth, `if ${this.test(plain(s.test))}:`, note);
        this.block(s.yes, depth + 1);
        if (s.no?.length === 1 && s.no[0]!.is === "if") {
          const before = this.out.length;
          this.statement(s.no[0]!, depth);
          this.out[before] = this.out[before]!.replace("if ", "elif ");
        } else if (s.no) {
          this.say(depth, "else:");
          this.block(s.no, depth + 1);
        }
        return;
      case "while": this.say(depth, `while ${this.test(plain(s.test))}:`, note); loop(s.body, []); return;
      case "repeat":
        this.say(depth, "while True:", note);
        loop(s.body, [`if not (${this.test(s.test)}):`, "    break"], () => { for (const line of this.steps[this.steps.length - 1]!) this.say(depth + 1, line); });
        return;
      case "each": {
        const over = this.text(s.of);
        this.active.push(new Set());
        this.say(depth, `for ${this.add(s.v)} in ${over}:`, note);
        loop(s.body, []);
        this.active.pop();
        return;
      }
      case "count": {
        const whole = counted(s);
        this.active.push(new Set());
        if (whole) {
          const end = this.text(whole.to), beyond = whole.op === "<=" ? `${end} + 1` : whole.op === ">=" ? `${end} - 1` : end;
          this.say(depth, `for ${this.add(whole.v)} in range(${whole.by !== 1 ? `${whole.from}, ${beyond}, ${whole.by}` : whole.from === "0" ? beyond : `${whole.from}, ${beyond}`}):`, note);
          loop(s.body, []);
        } else {
          for (const one of s.from) for (const line of this.declared(one)) this.say(depth, line);
          this.say(depth, `while ${s.test ? this.test(plain(s.test)) : "True"}:`, note);
          const steps = s.step.map((e) => this.effect(e));
          loop(s.body, steps, () => { for (const line of steps) this.say(depth + 1, line); });
        }
        this.active.pop();
        return;
      }
      case "leave":
        if (s.word === "continue") for (const line of this.steps[this.steps.length - 1] ?? []) this.say(depth, line);
        this.say(depth, s.word, note);
        return;
      case "block": {
        this.active.push(new Set());
        for (const one of s.body) this.statement(one, depth);
        this.active.pop();
        return;
      }
      case "function": { // inside of another
        const inner = new Printer(this.program, this.file);
        inner.outer = this;
        inner.function(s.v.fn!, 0);
        for (const line of inner.out) this.say(depth, line);
      }
    }
  }

  function(fn: Fn, depth: number): void {
    if (fn.state === "new") return this.say(depth, `# ${fn.name}() is never called, so the kinds of its arguments are not known: it has no translation.`);
    this.active.push(new Set());
    const given = fn.parameters.map((target) => this.add((target as { v: Variable }).v, true));
    this.say(depth, `def ${spelled(fn.name, reserved)}(${given.join(", ")}):`);
    this.block(fn.body as Statement[], depth + 1, false);
    this.active.pop();
  }

  /** The file: functions come first if they are called while it is read. */
  whole(): void {
    const all = this.program.statements, functional = (s: Statement): boolean => s.is === "function" || (s.is === "declare" && s.all.every(({ target }) => target.is === "one" && target.v.fn));
    const groups: Statement[][] = [[]]; // comments stay with what they are before
    for (const s of all) {
      groups[groups.length - 1]!.push(s);
      if (s.is !== "comment") groups.push([]);
    }
    const calls = (group: Statement[]): boolean => functional(group[group.length - 1]!), full = groups.filter((group) => group.length > 0);
    const order = (this.program.early ? [...full.filter(calls), ...full.filter((group) => !calls(group))] : full).flat();
    let after: "start" | "comment" | "function" | "statement" = "start";
    for (const s of order) {
      const comment = s.is === "comment" || s.is === "lost", now = functional(s) ? "function" : comment ? "comment" : "statement";
      if (after !== "start" && after !== "comment" && (now !== "statement" || after === "function")) this.out.push(...(now === "comment" && after === "statement" ? [""] : ["", ""]));
      after = now;
      if (s.is === "function") this.function(s.v.fn!, 0);
      else if (s.is === "declare" && now === "function") for (const { target } of s.all) this.function((target as { v: Variable }).v.fn!, 0);
      else if (s.is === "lost") for (const line of lostLines(s, "#")) this.say(0, line);
      else this.statement(s, 0);
    }
    const made = this.out.join("\n"), used = helpers.filter(([name]) => made.includes(`${name}(`));
    this.out.unshift(...used.flatMap(([, lines]) => [...lines, "", ""]));
  }
}

export function pythonCode(program: Program): string {
  const file = new Set<string>();
  for (const s of program.statements)
    if (s.is === "function") file.add(spelled(s.v.name, reserved));
    else if (s.is === "declare") for (const { target } of s.all) for (const v of target.is === "one" ? [target.v] : (target as { all: Variable[] }).all) file.add(spelled(v.name, reserved));
  const printer = new Printer(program, file);
  printer.whole();
  return printer.out.join("\n");
}
