// Your own sampler, judged. A struct with
//
//   sample(wo, u)   -> something with .wi and .pdf (and .weight, if it says f cos / p itself)
//   pdf(wo, wi)     -> a number, 1/sr
//   f(wo, wi)       -> a number, 1/sr, without the cosine; optional
//
// in plain floats or doubles: directions may be std::array<T, 3>, const T*, or a struct {x, y, z}; u std::array<T, 2>, const T* or
// {x, y}. n = +z; both directions leave the surface. No SIMD, no base class:
//
//   crescent::Judgement j = crescent::judge_sampler("mine", MySampler{});
//
// It is called from many threads at once, so its members must be const or without state.
#pragma once

#include <array>
#include <concepts>
#include <utility>

#include "verdicts/judge.h"
#include "verdicts/list.h"

namespace crescent {

namespace user {

template <class V> Vec3d direction(const V& v) {
    if constexpr (requires { v.x; v.y; v.z; }) return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
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
template <class S, class G> concept Takes = requires(const S s, typename G::Direction w, typename G::U u) {
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
    if constexpr (std::same_as<G, Braces>) return s.sample({Anything{wo.x}, Anything{wo.y}, Anything{wo.z}}, {Anything{u.x}, Anything{u.y}});
    else return s.sample(G::give(wo), G::give(u));
}
template <class S> double pdf(const S& s, const Pair& p) {
    using G = Way<S>;
    if constexpr (std::same_as<G, Braces>)
        return number_of(s.pdf({Anything{p.wo.x}, Anything{p.wo.y}, Anything{p.wo.z}}, {Anything{p.wi.x}, Anything{p.wi.y}, Anything{p.wi.z}}));
    else return number_of(s.pdf(G::give(p.wo), G::give(p.wi)));
}
template <class S> constexpr bool has_f() {
    if constexpr (std::same_as<Way<S>, Braces>) return requires(const S s, Anything a) { s.f({a, a, a}, {a, a, a}); };
    else return requires(const S s, typename Way<S>::Direction w) { s.f(w, w); };
}
template <class S> double f(const S& s, const Pair& p) {
    using G = Way<S>;
    if constexpr (std::same_as<G, Braces>)
        return number_of(s.f({Anything{p.wo.x}, Anything{p.wo.y}, Anything{p.wo.z}}, {Anything{p.wi.x}, Anything{p.wi.y}, Anything{p.wi.z}}));
    else return number_of(s.f(G::give(p.wo), G::give(p.wi)));
}

}  // namespace user

template <class S> class UserSubject : public JudgedSampler {
public:
    UserSubject(std::string name, S sampler) : name_(std::move(name)), sampler_(std::move(sampler)) {}
    std::string name() const override { return name_; }
    void sample(int, Vec3d wo, std::span<const Vec2d> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const auto d = user::sample(sampler_, wo, u[i]);
            out[i] = {user::direction(d.wi), user::number_of(d.pdf), {}};
            if constexpr (requires { d.weight; }) out[i].weight = user::number_of(d.weight);
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = user::pdf(sampler_, at[i]);
    }
    bool has_f() const override { return user::has_f<S>(); }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        if constexpr (user::has_f<S>())
            for (std::size_t i = 0; i < at.size(); ++i) out[i] = user::f(sampler_, at[i]);
        else JudgedSampler::f(at, out);
    }

private:
    std::string name_;
    S sampler_;
};

/// Judges a sampler over a grid of w_o under an even light. Rigour::thorough() looks harder, and takes minutes.
template <class S> Judgement judge_sampler(std::string name, S sampler, const Rigour& rigour = Rigour::quick()) {
    const auto subject = std::make_shared<UserSubject<S>>(std::move(name), std::move(sampler));
    Watch watch;
    return judge(trials_of_subject(subject, rigour.full), rigour, watch);
}

}  // namespace crescent
