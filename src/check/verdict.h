// Verdicts: their list with the question that each answers, and their messages with the numbers behind them.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "samplers/evaluation_device.h"

// In output order. The families of check/verdicts/ name the verdict that they make wrong. The list is used by `crescent
// check` and its output, --expect, `crescent list verdicts` and the tests.
// clang-format off: one a line
#define CRESCENT_VERDICTS(verdict)                                                                              \
    verdict(valid, "are all densities and weights finite and non-negative, and all directions of unit length?") \
    verdict(support, "is p > 0 wherever f L cos > 0?")                                                          \
    verdict(normalised, "does p integrate to the share of samples that draw a direction?")                      \
    verdict(density, "do the draws follow p?")                                                                  \
    verdict(identity, "do the sampler's functions agree?")                                                      \
    verdict(physics, "is f a BRDF?")                                                                            \
    verdict(tail, "how heavy is the weight f L cos / p?")                                                       \
    verdict(mean, "do the weights average to the integral?")                                                    \
    verdict(efficiency, "how large is variance times cost, against uniform and cosine sampling?")
// clang-format on

namespace crescent {

#define CRESCENT_NAME(verdict, question) std::string_view(#verdict),
inline constexpr std::array verdict_names = {CRESCENT_VERDICTS(CRESCENT_NAME)};
#undef CRESCENT_NAME
#define CRESCENT_QUESTION(verdict, question) std::string_view(question),
inline constexpr std::array verdict_questions = {CRESCENT_VERDICTS(CRESCENT_QUESTION)};
#undef CRESCENT_QUESTION

/// error: the sampler could not be evaluated; it crashed, threw, violated the protocol or did not answer.
enum class State { right, wrong, inconclusive, skipped, error };
std::string_view word(State state);

/// The next step for a verdict. Each front end describes it by its own calls or flags (report/print.h).
struct NextStep {
    /// What would decide the verdict.
    enum class Kind { none, more_draws, more_time, heavier_pdf };
    Kind kind = Kind::none;
    double times = 0;       // required factor on the number of draws; 0: unknown
    bool thorough = false;  // whether the check was thorough already
};

/// The density that the draws of a sampler without pdf(w) imply, with standard errors, 1/sr: means over rings about n,
/// and the highest of the cells.
struct ImpliedDensity {
    /// A mean over a ring, with its standard error.
    struct Ring {
        double from = 0, to = 0;  // degrees from n
        double pdf = 0, error = 0;
    };
    std::vector<Ring> rings;
    double peak = 0, peak_error = 0;
};

/// A sentence of a verdict. `what` names what it states: sentences that state the same at several w_o are one finding.
struct Sentence {
    std::string what, text;
    int technique = 0;  // that it names, of several that are combined, from 1 on; 0: none

    static constexpr std::string_view expected = "expected";  // what the value of the sentence before should be
    /// Whether both are about the same, in whatever numbers.
    bool states_same(const Sentence& other) const { return what == other.what && technique == other.technique; }
};
using Sentences = std::vector<Sentence>;
/// The sentences in a row, with spaces between them.
std::string text_of(const Sentences& sentences);

/// `evidence` is for the JSON: what other parts of the program need has a member of its own.
struct Verdict {
    std::string arm;
    std::string check_case;  // w_o and parameters
    std::string name;        // one of verdict_names
    State state = State::right;
    Sentences sentences{};    // what was found, how large with its interval, and where
    std::string cause{};      // the cause; "" if unknown
    std::string next_step{};  // for an inconclusive verdict, if no front end has a call for it
    NextStep next{};
    std::optional<std::pair<double, double>> wo{};  // theta and azimuth in degrees; none for a sampler without w_o
    double size = 0;                                // of the fault, as a share: orders verdicts of one name
    std::map<std::string, double> hidden{};         // the size that it could hide, by kind of fault
    double nothing = 0;                             // of `valid`: the share of the draws with pdf 0, no sample
    double outside = 0;                             // and of those below the surface with a pdf, where pdf(w) is 0
    std::string place{};                            // of the fault, if it is not at the w_o of this case
    bool first_failure = false;                     // of an error: the sampler failed here, and all others follow
    bool unmet_tail = false;                        // inconclusive since weights are larger than those drawn
    std::optional<double> integral{};               // of a wrong `normalised`: the integral of p
    std::optional<bool> same{};                     // of a comparison: whether A and B agree
    std::optional<ImpliedDensity> implied{};        // of `density`, without a pdf(w)
    nlohmann::ordered_json evidence = nlohmann::ordered_json::object();
    // Values that vary between runs are separate, so that equal calls give equal verdicts.
    double seconds = 0;
    std::string timed_message;
    bool expected = true;      // expected of a right sampler, or of this built-in arm
    std::string why_expected;  // printed if a wrong verdict is expected
    bool waived = false;       // the caller expects it, so it does not count

