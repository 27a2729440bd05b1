// What a kind of shape or of light is made of, one parameter at a time: what a file calls it, what it takes, where it
// is kept. The table of an experiment file and the words of a report are made from this.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/vec.h"
#include "color/rgb.h"

namespace crescent::inline scene {

/// Bounds of a number or of every number in a list.
struct Range {
    double low = 0, high = 0;
    bool low_open = false, high_open = false;
    bool holds(double x) const { return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high); }
};

inline constexpr Range place_range{-1e6, 1e6};   // m; float kernels keep sub-millimetre steps well inside
inline constexpr Range length_range{1e-6, 1e6};  // m
inline constexpr Range albedo_range{0, 1};

/// A parameter of `Kind`.
template <class Kind> struct Parameter {
    std::string_view name;
    std::variant<double Kind::*, bool Kind::*, Vec3d Kind::*, std::optional<Rgb> Kind::*> member;
    std::string_view means;
    Range range{};
    std::string_view unit{};
    bool unit_vector = false;
    std::string_view default_value{};  // "": it must be given; a flag is false where it is not
};

namespace parameter {

/// A point, m.
template <class Kind> constexpr Parameter<Kind> place(std::string_view name, Vec3d Kind::* to, std::string_view means) {
    return {name, to, means, place_range, "m"};
}
/// A length, m.
template <class Kind>
constexpr Parameter<Kind> length(std::string_view name, double Kind::* to, std::string_view means) {
    return {name, to, means, length_range, "m"};
}
/// A unit vector.
template <class Kind>
constexpr Parameter<Kind> direction(std::string_view name, Vec3d Kind::* to, std::string_view means) {
    return {name, to, means, {}, "", true};
}
template <class Kind> constexpr Parameter<Kind> flag(std::string_view name, bool Kind::* to, std::string_view means) {
    return {name, to, means, {}, "", false, "false"};
}
template <class Kind> constexpr Parameter<Kind> albedo(
    std::string_view name, std::optional<Rgb> Kind::* to, std::string_view default_value, std::string_view means) {
    return {name, to, means, albedo_range, "", false, default_value};
}

}  // namespace parameter

/// What two parameters say of each other that cannot be.
struct Mistake {
    std::string_view key;   // where it is mended
    std::string_view says;  // what was expected there, what was found
};

/// A list of kinds; each has a name, a summary of one line for `crescent list`, and parameters().
template <class... Kind> struct KindList {
    static constexpr std::size_t count = sizeof...(Kind);
    using Any = std::variant<Kind...>;
    static constexpr std::array<std::string_view, count> names = {Kind::name...}, summaries = {Kind::summary...};

    /// The kind at `index` with nothing set.
    static Any make(std::size_t index) {
        Any out;
        std::size_t k = 0;
        ((k++ == index ? void(out.template emplace<Kind>()) : void()), ...);
        return out;
    }
    /// Calls f(name of a kind, parameter) for every parameter of every kind, in order.
    template <class F> static constexpr void each_parameter(F&& f) {
        const auto of = [&]<class K>(std::type_identity<K>) {
            for (const Parameter<K>& parameter : K::parameters()) f(K::name, parameter);
        };
        (of(std::type_identity<Kind>{}), ...);
    }
};

}  // namespace crescent::inline scene
