// Limits the work of one draw. Drivers end a draw that takes too long, and none can be interrupted: draws last about a
// tenth of a second, so that none reaches 0.2 s on llvmpipe even if the next rows cost twice as much.
#pragma once

#include <algorithm>
#include <cstdint>

namespace crescent::gl {

class Pacer {
public:
    static constexpr double aim_s = 0.08;

    /// Returns the samples (pixels x samples per pixel) of the next draw.
    std::uint64_t budget() const { return std::max<std::uint64_t>(budget_, least); }
    /// Records the duration of a draw of `work` samples. The budget grows at most fourfold per draw and shrinks at
    /// once.
    void took(std::uint64_t work, double seconds) {
        longest_ = std::max(longest_, seconds);
        if (work == 0) return;
        const double fits = static_cast<double>(work) * aim_s / std::max(seconds, 1e-6);
        budget_ = static_cast<std::uint64_t>(std::min(fits, 4.0 * static_cast<double>(budget())));
    }
    double longest_s() const { return longest_; }
    bool untried() const { return longest_ == 0; }

private:
    static constexpr std::uint64_t least = 16384;
    std::uint64_t budget_ = least;
    double longest_ = 0;
};

}  // namespace crescent::gl
