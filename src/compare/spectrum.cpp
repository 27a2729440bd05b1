// The power spectrum of the error in disjoint blocks, spread over the box: a row-column transform,
// F
// ^2 over the pixels of a block, averaged over rings of equal frequency in cycles per block. The mean, frequency 0, is
// left out.
#include "compare/noise.h"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "math/functions.h"

namespace crescent::inline comparison {

namespace {

constexpr auto size = static_cast<std::size_t>(spectrum_block);
using Complex = std::complex<double>;
using Row = std::array<Complex, size>;

/// Returns exp(-2 pi i k / block) as a table.
const Row& roots_of_unity() {
    static const Row table = [] {
        Row t;
        for (std::size_t k = 0; k < size; ++k) {
            const double angle = -2 * std::numbers::pi * static_cast<double>(k) / spectrum_block;
            t[k] = {math::cos(angle), math::sin(angle)};
        }
        return t;
    }();
    return table;
}

/// Returns z exp(-2 pi i k / block), without the library's handling of infinities.
Complex rotated(const Complex& z, std::size_t k) {
    const Complex& w = roots_of_unity()[k];
    return {z.real() * w.real() - z.imag() * w.imag(), z.real() * w.imag() + z.imag() * w.real()};
}

/// Radix-2 transform of a row (Cooley & Tukey 1965), decimation in time.
Row transformed(const Row& x) {
    Row out;
    for (std::size_t k = 0; k < size; ++k) {
        std::size_t reversed = 0;
        for (std::size_t bit = 1; bit < size; bit *= 2) reversed = 2 * reversed + ((k & bit) ? 1 : 0);
        out[reversed] = x[k];
    }
    for (std::size_t half = 1; half < size; half *= 2) {
        for (std::size_t start = 0; start < size; start += 2 * half) {
            for (std::size_t k = 0; k < half; ++k) {
                const Complex even = out[start + k], odd = rotated(out[start + k + half], k * (size / (2 * half)));
                out[start + k] = even + odd, out[start + k + half] = even - odd;
            }
        }
    }
    return out;
}

/// Returns the absolute frequency of bin k, in cycles per block.
double frequency(std::size_t k) { return static_cast<double>(std::min(k, size - k)); }

struct Radial {
    std::array<double, size * size> bin{};  // ring of each coefficient; -1: outside
    std::array<double, spectrum_bins> count{};
};

const Radial& radial() {
    static const Radial table = [] {
        Radial r;
        for (std::size_t v = 0; v < size; ++v) {
            for (std::size_t u = 0; u < size; ++u) {
                const long at = std::lround(math::hypot(frequency(u), frequency(v))) - 1;
                const bool inside = at >= 0 && at < spectrum_bins;
                r.bin[v * size + u] = inside ? static_cast<double>(at) : -1;
                if (inside) r.count[static_cast<std::size_t>(at)] += 1;
            }
        }
        return r;
    }();
    return table;
}

void add_block(std::vector<double>& power, int x0, int y0, const std::function<double(int, int)>& error) {
    std::array<Row, size> rows;
    for (std::size_t j = 0; j < size; ++j) {
        Row row;
        for (std::size_t i = 0; i < size; ++i) row[i] = error(x0 + static_cast<int>(i), y0 + static_cast<int>(j));
        rows[j] = transformed(row);
    }
    for (std::size_t u = 0; u < size; ++u) {
        Row column;
        for (std::size_t j = 0; j < size; ++j) column[j] = rows[j][u];
        column = transformed(column);
        for (std::size_t v = 0; v < size; ++v) {
            const double at = radial().bin[v * size + u];
            if (at < 0) continue;
            const auto bin = static_cast<std::size_t>(at);
            power[bin] += std::norm(column[v]) / static_cast<double>(size * size) / radial().count[bin];
        }
    }
}

}  // namespace

void add_spectrum(
    std::vector<double>& power, const Box& box, const std::function<double(int, int)>& error, int most_blocks) {
    const int across = box.width() / spectrum_block, count = across * (box.height() / spectrum_block);
    const int step = (count + most_blocks - 1) / most_blocks;
    for (int k = 0; k < count; k += step) {
        power.resize(spectrum_bins);
        add_block(power, box.x0 + k % across * spectrum_block, box.y0 + k / across * spectrum_block, error);
    }
}

NoiseColour noise_colour(const std::vector<double>& power) {
    if (power.size() != spectrum_bins) return NoiseColour::unknown;
    const auto half = power.begin() + spectrum_bins / 2;
    const double low = std::accumulate(power.begin(), half, 0.0), high = std::accumulate(half, power.end(), 0.0);
    if (!(low + high > 0)) return NoiseColour::unknown;
    constexpr double apart =
        1.25;  // 25 % more power on one side; for white noise the two differ by at most 5 % in one block
    return low > apart * high ? NoiseColour::correlated : high > apart * low ? NoiseColour::blue : NoiseColour::white;
}

const char* to_string(NoiseColour colour) {
    switch (colour) {
        case NoiseColour::white: return "white";
        case NoiseColour::blue: return "blue";
        case NoiseColour::correlated: return "correlated";
        case NoiseColour::unknown: break;
    }
    return "unknown";
}

}  // namespace crescent::inline comparison
