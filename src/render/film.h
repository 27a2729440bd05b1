// A film: per pixel, the statistics of n samples of one sampler. Rows run bottom-up, pixel (i, j) at j * width + i.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace crescent {

/// What was run: a sampler at n samples per pixel, exponent s, seed.
struct RunKey {
    std::string arm;
    std::uint64_t n = 0;
    double s = 0;
    std::uint32_t seed = 0;
    friend bool operator==(const RunKey&, const RunKey&) = default;
};
/// Returns "phong n=64 s=32", the name of a film in metrics.json; the seed is in the provenance.
std::string to_string(const RunKey& key);

/// Sample statistics of one sampler after n samples, per pixel: row by row from the bottom-left, index i + j * width.
struct Film {
    int width = 0, height = 0;
    std::uint64_t n = 0;                    // samples per pixel
    std::uint64_t directions = 1;           // drawn per sample; 2 for a sampler with two techniques
    std::uint64_t evaluations = 1;          // of f per sample
    std::vector<float> r, g, b;             // mean radiance, W/(sr m^2)
    std::vector<float> y;                   // mean luminance X
    std::vector<float> second_moment;       // mean of X^2
    std::vector<float> var;                 // variance of the mean of X: 1/(n(n-1)) sum (X - mean)^2; 0 if n = 1
    std::vector<float> largest;             // largest single X
    std::vector<std::uint32_t> horizon;     // directions at or below the horizon, out of n * directions
    std::vector<std::uint32_t> light_hits;  // directions that met a light, out of n * directions
    std::uint64_t invalid = 0;              // NaN, infinite or negative samples in the whole film

    /// Returns every plane as bytes, 4 per pixel.
    std::vector<std::span<std::byte>> planes();
    /// Makes all planes of w * h pixels, filled with 0.
    Film() = default;
    Film(int w, int h, std::uint64_t samples);
    std::size_t size() const { return y.size(); }
};

/// The reference of the metrics: radiance, its luminance and its own standard error (of Y) per pixel.
struct ReferenceFilm {
    int width = 0, height = 0;
    double s = 0;
    std::vector<float> r, g, b, y, error;
    std::vector<std::span<std::byte>> planes();    // like Film::planes()
    std::size_t size() const { return y.size(); }  // pixels
    ReferenceFilm() = default;
    ReferenceFilm(int w, int h, double exponent);
};

/// The index of the shape that the primary ray met, per pixel, or -1.
struct ShapeMap {
    int width = 0, height = 0;
    std::vector<std::int16_t> shape;
};

/// Returns XXH3 of a film's bytes as 16 hexadecimal digits; equal films have equal hashes.
std::string hash(const Film& film);
std::string hash(const ReferenceFilm& film);

// ---- The hash of a film in pieces, for callers that must return before the whole film is hashed.

/// Computes hash() from planes whose bytes are added in their order.
class FilmHash {
public:
    FilmHash();
    /// Adds the next bytes of a plane.
    void add(std::span<const std::byte> bytes);
    /// Returns 16 hexadecimal digits.
    std::string text() const;

private:
    std::shared_ptr<void> state_;
};

}  // namespace crescent
