#include "films/film.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace crescent {

namespace {

std::size_t area(int w, int h) { return static_cast<std::size_t>(w) * static_cast<std::size_t>(h); }

class Hash {
public:
    Hash() : state_(XXH3_createState()) { XXH3_64bits_reset(state_); }
    ~Hash() { XXH3_freeState(state_); }
    Hash(const Hash&) = delete;
    Hash& operator=(const Hash&) = delete;
    template <class T> Hash& add(const std::vector<T>& v) {
        XXH3_64bits_update(state_, v.data(), v.size() * sizeof(T));
        return *this;
    }
    std::string text() const { return fmt::format("{:016x}", XXH3_64bits_digest(state_)); }

private:
    XXH3_state_t* state_;
};

}  // namespace

std::string to_string(const RunKey& key) { return fmt::format("{} n={} s={}", key.arm, key.n, key.s); }

Film::Film(int w, int h, std::uint64_t samples) : width(w), height(h), n(samples) {
    for (auto* plane : {&r, &g, &b, &y, &y2, &var, &largest}) plane->assign(area(w, h), 0.0f);
    for (auto* plane : {&horizon, &hits}) plane->assign(area(w, h), 0u);
}

ReferenceFilm::ReferenceFilm(int w, int h, double exponent) : width(w), height(h), s(exponent) {
    for (auto* plane : {&r, &g, &b, &y, &error}) plane->assign(area(w, h), 0.0f);
}

std::string hash(const Film& film) {
    return Hash().add(film.r).add(film.g).add(film.b).add(film.y).add(film.y2).add(film.var).add(film.largest).add(film.horizon).add(film.hits).text();
}

std::string hash(const ReferenceFilm& film) {
    return Hash().add(film.r).add(film.g).add(film.b).add(film.y).add(film.error).text();
}

}  // namespace crescent
