// The text of screen and captions: literal words have no digit; every number is a value that states its source.
// Everything is Pango markup.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "crescent/crescent.h"

namespace crescent::explainer {

/// A number as it is shown, and its source: "rmse.H of cosine n=64 s=32", "seed of the experiment".
struct Number {
    std::string markup, source;
};
/// Formats `digits` significant digits, trailing zeros kept.
Number figure(double value, int digits, const std::string& source);
/// Formats at most `digits` significant digits, for values given by an experiment.
Number number(double value, int digits, const std::string& source);
/// Formats an integer, with thin spaces from five digits on.
Number count(std::uint64_t value, const std::string& source);
/// Formats 0.0669 as "6.7 %".
Number percent(double part, int digits, const std::string& source);
/// Returns a name of the experiment, escaped; may have digits.
Number name(const std::string& text);

/// A formula of the explainer or of a sampler: its digits are mathematics, not results.
struct Formula {
    std::string_view markup;
};

/// Words and numbers in sequence. A literal with a digit outside its markup tags is a Bug.
class Words {
public:
    struct Part {
        std::string markup;
        std::string source;  // "": literal words
    };

    Words() = default;
    template <class... Parts> explicit Words(const Parts&... parts) { (add(parts), ...); }
    template <class Next> Words& operator<<(const Next& next) { return add(next), *this; }

    const std::vector<Part>& parts() const { return parts_; }
    bool empty() const { return parts_.empty(); }
    std::string markup() const;
    /// Returns the text without tags; superscripts after "^", subscripts after "_".
    std::string plain() const;

private:
    void add(const char* words) { add(std::string_view(words)); }
    void add(std::string_view words);
    void add(const Number& n) { parts_.push_back({n.markup, n.source}); }
    void add(const Formula& f) { parts_.push_back({std::string(f.markup), "formula"}); }
    void add(const Words& w) { parts_.insert(parts_.end(), w.parts_.begin(), w.parts_.end()); }

    std::vector<Part> parts_;
};

/// Returns the words in another colour, for a highlighted term of a formula.
Words tinted(const Words& words, const plates::Colour& ink);
Words strong(const Words& words);

/// Returns markup without its tags, entities resolved.
std::string plain_of(const std::string& markup);

}  // namespace crescent::explainer

// ---- The formulas of the video. Their digits are mathematics; no result is here.

namespace crescent::explainer::formulas {

inline constexpr Formula sum{"(1/N) Σ"};
inline constexpr Formula f{"f(ω)"};
inline constexpr Formula light{"L(ω)"};
inline constexpr Formula cosine{"cos θ"};
inline constexpr Formula density{"p(ω)"};
inline constexpr Formula uniform_density{"p = 1/(2π)"};
inline constexpr Formula cosine_density{"p = cos θ / π"};
inline constexpr Formula phong_density{"p = (s+1)/(2π) · (ω·R)<sup>s</sup>"};
inline constexpr Formula tail_index{"k = (s−1)/(s+1)"};
inline constexpr Formula tail_slope{"−1/k"};
inline constexpr Formula lost_support{"(1 − cos θ)/2"};
inline constexpr Formula half{"1/2"};
inline constexpr Formula one{"1"};
inline constexpr Formula radiance_unit{"W·sr<sup>−1</sup>·m<sup>−2</sup>"};
inline constexpr Formula one_over_density{"1/p"};
inline constexpr Formula one_over_n{"1/n"};
inline constexpr Formula first_random{"u<sub>1</sub>"};
inline constexpr Formula second_random{"u<sub>2</sub>"};
inline constexpr Formula root_n{"1/√N"};

}  // namespace crescent::explainer::formulas
