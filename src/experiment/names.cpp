// The sampler words and what steers each of them.
#include "experiment/names.h"

#include <fmt/format.h>

#include <algorithm>

namespace crescent {

namespace {

struct Sampler {
    std::string_view name;
    bool needs_s;
};

constexpr Sampler samplers[] = {
    {"uniform", false},
    {"cosine", false},
    {"phong", true},
    {"mixture", true},
    {"mis-balance", true},
    {"mis-power", true},
    {"light-solid-angle", false},
    {"light-area", false},
    {"blinn", true},
    {"ggx-d", false},
    {"ggx-vndf", false},
};

}  // namespace

std::vector<std::string> sampler_names() {
    std::vector<std::string> names;
    for (const Sampler& s : samplers) names.emplace_back(s.name);
    return names;
}

bool sampler_needs_s(std::string_view sampler) {
    return std::any_of(
        std::begin(samplers), std::end(samplers), [&](const Sampler& s) { return s.name == sampler && s.needs_s; });
}

std::string film_file(std::string_view arm, double s, double own_s) {
    return s == own_s ? std::string(arm) : fmt::format("{}-s{}", arm, s);
}

}  // namespace crescent
