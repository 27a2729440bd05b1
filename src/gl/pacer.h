// How much one draw may hold. Drivers end a draw that takes too long, and none can be interrupted: draws are made to
// last about a tenth of a second, so that none comes near 0.2 s on llvmpipe even where the next rows cost twice as
// much.
#pragma once

#include <algorithm>
#include <cstdint>

namespace crescent::gl {

class Pacer {
public:
    static constexpr double aim_s = 0.08;

    /// Samples (pixels x samples a pixel) that the next draw may take.
    std::uint64_t budget() const { return std::max<std::uint64_t>(budget_, least); }
    /// A draw of `work` samples took so long. Growth is at most fourfold a draw, a fall is taken over at once.
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
