// The code of a sampler as a C++ struct: its constants are members, its functions member functions, and each number is
// a double, as in JavaScript.
import { counted, lostLines, plain, prints, Program, spelled } from "./kinds";
import { Declared, Expression, Fn, Kind, Statement, Variable } from "./syntax";

const reserved = new Set(("alignas alignof and asm auto bitand bitor bool break case catch char class compl concept const consteval constexpr constinit continue decltype default delete do double " +
  "else enum explicit export extern false float for friend goto if inline int long mutable namespace new noexcept not operator or private protected public register requires return short signed " +
  "sizeof static struct switch template this throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t while xor " +
  "std Drawn Light Sampler Surface Vec3 surface element mapped nonzero sign_of sliced").split(" "));
const constants: Readonly<Record<string, string>> = {
  PI: "std::numbers::pi", E: "std::numbers::e", SQRT2: "std::numbers::sqrt2", SQRT1_2: "std::sqrt(0.5)", LN2: "std::numbers::ln2", LN10: "std::numbers::ln10", LOG2E: "std::numbers::log2e",
  LOG10E: "std::numbers::log10e",
};
/** What the translation uses and C++ does not have. */
const helpers: readonly [string, string[]][] = [
  ["nonzero", ["static bool nonzero(double x) { return x < 0 || x > 0; }"]],
  ["sign_of", ["static double sign_of(double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : x; }"]],
  ["element", ["static const Light* element(const std::vector<Light>& all, double k) {", "    return k >= 0 && k < double(all.size()) ? &all[std::size_t(k)] : nullptr;", "}"]],
  ["sliced", ["template <std::size_t first, std::size_t end, class T, std::size_t n> static std::array<T, end - first> sliced(const std::array<T, n>& a) {", "    std::array<T, end - first> out{};",
    "    for (std::size_t i = first; i < end; ++i) out[i - first] = a[i];", "    return out;", "}"]],
  ["mapped", ["template <class T, std::size_t n, class F, class R = std::invoke_result_t<F, T, int>>", "static std::array<R, n> mapped(const std::array<T, n>& a, F f) {", "    std::array<R, n> out{};",
    "    for (std::size_t i = 0; i < n; ++i) out[i] = f(a[i], int(i));", "    return out;", "}"]],
];

class Printer {
  readonly out: string[] = [];
  constructor(private readonly program: Program) {}

  private name(v: Variable): string { return spelled(v.name, reserved); }
  type(kind: Kind | undefined): string {
    switch (kind?.is) {
      case "array": return kind.size === 3 && kind.of.is === "number" ? "Vec3" : `std::array<${this.type(kind.of)}, ${kind.size}>`;
      case "bool": return "bool";
      case "string": return "std::string";
      case "light": return "const Light*";
      case "lights": return "std::vector<Light>";
      case "context": return "Surface";
      case "draw": case "null": return "std::optional<Drawn>";
      case "void": return "void";
      default: return "double";
    }
  }

  // ---- Expressions.

  private test(e: Expression): string { return e.kind?.is === "number" ? `nonzero(${this.text(e)})` : this.text(e); }
  private condition(e: Expression): string { return this.test(plain(e)); }
  private index(e: Expression): string {
    const at = plain(e);
    if (at.is === "number") return at.text;
    return at.is === "name" && at.v?.counts ? this.name(at.v) : `std::size_t(${this.text(at)})`;
  }
  private operand(e: Expression, ...within: string[]): string { return within.includes(e.is === "logic" ? e.op : e.is) ? `(${this.text(e)})` : this.text(e); }

