// Recursive descent turns TeX into a tree of nodes; the tree is written as MathML elements, or as Pango markup with
// brackets where a fraction on one line needs them. Values replace letters in the tree.
#include "output/formula.h"

#include <array>
#include <cctype>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "base/errors.h"

namespace crescent::formula {

namespace {

/// The kind of a piece of a formula.
enum class Kind { letter, number, sign, word, space, row, paren, bars, fraction, root, script };

/// \name, and the UTF-8 that represents it.
struct Word {
    std::string_view name, text;
    Kind kind;
};
constexpr auto words = std::to_array<Word>({
    {"alpha", "α", Kind::letter},
    {"beta", "β", Kind::letter},
    {"gamma", "γ", Kind::letter},
    {"delta", "δ", Kind::letter},
    {"epsilon", "ε", Kind::letter},
    {"zeta", "ζ", Kind::letter},
    {"eta", "η", Kind::letter},
    {"theta", "θ", Kind::letter},
    {"iota", "ι", Kind::letter},
    {"kappa", "κ", Kind::letter},
    {"lambda", "λ", Kind::letter},
    {"mu", "μ", Kind::letter},
    {"nu", "ν", Kind::letter},
    {"xi", "ξ", Kind::letter},
    {"pi", "π", Kind::letter},
    {"rho", "ρ", Kind::letter},
    {"sigma", "σ", Kind::letter},
    {"tau", "τ", Kind::letter},
    {"upsilon", "υ", Kind::letter},
    {"phi", "φ", Kind::letter},
    {"chi", "χ", Kind::letter},
    {"psi", "ψ", Kind::letter},
    {"omega", "ω", Kind::letter},
    {"Gamma", "Γ", Kind::letter},
    {"Delta", "Δ", Kind::letter},
    {"Theta", "Θ", Kind::letter},
    {"Lambda", "Λ", Kind::letter},
    {"Xi", "Ξ", Kind::letter},
    {"Pi", "Π", Kind::letter},
    {"Sigma", "Σ", Kind::letter},
    {"Phi", "Φ", Kind::letter},
    {"Psi", "Ψ", Kind::letter},
    {"Omega", "Ω", Kind::letter},
    {"infty", "∞", Kind::number},
    {"cos", "cos", Kind::word},
    {"sin", "sin", Kind::word},
    {"tan", "tan", Kind::word},
    {"exp", "exp", Kind::word},
    {"ln", "ln", Kind::word},
    {"log", "log", Kind::word},
    {"min", "min", Kind::word},
    {"max", "max", Kind::word},
    {"cdot", "·", Kind::sign},
    {"le", "≤", Kind::sign},
    {"ge", "≥", Kind::sign},
    {"propto", "∝", Kind::sign},
});
constexpr std::string_view signs = "+-=<>,;/";

/// A piece of a formula. Its parts: for a row all, for a fraction two, for a root one, for a script base, sub and sup.
struct Node {
    Kind kind = Kind::row;
    std::string text{};  // UTF-8
    std::vector<Node> parts{};
    bool empty() const { return kind == Kind::row && parts.empty(); }
};

class Reader {
public:
    explicit Reader(std::string_view tex) : tex_(tex) {}

    /// Reads up to `end` (0: to the end of the text), including it.
    Node row(char end = 0) {
        Node out;
        for (;;) {
            while (position_ < tex_.size() && tex_[position_] == ' ') ++position_;
            if (position_ == tex_.size()) {
                ensure(end == 0, "every bracket of a formula is closed");
                return out;
            }
            if (end == '|' ? starts("\\rvert") : end != 0 && tex_[position_] == end) {
                position_ += end == '|' ? 6 : 1;
                return out;
            }
            out.parts.push_back(scripted(atom()));
        }
    }

private:
    bool starts(std::string_view prefix) const { return tex_.substr(position_).starts_with(prefix); }

    Node scripted(Node base) {
        Node sub, sup;
        while (position_ < tex_.size() && (tex_[position_] == '_' || tex_[position_] == '^')) {
            const bool low = tex_[position_++] == '_';
            (low ? sub : sup) = atom();
        }
        if (sub.empty() && sup.empty()) return base;
        return {Kind::script, "", {std::move(base), std::move(sub), std::move(sup)}};
    }

