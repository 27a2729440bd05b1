// Formulas are written once, in a small part of TeX, and set in two ways: as presentation MathML (MathML Core) for
// pages and as one line of Pango markup for plates. Letters, digits, + - = < > , ; / ( ) and
//   \frac{a}{b}  \sqrt{a}  x_i  x^2  {group}  \lvert a \rvert  \mathrm{word}  \,  \cdot  \le  \infty  \propto
//   \cos \sin \tan \exp \ln \log \min \max  and Greek letters by name: the list is in this file.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace crescent::formula {

/// Returns the inside of a <math> element. Throws Bug for other TeX.
std::string mathml(std::string_view tex);

/// Numbers for a letter and for that letter + 1, as Pango markup.
struct Value {
    char letter = 0;
    std::string number{}, plus_one{};
};
/// Returns one line of Pango markup, fractions as a/b: "(s+1)/(2π) (ω·R)<sup>s</sup>", with {'s', "32", "33"} in place
/// of s "33/(2π) (ω·R)<sup>32</sup>".
std::string pango(std::string_view tex, const Value& value = {});

/// Returns words with formulas between dollar signs as HTML: "about the normal $n$" -> "about the normal
/// <math><mi>n</mi></math>".
std::string html(std::string_view words);

// ---- The words and signs of formulas, and a compile-time check whether a formula consists of them, used for the
// formulas of samplers and lobes.

/// The kind of a piece of a formula.
enum class Kind { letter, number, sign, word, space, row, paren, bars, fraction, root, script };

/// \name, and the UTF-8 that represents it.
struct Word {
    std::string_view name, text;
    Kind kind;
};
inline constexpr auto words = std::to_array<Word>({
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
inline constexpr std::string_view signs = "+-=<>,;/";

constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Checks that every word and sign is known, every bracket closed, nothing missing at the end. A formula that passes
/// can be set.
class Checker {
public:
    constexpr explicit Checker(std::string_view tex) : tex_(tex) {}
    constexpr bool holds() { return row(0); }

private:
    constexpr void skip() {
        while (at_ < tex_.size() && tex_[at_] == ' ') ++at_;
    }
    constexpr bool row(char end) {
        for (;;) {
            skip();
            if (at_ == tex_.size()) return end == 0;
            if (end == '|' && tex_.substr(at_).starts_with("\\rvert")) return at_ += 6, true;
            if (end != 0 && end != '|' && tex_[at_] == end) return ++at_, true;
            if (!atom()) return false;
            while (at_ < tex_.size() && (tex_[at_] == '_' || tex_[at_] == '^'))
                if (++at_, !atom()) return false;
        }
    }
    constexpr bool atom() {
        if (at_ == tex_.size()) return false;
        const char c = tex_[at_++];
        if (c == '{') return row('}');
        if (c == '(') return row(')');
        if (c == '\\') return command();
        while (is_digit(c) && at_ < tex_.size() && (is_digit(tex_[at_]) || tex_[at_] == '.')) ++at_;
        return is_letter(c) || is_digit(c) || signs.find(c) != signs.npos;
    }
    constexpr bool command() {
        if (at_ < tex_.size() && tex_[at_] == ',') return ++at_, true;
        const std::size_t from = at_;
        while (at_ < tex_.size() && is_letter(tex_[at_])) ++at_;
        const std::string_view name = tex_.substr(from, at_ - from);
        skip();
        if (name == "frac") return atom() && atom();
        if (name == "sqrt") return atom();
        if (name == "lvert") return row('|');
        if (name == "mathrm") {
            const std::size_t end = tex_.find('}', at_);
            if (at_ == tex_.size() || tex_[at_] != '{' || end == tex_.npos) return false;
            return at_ = end + 1, true;
        }
        for (const Word& word : words)
            if (word.name == name) return true;
        return false;
    }

    std::string_view tex_;
    std::size_t at_ = 0;
};

/// Returns whether a formula can be set.
constexpr bool is_formula(std::string_view tex) { return Checker(tex).holds(); }
/// Returns whether every formula between dollar signs can be set.
constexpr bool has_formulas(std::string_view words_and_tex) {
    for (bool tex = false;; tex = !tex) {
        const std::size_t end = words_and_tex.find('$');
        if (tex && (end == words_and_tex.npos || !is_formula(words_and_tex.substr(0, end)))) return false;
        if (end == words_and_tex.npos) return true;
        words_and_tex.remove_prefix(end + 1);
    }
}

}  // namespace crescent::formula