  text(e: Expression): string {
    switch (e.is) {
      case "number": return /[.eE]/.test(e.text) ? e.text : `${e.text}.0`;
      case "string": return JSON.stringify(e.value);
      case "bool": return String(e.value);
      case "null": return "{}";
      case "name": return !e.v ? (e.name === "NaN" ? "std::numeric_limits<double>::quiet_NaN()" : "std::numeric_limits<double>::infinity()") : e.v.counts ? `double(${this.name(e.v)})` : this.name(e.v);
      case "group": return `(${this.text(e.of)})`;
      case "sign": return `${e.op}${e.of.is === "sign" ? `(${this.text(e.of)})` : this.text(e.of)}`;
      case "not": return `!${this.test(e.of)}`;
      case "step": return e.before ? `${e.by > 0 ? "++" : "--"}${this.text(e.of)}` : `${this.text(e.of)}${e.by > 0 ? "++" : "--"}`;
      case "arithmetic":
        if (e.op === "**") return `std::pow(${this.text(e.a)}, ${this.text(e.b)})`;
        return e.op === "%" ? `std::fmod(${this.text(e.a)}, ${this.text(e.b)})` : `${this.text(e.a)} ${e.op} ${this.text(e.b)}`;
      case "compare": {
        const other = e.a.is === "null" ? e.b : e.b.is === "null" ? e.a : undefined;
        if (other) return e.op === "==" ? `!${this.text(other)}` : `bool(${this.text(other)})`;
        return `${this.operand(e.a, "compare")} ${e.op} ${this.operand(e.b, "compare")}`;
      }
      case "logic": return [e.a, e.b].map((side) => (side.kind?.is === "number" ? this.test(side) : this.operand(side, e.op === "||" ? "&&" : "||"))).join(` ${e.op} `);
      case "choice": {
        const arm = (of: Expression): string => (e.kind?.is === "draw" ? `${this.type(e.kind)}(${of.kind?.is === "null" ? "" : this.text(of)})` : of.is === "null" ? "nullptr" : this.text(of));
        return `${this.test(e.test)} ? ${arm(e.yes)} : ${arm(e.no)}`;
      }
      case "assign": return `${this.text(e.to)} ${e.op} ${this.text(e.value)}`;
      case "array": {
        const items = e.items.map((item) => this.text(item)).join(", "), one = e.kind?.is === "array" && e.kind.size === 1 && e.kind.of.is === "array";
        return this.type(e.kind) === "Vec3" ? `Vec3{${items}}` : `${one ? this.type(e.kind) : "std::array"}{${items}}`;
      }
      case "object": return `Drawn{${["wi", "pdf"].map((name) => this.text(e.fields.find(([key]) => key === name)![1])).join(", ")}}`;
      case "member": {
        const { of, name } = e, from = of.kind;
        if (!from) return constants[name]!;
        if (name === "length") return from.is === "array" ? `${from.size}.0` : `double(${this.text(of)}.size())`;
        return `${this.text(of)}${from.is === "light" || from.is === "draw" ? "->" : "."}${name}`;
      }
      case "element": return e.of.kind?.is === "lights" ? `element(${this.text(e.of)}, ${this.text(e.index)})` : `${this.text(e.of)}[${this.index(e.index)}]`;
      case "call": return this.call(e);
      case "function": return this.lambda(e.fn, "");
    }
  }

  private call(e: Expression & { is: "call" }): string {
    const args = e.args.map((arg) => (arg.is === "function" ? "" : this.text(arg)));
    if (e.math) {
      if (e.math === "round") return `std::floor(${args[0]} + 0.5)`;
      if (e.math === "fround") return `double(float(${args[0]}))`;
      if (e.math === "sign") return `sign_of(${args[0]})`;
      if (e.math !== "min" && e.math !== "max") return `std::${e.math}(${args.join(", ")})`;
      // std::max(a, b) gives a where a is NaN, as Math.max does: what may be NaN comes first.
      const constant = (k: number): number => Number(plain(e.args[k]!).is === "number"), order = args.map((_, k) => k).sort((a, b) => constant(a) - constant(b));
      return order.map((k) => args[k]!).reduce((all, next) => `std::${e.math}(${all}, ${next})`);
    }
    const method = plain(e.callee);
    if (e.method === "slice" && method.is === "member") return `sliced<${(e.args[0] as { text: string }).text}, ${e.args[1] ? (e.args[1] as { text: string }).text : (method.of.kind as { size: number }).size}>(${this.text(method.of)})`;
    if (e.method && method.is === "member") return `mapped(${this.text(method.of)}, ${this.lambda((e.args[0] as { fn: Fn }).fn, "int")})`;
    const fn = e.fn!, taken = args.slice(0, fn.parameters.length), root = this.program.functions.get(fn.name) === fn;
    return `${spelled(fn.name, reserved)}(${(root ? taken.slice(0, 2) : taken).join(", ")})`;
  }

  private parameter(fn: Fn, k: number, by: "value" | "reference"): string {
    const target = fn.parameters[k]!, kind = fn.takes[k], v = target.is === "one" ? target.v : undefined, type = this.type(kind);
    const shared = by === "reference" && (kind?.is === "array" || kind?.is === "context") && !v?.writes;
    return `${shared ? `const ${type}&` : type} ${!v || v.reads + v.writes === 0 ? `/* ${v?.name ?? ""} */` : this.name(v)}`;
  }
  /** `second`: the type of the second argument of a function for mapped(). */
  private lambda(fn: Fn, second: string): string {
    const parameters = fn.takes.map((_, k) => (second && k === 1 ? `int ${this.name((fn.parameters[1] as { v: Variable }).v)}` : this.parameter(fn, k, "reference")));
    if (second && parameters.length < 2) parameters.push("int");
    if (!Array.isArray(fn.body)) return `[&](${parameters.join(", ")}) { return ${this.text(fn.body)}; }`;
    const inner = new Printer(this.program);
    inner.block(fn.body, fn, 1);
    return `[&](${parameters.join(", ")}) -> ${this.type(fn.returns ?? { is: "number" })} {\n${inner.out.join("\n")}\n}`;
  }

