// What is to be said of files, once for all files of which it is to be said.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/renders.h"

namespace crescent::inline comparison {

class FileWarnings {
public:
    /// "FILE: TEXT", or "FILE: N pixels TEXT". Files with the same `kind` (by default the text) share a line.
    void add(const std::string& file, const std::string& text, std::uint64_t pixels = 0, const std::string& kind = "");
    /// In the order in which each was first added: with how many files it is of, and the first.
    std::vector<std::string> lines() const;

private:
    struct Kind {
        std::string kind, file, text;  // of the first
        std::uint64_t files = 0, fewest = 0, most = 0;
    };
    std::vector<Kind> kinds_;
};

// ---- Values that are NaN or infinite: where one side of a comparison has them and the other has not, the sides
// differ.

/// Groups of touching pixels (8 neighbours) of a render that are not finite, a count for each region.
std::vector<std::uint32_t> failed_groups(const Render& render, const RenderStats& all);

/// Pixels of one side that fail (are not finite) more often than on the other side.
struct FailingPixels {
    std::vector<std::uint32_t> pixels;              // rising
    std::uint32_t least = 0, most = 0;              // renders of this side in which one of them fails
    std::uint32_t other_least = 0, other_most = 0;  // the same of the other side
};

/// Groups of failing pixels of one region, over all renders of a side.
struct FailedGroups {
    std::string region;
    std::uint64_t a = 0, b = 0;
    double p = 1;  // of equal rates for each render
    bool differs = false;
};

/// What one pair of sides says of values that are not finite.
struct NonFinite {
    std::uint64_t both = 0, one = 0;   // pixels that fail on both sides, or on one alone, and are no difference
    std::uint64_t undecided = 0;       // of `one`: in half of the renders of a side or more, which are too few to say
    FailingPixels a, b;                // pixels that differ: more often on side a, on side b
    std::vector<FailedGroups> groups;  // a region each; empty where no pixel fails
    bool any() const { return !groups.empty(); }
    bool differs() const { return !a.pixels.empty() || !b.pixels.empty(); }
};

/// A pixel that fails in every render of one side and in none of the other is a difference. Of the rest, at half of
/// `alpha` each: pixels by Fisher's exact test of the counts of renders, false discoveries controlled; regions by the
/// exact binomial test of the counts of groups (Holm), of which all pixels that fail more often there are named.
/// Undecided is a pixel that fails in half of the renders of one side or more, in none of the other, and is no
/// difference by these tests.
NonFinite compare_non_finite(const RenderStats& all, const ArmStats& a, const ArmStats& b, double alpha);

/// "(3, 4), (5, 4), ... within x 3–9 y 4–7".
std::string places_of(const FailingPixels& failing, int width);

}  // namespace crescent::inline comparison