    /// All sentences in a row.
    std::string message() const { return text_of(sentences); }
    /// The text of the first of them; "" if there are none.
    std::string first_sentence() const { return sentences.empty() ? "" : sentences.front().text; }
};

/// Bins of one density test, for the maps of the HTML page: draws and expected draws, or, without a density (`expected`
/// is empty), the density that the draws imply.
struct BinHistogram {
    std::string arm, check_case, coordinates;
    int rings = 0, sectors = 0;
    std::vector<double> observed, expected;  // ring-major; draws, or 1/sr
    std::vector<double> sd{};                // of observed less expected; empty: the square root of expected
    std::vector<double> edges{};             // of the rings: 1 - cos of the angle to the axis
    std::vector<double> sector_edges{};      // degrees about the axis; empty: uniform from 0
    double full_scale = 0;                   // of a density, 1/sr
    // Of another domain than directions: labels at five places of each side, and what they are.
    std::array<std::string, 5> ring_labels{}, sector_labels{};
    std::string ring_axis{}, sector_axis{};
};

/// Draws and expectation over a line or a set: bars of an entry or of an interval each.
struct LineHistogram {
    std::string arm, check_case, axis;
    std::vector<double> edges;               // of x, or of the entries
    std::vector<double> observed, expected;  // draws; expected empty: no density
    bool entries = false;
};

/// The largest weights, a histogram of all, and p and f L cos along a grid of directions.
struct WeightHistogram {
    std::string arm, check_case;
    std::vector<double> log10_edges, counts;  // histogram of log10 X
    double zeros = 0, k = 0, exceedances = 0;
    double threshold = 0,
           sigma = 0;  // of the generalised Pareto distribution with that k; sigma from the median exceedance
    std::vector<double> rose_p, rose_f;  // plane of incidence, from -90 to 90 deg of wi
};

/// Verdicts that a call skipped for lack of time.
struct SkippedCase {
    std::string arm, check_case;
    std::vector<std::string> verdicts;
    std::string why;
};

/// The verdicts of a call, with what is drawn of them and how much was evaluated.
struct CheckResult {
    std::vector<Verdict> verdicts;
    std::vector<SkippedCase> left_out;
    std::vector<std::string> unmet;  // expectations of the caller that no verdict meets, a sentence each
    std::vector<BinHistogram> maps;
    std::vector<LineHistogram> lines;
    std::vector<WeightHistogram> weights;
    DevicesByArm devices;  // of external samplers that name theirs
    double alpha = 0;
    std::uint64_t tests = 0, screened = 0, confirmed = 0;  // statistical tests: made, failed once, failed twice
    std::uint64_t questions = 0;                           // answers of an external sampler
    std::uint64_t evaluations = 0;                         // of sample, pdf and f
    State state = State::right;                            // of all verdicts
    bool as_expected = true;                               // whether every verdict is the expected one
};

/// Marks the verdict at which the sampler failed, with the error; the verdicts after it follow from it.
void note_first_failure(const std::string& what, Verdict& v);

/// Sets the state of the result: verdicts that the caller does not expect, and expectations that no verdict meets.
void set_state(CheckResult& result);

}  // namespace crescent