  // ---- Statements.

  private say(depth: number, text: string, note?: string): void {
    const lines = text.split("\n");
    if (note) lines[lines.length - 1] += `  // ${note}`;
    for (const line of lines) this.out.push(line ? "    ".repeat(depth) + line : "");
  }
  block(list: Statement[], fn: Fn | undefined, depth: number): void { for (const s of list) this.statement(s, fn, depth); }
  private braced(head: string, body: Statement[], fn: Fn | undefined, depth: number, tail = "}"): void {
    this.say(depth, `${head} {`);
    this.block(body, fn, depth + 1);
    this.say(depth, tail);
  }

  private declared({ target, value }: Declared): string {
    const given = value ? this.text(value) : "";
    if (target.is !== "one") {
      const all = (target as { all: Variable[] }).all, fixed = all.every((v) => v.writes === 0 && !v.edited);
      return `${all.every((v) => v.reads === 0) ? "[[maybe_unused]] " : ""}${fixed ? "const " : ""}auto [${all.map((v) => this.name(v)).join(", ")}] = ${given}`;
    }
    const { v } = target, unused = v.reads === 0 && !v.fn ? "[[maybe_unused]] " : "";
    if (v.fn) return `const auto ${this.name(v)} = ${given}`;
    if (!value) return `${unused}${this.type(v.kind)} ${this.name(v)}{}`;
    const fixed = v.writes === 0 && !v.edited ? "const " : "", type = v.kind?.is === "number" || v.kind?.is === "light" || value.kind?.is === "null" ? this.type(v.kind) : v.kind?.is === "draw" || v.kind?.is === "string" ? this.type(v.kind) : "auto";
    return `${unused}${fixed && type.startsWith("const") ? "" : fixed}${type} ${this.name(v)} = ${given}`;
  }

  private statement(s: Statement, fn: Fn | undefined, depth: number): void {
    const { note } = s;
    switch (s.is) {
      case "comment": for (const line of s.text.split("\n")) this.say(depth, `// ${line}`.trimEnd()); return;
      case "lost":
        for (const line of lostLines(s, "//")) this.say(depth, line);
        if (!prints(s)) this.say(depth, `throw std::logic_error("line ${s.line} of the JavaScript has no translation");`);
        return;
      case "declare": {
        const lines: string[] = [];
        for (const one of s.all) { // numbers of one line stay on one line
          const text = this.declared(one), last = lines[lines.length - 1], head = /^(const )?double (?=\w+ =)/.exec(text)?.[0];
          if (head && last?.startsWith(head) && last.length + text.length < 112 - 4 * depth) lines[lines.length - 1] = `${last}, ${text.slice(head.length)}`;
          else lines.push(text);
        }
        lines.forEach((line, k) => this.say(depth, `${line};`, k === lines.length - 1 ? note : undefined));
        return;
      }
      case "do": this.say(depth, s.all.map((e) => `${this.text(e)};`).join(" "), note); return;
      case "return": {
        const none = s.value?.kind?.is === "null";
        this.say(depth, !s.value ? "return;" : none ? `return ${fn?.returns?.is === "light" ? "nullptr" : "std::nullopt"};` : `return ${this.text(s.value)};`, note);
        return;
      }
      case "if": {
        const one = s.yes.length === 1 && !s.no && ["return", "do", "leave"].includes(s.yes[0]!.is) ? new Printer(this.program) : undefined;
        one?.block(s.yes, fn, 0);
        if (one?.out.length === 1) return this.say(depth, `if (${this.condition(s.test)}) ${one.out[0]}`, note);
        this.say(depth, `if (${this.condition(s.test)}) {`);
        this.block(s.yes, fn, depth + 1);
        if (s.no) this.braced("} else", s.no, fn, depth);
        else this.say(depth, "}", note);
        return;
      }
      case "while": return this.braced(`while (${this.condition(s.test)})`, s.body, fn, depth);
      case "repeat": return this.braced("do", s.body, fn, depth, `} while (${this.condition(s.test)});`);
      case "each": return this.braced(`for (const ${s.v.kind?.is === "number" ? "double" : "auto&"} ${this.name(s.v)} : ${this.text(s.of)})`, s.body, fn, depth);
      case "count": {
        const whole = counted(s), limit = whole && plain(whole.to);
        if (whole && limit) {
          const to = limit.is === "number" ? limit.text : limit.is === "member" && limit.of.kind?.is === "array" ? String(limit.of.kind.size) : `int(${this.text(limit)})`, name = this.name(whole.v);
          const step = Math.abs(whole.by) === 1 ? `${whole.by > 0 ? "++" : "--"}${name}` : `${name} ${whole.by > 0 ? "+=" : "-="} ${Math.abs(whole.by)}`;
          return this.braced(`for (int ${name} = ${whole.from}; ${name} ${whole.op} ${to}; ${step})`, s.body, fn, depth);
        }
        const from = s.from.map((one) => this.declared(one)), fixed = from.map((text, k) => (k ? text.replace(/^(const )?double /, "") : text.replace(/^const /, "")));
        return this.braced(`for (${fixed.join(", ")}; ${s.test ? this.condition(s.test) : ""}; ${s.step.map((e) => this.text(e)).join(", ")})`, s.body, fn, depth);
      }
      case "leave": this.say(depth, `${s.word};`, note); return;
      case "block": return this.braced("", s.body, fn, depth);
      case "function": return;
    }
  }

