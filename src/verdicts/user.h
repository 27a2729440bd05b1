// Your own sampler, judged. A struct with
//
//   sample(wo, u)   -> something with .wi and .pdf (and .weight, if it says f cos / p itself)
//   pdf(wo, wi)     -> a number, 1/sr
//   f(wo, wi)       -> a number, 1/sr, without the cosine; optional
//
// in plain floats or doubles: directions may be std::array<T, 3>, const T*, or a struct {x, y, z}; u std::array<T, 2>,
// const T* or {x, y}. n = +z; both directions leave the surface. No SIMD, no base class:
//
//   crescent::Judgement j = crescent::judge_sampler("mine", MySampler{});
//
// It is called from many threads at once, so its members must be const or without state. What it throws is an error,
// not a fault of the sampler; a std::optional that is empty is nothing drawn.
#pragma once

#include <array>
#include <concepts>
#include <fmt/format.h>
#include <utility>

#include "verdicts/judge.h"
#include "verdicts/list.h"

namespace crescent {

namespace user {

template <class V> Vec3d direction(const V& v) {
    if constexpr (requires {
                      v.x;
                      v.y;
                      v.z;
                  })
        return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    else return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}
template <class P> double number_of(const P& p) {
    if constexpr (requires { p.v; }) return static_cast<double>(p.v);
    else return static_cast<double>(p);
}

/// The ways in which a direction and a pair of u may be handed over, tried in this order.
template <class T> struct Arrays {
    using Direction = std::array<T, 3>;
    using U = std::array<T, 2>;
    static Direction give(Vec3d v) { return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)}; }
    static U give(Vec2d v) { return {static_cast<T>(v.x), static_cast<T>(v.y)}; }
};
template <class T> struct Structs {
    using Direction = Vec3<T>;
    using U = Vec2<T>;
    static Direction give(Vec3d v) { return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)}; }
    static U give(Vec2d v) { return {static_cast<T>(v.x), static_cast<T>(v.y)}; }
};
/// Hands over as const T*, which the array below turns into.
template <class T> struct Pointers {
    struct Direction {
        T v[3];
        operator const T*() const { return v; }
    };
    struct U {
        T v[2];
        operator const T*() const { return v; }
    };
    static Direction give(Vec3d v) { return {{static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)}}; }
    static U give(Vec2d v) { return {{static_cast<T>(v.x), static_cast<T>(v.y)}}; }
};
/// Turns into whichever number a struct {x, y, z} of the sampler's own is built from with braces.
struct Anything {
    double v;
    template <std::floating_point T> operator T() const { return static_cast<T>(v); }
};
struct Braces {};
template <class S, class G>
concept Takes = requires(const S s, typename G::Direction w, typename G::U u) {
    s.sample(w, u);
    s.pdf(w, w);
};
template <class S> auto way() {
    if constexpr (Takes<S, Structs<double>>) return Structs<double>{};
    else if constexpr (Takes<S, Arrays<double>>) return Arrays<double>{};
    else if constexpr (Takes<S, Pointers<double>>) return Pointers<double>{};
    else if constexpr (Takes<S, Structs<float>>) return Structs<float>{};
    else if constexpr (Takes<S, Arrays<float>>) return Arrays<float>{};
    else if constexpr (Takes<S, Pointers<float>>) return Pointers<float>{};
    else return Braces{};
}
template <class S> using Way = decltype(way<S>());

template <class S> auto sample(const S& s, Vec3d wo, Vec2d u) {
    using G = Way<S>;
    if constexpr (std::same_as<G, Braces>)
        return s.sample({Anything{wo.x}, Anything{wo.y}, Anything{wo.z}}, {Anything{u.x}, Anything{u.y}});
    else return s.sample(G::give(wo), G::give(u));
}
template <class S> double pdf(const S& s, const Pair& p) {
    using G = Way<S>;
    if constexpr (std::same_as<G, Braces>)
        return number_of(s.pdf({Anything{p.wo.x}, Anything{p.wo.y}, Anything{p.wo.z}},
            {Anything{p.wi.x}, Anything{p.wi.y}, Anything{p.wi.z}}));
    else return number_of(s.pdf(G::give(p.wo), G::give(p.wi)));
}
template <class S> constexpr bool has_f() {
    if constexpr (std::same_as<Way<S>, Braces>) return requires(const S s, Anything a) { s.f({a, a, a}, {a, a, a}); };
    else return requires(const S s, typename Way<S>::Direction w) { s.f(w, w); };
}
template <class S> double f(const S& s, const Pair& p) {
    using G = Way<S>;
    if constexpr (std::same_as<G, Braces>)
        return number_of(s.f({Anything{p.wo.x}, Anything{p.wo.y}, Anything{p.wo.z}},
            {Anything{p.wi.x}, Anything{p.wi.y}, Anything{p.wi.z}}));
    else return number_of(s.f(G::give(p.wo), G::give(p.wi)));
}

// What a struct lacks to be judged, each said in a sentence when it does not compile.

