#include "films/film.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace crescent::inline films {

namespace {

std::size_t area(int w, int h) { return static_cast<std::size_t>(w) * static_cast<std::size_t>(h); }

template <class Byte, class... V> std::vector<std::span<Byte>> bytes_of(V&... planes) {
    return {std::span<Byte>(reinterpret_cast<Byte*>(planes.data()), sizeof(planes[0]) * planes.size())...};
}
template <class Byte, class F> std::vector<std::span<Byte>> film_bytes(F& f) {
    return bytes_of<Byte>(f.r, f.g, f.b, f.y, f.y2, f.var, f.largest, f.horizon, f.hits);
}
template <class Byte, class F> std::vector<std::span<Byte>> reference_bytes(F& f) {
    return bytes_of<Byte>(f.r, f.g, f.b, f.y, f.error);
}

std::string hash_of(const std::vector<std::span<const std::byte>>& planes) {
    XXH3_state_t* state = XXH3_createState();
    XXH3_64bits_reset(state);
    for (const auto plane : planes) XXH3_64bits_update(state, plane.data(), plane.size());
    const std::uint64_t digest = XXH3_64bits_digest(state);
    XXH3_freeState(state);
    return fmt::format("{:016x}", digest);
}

}  // namespace

std::string to_string(const RunKey& key) { return fmt::format("{} n={} s={}", key.arm, key.n, key.s); }

Film::Film(int w, int h, std::uint64_t samples) : width(w), height(h), n(samples) {
    for (auto* plane : {&r, &g, &b, &y, &y2, &var, &largest}) plane->assign(area(w, h), 0.0f);
    for (auto* plane : {&horizon, &hits}) plane->assign(area(w, h), 0u);
}

ReferenceFilm::ReferenceFilm(int w, int h, double exponent) : width(w), height(h), s(exponent) {
    for (auto* plane : {&r, &g, &b, &y, &error}) plane->assign(area(w, h), 0.0f);
}

std::vector<std::span<std::byte>> Film::planes() { return film_bytes<std::byte>(*this); }

std::vector<std::span<std::byte>> ReferenceFilm::planes() { return reference_bytes<std::byte>(*this); }

std::string hash(const Film& film) { return hash_of(film_bytes<const std::byte>(film)); }

std::string hash(const ReferenceFilm& film) { return hash_of(reference_bytes<const std::byte>(film)); }

}  // namespace crescent::inline films