  // ---- The struct.

  private member(fn: Fn): void {
    const root = this.program.functions.get(fn.name) === fn;
    const returns = root ? (fn.name === "sample" ? "std::optional<Drawn>" : "double") : this.type(fn.returns ?? { is: "number" }), count = root ? 2 : fn.takes.length;
    const given = Array.from({ length: count }, (_, k) => (k < fn.takes.length ? this.parameter(fn, k, root ? "value" : "reference") : `${k ? (fn.name === "sample" ? `std::array<double, ${this.program.numbers}>` : "Vec3") : "Vec3"} /* unused */`));
    if (fn.state === "new") return this.say(1, `// ${fn.name}() is never called, so the kinds of its arguments are not known: it has no translation.`);
    this.say(1, `${returns} ${spelled(fn.name, reserved)}(${given.join(", ")}) const {`);
    const third = root ? fn.parameters[2] : undefined;
    if (third?.is === "one" && third.v.reads > 0) this.say(2, `const Surface& ${this.name(third.v)} = surface;`);
    this.block(fn.body as Statement[], fn, 2);
    this.say(1, "}");
  }

  members(): void {
    let started = false; // statements are in the constructor, and so is what follows them
    const constructor = new Printer(this.program);
    const apart = (): void => { if (!this.out[this.out.length - 1]?.startsWith("    // ")) this.out.push(""); }; // a comment belongs to what follows
    for (const s of this.program.statements) {
      if (s.is === "function") apart(), this.member(s.v.fn!);
      else if (s.is === "comment") apart(), this.statement(s, undefined, 1);
      else if (s.is === "lost") for (const line of lostLines(s, "//")) this.say(1, line);
      else if (s.is !== "declare") {
        started = true;
        constructor.statement(s, undefined, 2);
      } else for (const { target, value } of s.all) {
        const all = target.is === "one" ? [target.v] : (target as { all: Variable[] }).all, note = s.note ? `// ${s.note}` : "";
        if (target.is === "one" && target.v.fn) apart(), this.member(target.v.fn);
        else if (target.is === "one" && target.v.name === "numbers" && value?.is === "number") this.say(1, `static constexpr int numbers = ${value.text};  ${note}`.trimEnd());
        else if (target.is === "one" && !started) this.say(1, `${this.type(target.v.kind)} ${this.name(target.v)}${value ? ` = ${this.text(value)}` : "{}"};  ${note}`.trimEnd());
        else {
          started = true;
          for (const v of all) this.say(1, `${this.type(v.kind)} ${this.name(v)}{};  ${note}`.trimEnd());
          if (value) constructor.say(2, target.is === "one" ? `${this.name(target.v)} = ${this.text(value)};` : `{\n    const auto parts = ${this.text(value)};\n    ${all.map((v, k) => `${this.name(v)} = parts[${k}];`).join(" ")}\n}`);
        }
      }
    }
    if (constructor.out.length > 0) this.out.push("", "    Sampler() {", ...constructor.out, "    }");
    const made = this.out.join("\n"), used = helpers.filter(([name]) => new RegExp(`\\b${name}[(<]`).test(made));
    if (used.length > 0) this.out.push("", "    // ---- Used by the translation.", ...used.flatMap(([, lines]) => lines.map((line) => `    ${line}`)));
  }
}

/** The members of the struct, with their indent. */
export function cppMembers(program: Program): string {
  const printer = new Printer(program);
  printer.members();
  return printer.out.join("\n").replace(/^\n+/, "").replace(/\n{3,}/g, "\n\n");
}
