// The hash is XXH3-64 over the bytes of the planes r, g, b, y, second_moment, var, largest, horizon, light_hits; for a
// reference, of r, g, b, y, error. It does not include sizes, n and bad samples.
#include "render/film.h"

#include <fmt/format.h>

#include <iterator>

#include "base/parallel.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace crescent {

namespace {

std::size_t area(int w, int h) { return static_cast<std::size_t>(w) * static_cast<std::size_t>(h); }

template <class Byte, class... V> std::vector<std::span<Byte>> bytes_of(V&... planes) {
    return {std::span<Byte>(reinterpret_cast<Byte*>(planes.data()), sizeof(planes[0]) * planes.size())...};
}
template <class Byte, class F> std::vector<std::span<Byte>> film_bytes(F& f) {
    return bytes_of<Byte>(f.r, f.g, f.b, f.y, f.second_moment, f.var, f.largest, f.horizon, f.light_hits);
}
template <class Byte, class F> std::vector<std::span<Byte>> reference_bytes(F& f) {
    return bytes_of<Byte>(f.r, f.g, f.b, f.y, f.error);
}

std::string hash_of(const std::vector<std::span<const std::byte>>& planes) {
    FilmHash hash;
    for (const auto plane : planes) hash.add(plane);
    return hash.text();
}

}  // namespace

std::string to_string(const RunKey& key) { return fmt::format("{} n={} s={}", key.arm, key.n, key.s); }

Film::Film(int w, int h, std::uint64_t samples) : width(w), height(h), n(samples) {
    std::vector<float>* const sums[] = {&r, &g, &b, &y, &second_moment, &var, &largest};
    std::vector<std::uint32_t>* const counts[] = {&horizon, &light_hits};
    parallel_for(std::size_t{0}, std::size(sums) + std::size(counts), [&](std::size_t k) {
        if (k < std::size(sums)) sums[k]->assign(area(w, h), 0.0f);
        else counts[k - std::size(sums)]->assign(area(w, h), 0u);
    });
}

ReferenceFilm::ReferenceFilm(int w, int h, double exponent) : width(w), height(h), s(exponent) {
    for (auto* plane : {&r, &g, &b, &y, &error}) plane->assign(area(w, h), 0.0f);
}

std::vector<std::span<std::byte>> Film::planes() { return film_bytes<std::byte>(*this); }

std::vector<std::span<std::byte>> ReferenceFilm::planes() { return reference_bytes<std::byte>(*this); }

FilmHash::FilmHash() : state_(XXH3_createState(), [](void* p) { XXH3_freeState(static_cast<XXH3_state_t*>(p)); }) {
    XXH3_64bits_reset(static_cast<XXH3_state_t*>(state_.get()));
}
void FilmHash::add(std::span<const std::byte> bytes) {
    XXH3_64bits_update(static_cast<XXH3_state_t*>(state_.get()), bytes.data(), bytes.size());
}
std::string FilmHash::text() const {
    return fmt::format("{:016x}", XXH3_64bits_digest(static_cast<const XXH3_state_t*>(state_.get())));
}

std::string hash(const Film& film) { return hash_of(film_bytes<const std::byte>(film)); }

std::string hash(const ReferenceFilm& film) { return hash_of(reference_bytes<const std::byte>(film)); }

}  // namespace crescent