    Node atom() {
        ensure(position_ < tex_.size(), "a formula does not end before a required part");
        const char c = tex_[position_++];
        const auto is = [&](int (*what)(int)) { return what(static_cast<unsigned char>(c)) != 0; };
        if (c == '{') return row('}');
        if (c == '(') return {Kind::paren, "", {row(')')}};
        if (c == '\\') return command();
        if (is(std::isalpha)) return {Kind::letter, std::string(1, c), {}};
        if (is(std::isdigit)) {
            std::string digits(1, c);
            while (position_ < tex_.size() &&
                (std::isdigit(static_cast<unsigned char>(tex_[position_])) || tex_[position_] == '.'))
                digits += tex_[position_++];
            return {Kind::number, digits, {}};
        }
        ensure(signs.find(c) != signs.npos, "a formula has no other signs");
        return {Kind::sign, c == '-' ? "−" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c), {}};
    }

    Node command() {
        if (starts(",")) return ++position_, Node{Kind::space, "", {}};
        std::string_view name = tex_.substr(position_);
        std::size_t length = 0;
        while (length < name.size() && std::isalpha(static_cast<unsigned char>(name[length]))) ++length;
        name = name.substr(0, length);
        position_ += length;
        while (position_ < tex_.size() && tex_[position_] == ' ') ++position_;
        if (name == "frac") {
            Node top = atom(), bottom = atom();
            return {Kind::fraction, "", {std::move(top), std::move(bottom)}};
        }
        if (name == "sqrt") return {Kind::root, "", {atom()}};
        if (name == "lvert") return {Kind::bars, "", {row('|')}};
        if (name == "mathrm") {
            const std::size_t end = tex_.find('}', position_);
            ensure(starts("{") && end != tex_.npos, "\\mathrm has a word in braces");
            Node word{Kind::word, std::string(tex_.substr(position_ + 1, end - position_ - 1)), {}};
            return position_ = end + 1, word;
        }
        for (const Word& word : words)
            if (word.name == name) return {word.kind, std::string(word.text), {}};
        throw Bug(std::source_location::current(), "a formula has no word \\" + std::string(name));
    }

