// A check as plain data: two quantities of a run, or a quantity and a number, and how they are compared. The text of
// one is read in quantity_text.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline experiment {

/// One side of a check. n = 0: not said; s = 0: the experiment's own.
struct ParsedQuantity {
    std::string word, region, adapter;
    std::uint64_t n = 0;
    double s = 0;
    std::optional<double> number = {};  // a plain number; the rest is empty then
};

/// left op right.
struct Comparison {
    ParsedQuantity left, right;
    std::string op;  // "<", "<=", ">", ">=", "=="; "": nothing was parsed yet
};

/// The quantity in full, as parse_quantity reads it.
std::string to_string(const ParsedQuantity& quantity);
/// "left op right", as parse_comparison reads it.
std::string to_string(const Comparison& comparison);

/// Whether left op right. No comparison with NaN holds.
bool holds(double left, std::string_view op, double right);

// ---- The language of checks: quantities of a run by name, compared with each other or with a number.
//   check    = side op side            op = < <= > >= ==
//   side     = number | word[.region][(sampler[, n=N][, s=S])]
// e.g. "rmse.H(phong, n=64, s=32) < rmse.H(cosine, n=64, s=32)", "bad(phong) == 0".

struct Experiment;

/// What stands in the brackets of a quantity.
enum class QuantityOf { none, run, furnace, shape, region, plate, compared };  // compared: an arm without n and s

/// A word that a check may name: what stands in its brackets, whether a region follows it, what it means.
struct QuantityWord {
    std::string_view word;
    bool of_region;  // word.REGION
    QuantityOf adapter;
    std::string_view means;
    bool of_single_samples = false;  // n is the arm's highest sample count unless it is said
};
/// Every quantity that a check can name.
const std::vector<QuantityWord>& quantity_words();
/// "rmse.REGION(ARM, n=N, s=S)".
std::string form_of(const QuantityWord& word);

/// Reads one side, or a whole check over a list of words; where the text is wrong, nothing, and `why` says what was
/// expected.
std::optional<ParsedQuantity> parse_quantity(
    std::string_view text, std::string& why, const std::vector<QuantityWord>& words = quantity_words());
std::optional<Comparison> parse_comparison(
    std::string_view text, std::string& why, const std::vector<QuantityWord>& words = quantity_words());
/// Fills in n where a run is meant and none is named: the experiment's, or for bad and largest the arm's highest sample
/// count, which holds all others. Returns what is wrong with the names, "" where all of them will be measured.
std::string resolve_quantity(ParsedQuantity& quantity, const Experiment& experiment);

}  // namespace crescent::inline experiment
