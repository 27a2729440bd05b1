// Formulas are written once, in a small part of TeX, and set in two ways: as presentation MathML (MathML Core) for
// pages and as one line of Pango markup for plates. Letters, digits, + - = < > , ; / ( ) and
//   \frac{a}{b}  \sqrt{a}  x_i  x^2  {group}  \lvert a \rvert  \mathrm{word}  \,  \cdot  \le  \infty  \propto
//   \cos \sin \tan \exp \ln \log \min \max  and Greek letters by name: the list is in base/formula_words.h.
#pragma once

#include <string>
#include <string_view>

namespace crescent::formula {

/// The inside of a <math> element. Throws Bug for TeX that is not of the part above.
std::string mathml(std::string_view tex);

/// Numbers that stand for a letter and for that letter + 1, as Pango markup.
struct Value {
    char letter = 0;
    std::string number{}, plus_one{};
};
/// One line of Pango markup, fractions as a/b: "(s+1)/(2π) (ω·R)<sup>s</sup>", with {'s', "32", "33"} in place of s
/// "33/(2π) (ω·R)<sup>32</sup>".
std::string pango(std::string_view tex, const Value& value = {});

/// Words with formulas between dollar signs as HTML: "about the normal $n$" -> "about the normal
/// <math><mi>n</mi></math>".
std::string html(std::string_view words);

}  // namespace crescent::formula