    std::string_view tex_;
    std::size_t position_ = 0;
};

std::string element(std::string_view tag, const std::string& content) {
    return fmt::format("<{0}>{1}</{0}>", tag, content);
}

std::string as_mathml(const Node& n) {
    const auto part = [&](std::size_t k) { return as_mathml(n.parts[k]); };
    switch (n.kind) {
        case Kind::letter: return element("mi", n.text);
        case Kind::number: return element("mn", n.text);
        case Kind::sign: return element("mo", n.text == "·" ? "⋅" : n.text);
        case Kind::word: return "<mi mathvariant=\"normal\">" + n.text + "</mi>";
        case Kind::space: return "<mspace width=\"0.17em\" />";
        case Kind::paren: return element("mrow", "<mo>(</mo>" + part(0) + "<mo>)</mo>");
        case Kind::bars:
            return element("mrow",
                "<mo form=\"prefix\" stretchy=\"false\">|</mo>" + part(0) +
                    "<mo form=\"postfix\" stretchy=\"false\">|</mo>");
        case Kind::fraction: return element("mfrac", part(0) + part(1));
        case Kind::root: return element("msqrt", part(0));
        case Kind::script:
            if (n.parts[2].empty()) return element("msub", part(0) + part(1));
            if (n.parts[1].empty()) return element("msup", part(0) + part(2));
            return element("msubsup", part(0) + part(1) + part(2));
        case Kind::row: break;
    }
    if (n.parts.size() == 1) return part(0);
    std::string content;
    for (const Node& child : n.parts) content += as_mathml(child);
    return element("mrow", content);
}

bool is_sign(const Node& n, std::string_view text) { return n.kind == Kind::sign && n.text == text; }

std::string as_pango(const Node& n);

/// Numerator or denominator on one line: in brackets if a neighbour would bind closer.
std::string beside_slash(const Node& n, bool is_denominator) {
    const Node& inner = n.kind == Kind::row && n.parts.size() == 1 ? n.parts[0] : n;
    bool brackets = is_denominator && inner.kind == Kind::row && inner.parts.size() > 1;
    if (inner.kind == Kind::row)
        for (const Node& term : inner.parts) brackets = brackets || is_sign(term, "+") || is_sign(term, "−");
    const std::string line = as_pango(inner);
    return brackets ? "(" + line + ")" : line;
}

std::string row_as_pango(const Node& n) {
    const bool is_sum = n.parts.size() == 3 && is_sign(n.parts[1], "+") && n.parts[2].kind == Kind::number;  // s+1
    std::string out;
    for (std::size_t k = 0; k < n.parts.size(); ++k) {
        const Node& piece = n.parts[k];
        const bool is_spaced =
            piece.kind == Kind::sign && piece.text != "·" && piece.text != "," && piece.text != "/" && k > 0 && !is_sum;
        const bool follows_word = k > 0 && n.parts[k - 1].kind == Kind::word && piece.kind != Kind::paren;
        if (is_spaced || (follows_word && piece.kind != Kind::sign)) out += ' ';
        out += as_pango(piece);
        if (is_spaced || is_sign(piece, ",")) out += ' ';
    }
    return out;
}

std::string as_pango(const Node& n) {
    switch (n.kind) {
        case Kind::space: return " ";
        case Kind::paren: return "(" + as_pango(n.parts[0]) + ")";
        case Kind::bars: return "|" + as_pango(n.parts[0]) + "|";
        case Kind::fraction: return beside_slash(n.parts[0], false) + "/" + beside_slash(n.parts[1], true);
        case Kind::root: return "√(" + as_pango(n.parts[0]) + ")";
        case Kind::script: {
            std::string out = as_pango(n.parts[0]);
            const bool positive_part = is_sign(n.parts[1], "+");  // (x)_+ : plates show where p is 0
            if (!n.parts[1].empty() && !positive_part) out += element("sub", as_pango(n.parts[1]));
            if (!n.parts[2].empty()) out += element("sup", as_pango(n.parts[2]));
            return out;
        }
        case Kind::row: return row_as_pango(n);
        default: return n.text;
    }
}

void put_in(Node& n, const Value& value) {
    const auto is_letter = [&](const Node& node) {
        return node.kind == Kind::letter && node.text == std::string_view(&value.letter, 1);
    };
    for (std::size_t k = 0; k + 2 < n.parts.size() && n.kind == Kind::row; ++k)
        if (is_letter(n.parts[k]) && is_sign(n.parts[k + 1], "+") && n.parts[k + 2].text == "1") {
            n.parts[k] = {Kind::number, value.plus_one, {}};
            n.parts.erase(n.parts.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                n.parts.begin() + static_cast<std::ptrdiff_t>(k) + 3);
        }
    for (std::size_t k = 1; k < n.parts.size() && n.kind == Kind::row; ++k)  // 2s is 2·40, and not 240
        if (is_letter(n.parts[k]) && n.parts[k - 1].kind == Kind::number)
            n.parts.insert(n.parts.begin() + static_cast<std::ptrdiff_t>(k), Node{Kind::sign, "·", {}});
    for (Node& child : n.parts) put_in(child, value);
    if (is_letter(n)) n = {Kind::number, value.number, {}};
}

}  // namespace

std::string mathml(std::string_view tex) { return as_mathml(Reader(tex).row()); }

std::string pango(std::string_view tex, const Value& value) {
    Node root = Reader(tex).row();
    if (value.letter != 0) put_in(root, value);
    return as_pango(root);
}

std::string html(std::string_view words_and_tex) {
    std::string out;
    for (bool tex = false;; tex = !tex) {
        const std::size_t end = words_and_tex.find('$');
        const std::string_view part = words_and_tex.substr(0, end);
        ensure(!tex || end != std::string_view::npos, "dollar signs come in pairs");
        out += tex ? "<math>" + mathml(part) + "</math>" : std::string(part);
        if (end == std::string_view::npos) return out;
        words_and_tex.remove_prefix(end + 1);
    }
}

}  // namespace crescent::formula
