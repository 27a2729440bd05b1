// Views without noise: by how much single renders of both sides differ, and whether a stated tolerance allows it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace crescent {

struct RenderStats;

/// A tolerance of every channel of every pixel: "1 ulp", "0.5 %" of the baseline, or "2/255" of the largest value.
struct Tolerance {
    enum class Unit { ulp, percent, share } unit = Unit::ulp;
    double size = 0;  // ulp; percent: over 100; share: 2 / 255
};
/// Parses one; nothing if the text is none.
std::optional<Tolerance> parse_tolerance(std::string_view text);
inline constexpr const char* tolerance_forms = "a tolerance such as \"1 ulp\", \"0.5 %\" or \"2/255\"";

/// The differences of two renders. A step is the distance of neighbouring values of the files: of whole numbers 1, else
/// an ulp of the less precise side (float, half, RGBE).
struct ExactDifference {
    std::uint64_t pixels = 0, different = 0, excess = 0;  // excess: beyond the tolerance
    std::uint64_t one_sided = 0;                // of `different`: finite on one side only, which no tolerance allows
    double steps = 0, share = 0, absolute = 0;  // the largest of a channel; share: of the baseline's value
    int x = 0, y = 0;                           // where steps are most
    std::string step_name;                      // "255" for 8 bits; "" for floating point
};
/// Compares the first arm, the baseline, with the second; each is one render.
ExactDifference exact_difference(const RenderStats& stats, const std::optional<Tolerance>& tolerance);

}  // namespace crescent
