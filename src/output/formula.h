// Formulas are written once, in a small part of TeX, and set in two ways: as presentation MathML (MathML Core) for
// pages and as one line of Pango markup for plates. Letters, digits, + - = < > , ; / ( ) and
//   \frac{a}{b}  \sqrt{a}  x_i  x^2  {group}  \lvert a \rvert  \mathrm{word}  \,  \cdot  \le  \infty  \propto
//   \cos \sin \tan \exp \ln \log \min \max  and Greek letters by name: the list is in formula.cpp.
#pragma once

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

}  // namespace crescent::formula
