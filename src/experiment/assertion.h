// An assertion as plain data: two quantities of a run, or a quantity and a number, and how they are compared.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crescent {

/// One side of an assertion. n = 0: not given; s = 0: the experiment's own.
struct ParsedQuantity {
    std::string word, region, adapter;
    std::uint64_t n = 0;
    double s = 0;
    std::optional<double> number = {};  // a plain number; the rest is empty in this case
};

/// left op right.
struct Comparison {
    ParsedQuantity left, right;
    std::string op;  // "<", "<=", ">", ">=", "=="; "": not parsed yet
};

/// Returns the quantity in full, as in an assertion.
std::string to_string(const ParsedQuantity& quantity);
/// Returns "left op right", as parse_comparison reads it.
std::string to_string(const Comparison& comparison);

/// Returns whether value op right. No comparison with NaN holds.
bool holds(double value, std::string_view op, double right);

// ---- The language of assertions: quantities of a run by name, compared with each other or with a number.
//   check    = side op side            op = < <= > >= ==
//   side     = number | word[.region][(sampler[, n=N][, s=S])]
// e.g. "rmse.H(phong, n=64, s=32) < rmse.H(cosine, n=64, s=32)", "bad(phong) == 0".

struct Experiment;

/// The kind of argument in the brackets of a quantity.
enum class QuantityOf { none, run, furnace, shape, region, plate, compared };  // compared: an arm without n and s

/// A word that an assertion may name: its argument, whether a region follows it, its meaning.
struct QuantityWord {
    std::string_view word;
    bool of_region;  // word.REGION
    QuantityOf adapter;
    std::string_view means;
    bool of_single_samples = false;  // the default of n is the arm's highest sample count
};
/// Returns every quantity that an assertion can name.
const std::vector<QuantityWord>& quantity_words();
/// Returns "rmse.REGION(ARM, n=N, s=S)".
std::string form_of(const QuantityWord& word);

/// Parses an assertion over a list of words; for invalid text, returns nothing and sets `message` to
/// what was expected.
std::optional<Comparison> parse_comparison(
    std::string_view text, std::string& message, const std::vector<QuantityWord>& words = quantity_words());
/// Fills in a missing n: the experiment's, or for bad and largest the arm's highest sample count, which includes all
/// others. Returns the error in the names, "" if all of them will be measured.
std::string resolve_quantity(ParsedQuantity& quantity, const Experiment& experiment);

}  // namespace crescent
