// A film: per pixel, the statistics of n samples of one arm. Rows run bottom-up, pixel (i, j) at j * width + i.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace crescent::inline render {

/// What was run: an arm at n samples per pixel, exponent s, seed.
struct RunKey {
    std::string arm;
    std::uint64_t n = 0;
    double s = 0;
    std::uint32_t seed = 0;
    friend bool operator==(const RunKey&, const RunKey&) = default;
};
/// "phong n=64 s=32": the name of a film in metrics.json (the seed stands in the provenance).
std::string to_string(const RunKey& key);

/// Sample statistics of one arm after n samples, per pixel: row by row from the bottom-left, index i + j * width.
struct Film {
    int width = 0, height = 0;
    std::uint64_t n = 0;                    // samples per pixel
    std::uint64_t directions = 1;           // drawn a sample; an arm of two techniques draws two
    std::vector<float> r, g, b;             // mean radiance, W/(sr m^2)
    std::vector<float> y;                   // mean luminance X
    std::vector<float> second_moment;       // mean of X^2
    std::vector<float> var;                 // variance of the mean of X: 1/(n(n-1)) sum (X - mean)^2; 0 where n = 1
    std::vector<float> largest;             // largest single X
    std::vector<std::uint32_t> horizon;     // directions at or under the horizon, of n * directions
    std::vector<std::uint32_t> light_hits;  // directions that met a light, of n * directions
    std::uint64_t invalid = 0;              // NaN, infinite or negative samples in the whole film

    /// Every plane as bytes, 4 a pixel.
    std::vector<std::span<std::byte>> planes();
    /// All planes of w * h pixels, 0.
    Film() = default;
    Film(int w, int h, std::uint64_t samples);
    std::size_t size() const { return y.size(); }
};

/// What the metrics compare with: radiance, its luminance and its own standard error (of Y) per pixel.
struct ReferenceFilm {
    int width = 0, height = 0;
    double s = 0;
    std::vector<float> r, g, b, y, error;
    std::vector<std::span<std::byte>> planes();    // as Film::planes()
    std::size_t size() const { return y.size(); }  // pixels
    ReferenceFilm() = default;
    ReferenceFilm(int w, int h, double exponent);
};

/// What a primary ray met, per pixel: the index of the shape, or -1.
struct ShapeMap {
    int width = 0, height = 0;
    std::vector<std::int16_t> shape;
};

/// XXH3 of a film's bytes as 16 hexadecimal digits; equal films have equal hashes.
std::string hash(const Film& film);
std::string hash(const ReferenceFilm& film);

// ---- The hash of a film in pieces, for who may not take the time of all of it at once.

/// What hash() of film.h says of planes whose bytes are added in their order.
class FilmHash {
public:
    FilmHash();
    /// Of the next bytes of a plane.
    void add(std::span<const std::byte> bytes);
    /// 16 hexadecimal digits.
    std::string text() const;

private:
    std::shared_ptr<void> state_;
};

}  // namespace crescent::inline render