template <class S>
concept Callable = !std::same_as<Way<S>, Braces> || requires(const S s, Anything a) {
    s.sample({a, a, a}, {a, a});
    s.pdf({a, a, a}, {a, a, a});
};
/// {x, y, z} where {x, y} is meant would be filled up with 0 without a word.
template <class S>
concept TakesThree =
    requires(const S s, Anything a) { s.sample({a, a, a}, {a, a, a}); } && std::same_as<Way<S>, Braces>;
template <class S>
concept CallableIfNotConst = requires(S s, Anything a) { s.sample({a, a, a}, {a, a}); } ||
    requires(S s, std::array<double, 3> w, std::array<double, 2> u) { s.sample(w, u); } ||
    requires(S s, std::array<float, 3> w, std::array<float, 2> u) { s.sample(w, u); } ||
    requires(S s, Vec3d w, Vec2d u) { s.sample(w, u); };
template <class D>
concept Optional = requires(const D d) {
    d.has_value();
    *d;
};
template <class D>
concept Drawn = requires(const D d) {
    direction(d.wi);
    { number_of(d.pdf) } -> std::convertible_to<double>;
};
template <class S> consteval void must_be_judgeable() {
    static_assert(!TakesThree<S>,
        "the u of sample(wo, u) has three members: a sampler on trial takes two random numbers, std::array<T, 2>, "
        "const T* or {x, y}; make the third of them, or of one of its own");
    static_assert(Callable<S> || !CallableIfNotConst<S>,
        "sample(wo, u) and pdf(wo, wi) must be const: they are called from many threads at once");
    static_assert(Callable<S> || CallableIfNotConst<S>,
        "a sampler has sample(wo, u) and pdf(wo, wi), const, in floats or doubles: directions are std::array<T, 3>, "
        "const T* or a struct {x, y, z}, u is std::array<T, 2>, const T* or {x, y}");
}

/// Calls; what is thrown becomes a fault with the place at which it was thrown.
template <class Call> auto guarded(const char* what, Vec3d wo, Vec3d at, Call&& call) {
    const auto told = [&](const char* why) {
        return SubjectFault(fmt::format("{} threw '{}' at w_o = ({:.9g}, {:.9g}, {:.9g}), {} = ({:.9g}, {:.9g}{})",
            what, why, wo.x, wo.y, wo.z, what[0] == 's' ? "u" : "w_i", at.x, at.y,
            what[0] == 's' ? "" : fmt::format(", {:.9g}", at.z)));
    };
    try {
        return call();
    } catch (const std::exception& e) { throw told(e.what()); } catch (...) {
        throw told("something");
    }
}

}  // namespace user

template <class S> class UserSubject : public JudgedSampler {
public:
    UserSubject(std::string name, S sampler) : name_(std::move(name)), sampler_(std::move(sampler)) {}
    std::string name() const override { return name_; }
    void sample(int, Vec3d wo, std::span<const Vec2d> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i)
            out[i] = user::guarded(
                "sample(wo, u)", wo, {u[i].x, u[i].y, 0}, [&] { return drawn(user::sample(sampler_, wo, u[i])); });
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i)
            out[i] = user::guarded("pdf(wo, wi)", at[i].wo, at[i].wi, [&] { return user::pdf(sampler_, at[i]); });
    }
    bool has_f() const override { return user::has_f<S>(); }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        if constexpr (user::has_f<S>())
            for (std::size_t i = 0; i < at.size(); ++i)
                out[i] = user::guarded("f(wo, wi)", at[i].wo, at[i].wi, [&] { return user::f(sampler_, at[i]); });
        else JudgedSampler::f(at, out);
    }

private:
    template <class D> static Draw drawn(const D& d) {
        if constexpr (user::Optional<D>) {
            return d.has_value() ? drawn(*d) : Draw{{0, 0, 1}, 0, {}, {}};
        } else {
            static_assert(user::Drawn<D>,
                "sample(wo, u) returns something with .wi, a direction, and .pdf, a number in 1/sr (or a std::optional "
                "of that)");
            Draw out{user::direction(d.wi), user::number_of(d.pdf), {}, {}};
            if constexpr (requires { d.weight; }) out.weight = user::number_of(d.weight);
            return out;
        }
    }
    std::string name_;
    S sampler_;
};

/// Judges a sampler over a grid of w_o under an even light. Rigour::thorough() looks harder, and takes minutes. Where
/// `watch` says stop, Interrupted is thrown.
template <class S>
Judgement judge_sampler(std::string name, S sampler, const Rigour& rigour = Rigour::quick(), Watch* watch = nullptr) {
    user::must_be_judgeable<S>();
    if constexpr (user::Callable<S> && !user::TakesThree<S>) {
        const auto subject = std::make_shared<UserSubject<S>>(std::move(name), std::move(sampler));
        Watch alone;
        return judge(trials_of_subject(subject, rigour.full), rigour, watch ? *watch : alone);
    } else {
        return {};
    }
}

}  // namespace crescent
