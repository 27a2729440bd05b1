// Warnings about files, one line for all files with the same warning; and the test of pixels that are not finite.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/renders.h"

namespace crescent {

class FileWarnings {
public:
    /// Adds "FILE: TEXT", or "FILE: N pixels TEXT". Files with the same `kind` (by default the text) share a line.
    void add(const std::string& file, const std::string& text, std::uint64_t pixels = 0, const std::string& kind = "");
    /// Returns the lines in the order of their first file, each with that file and the number of files.
    std::vector<std::string> lines() const;
    /// Returns the line of one kind; "" if it has no file.
    std::string line(const std::string& kind) const;

private:
    struct Kind {
        std::string kind, file, text;  // of the first file
        std::uint64_t files = 0, fewest_pixels = 0, most_pixels = 0;
        std::string line() const;
    };
    std::vector<Kind> kinds_;
};

// ---- Values that are NaN or infinite: two sides differ if one has them and the other has not.

/// Returns the number of groups of touching pixels (8 neighbours); `pixels` ascending.
std::uint32_t touching_groups(const std::vector<std::uint32_t>& pixels, int width);

/// Counts the groups of touching pixels (8 neighbours) of a render that are not finite, one count per region.
std::vector<std::uint32_t> failed_groups(const Render& render, const RenderStats& stats);

/// Pixels of one side that fail (are not finite) more often than on the other side.
struct FailingPixels {
    std::vector<std::uint32_t> pixels;  // ascending
    // The smallest and the largest number of renders of this side, and of the other, in which one fails.
    std::uint32_t least_renders = 0, most_renders = 0;
    std::uint32_t least_other_renders = 0, most_other_renders = 0;
};

/// Groups of failing pixels of one region, over all renders of a side.
struct FailedGroups {
    std::string region;
    std::uint64_t a = 0, b = 0;
    double p = 1;  // of equal rates for each render
    bool differs = false;
};

/// The result for the values of two sides that are not finite.
struct NonFinite {
    std::uint64_t two_sided = 0, one_sided = 0;  // pixels that fail on both sides, or on one side, without a difference
    // Of `one_sided`: those in half of the renders of a side or more, too few renders to decide.
    std::uint64_t undecided = 0;
    FailingPixels a, b;                // pixels that differ: those that fail more often on side a, on side b
    std::vector<FailedGroups> groups;  // one per region; empty if no pixel fails
    double p = 1;                      // of equal rates everywhere
    bool any() const { return !groups.empty(); }
    bool differs() const { return !a.pixels.empty() || !b.pixels.empty(); }
};

/// A pixel that fails in every render of one side and in none of the other is a difference. The others are tested at
/// half of `alpha` each: pixels by Fisher's exact test of the counts of renders, with the false discovery rate
/// controlled; regions by the exact binomial test of the counts of groups (Holm). If a region differs, all its pixels
/// that fail more often on that side are reported. A pixel is undecided if it fails in half of the renders of one side
/// or more and in none of the other, and these tests find no difference.
NonFinite compare_non_finite(const RenderStats& stats, const ArmStats& a, const ArmStats& b, double alpha);

/// Returns "(3, 4), (5, 4), ... within x 3–9 y 4–7".
std::string places_of(const FailingPixels& failing, int width);

}  // namespace crescent
