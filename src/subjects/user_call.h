// Calls of a user's sampler: which parameter is w_o, which are random numbers, what is written through, and
// what a draw says.
//
//   sample(wo, u)   sample(wo, uc, u)   sample(wo, u, wi&, pdf&)   sample(u), of a sampler without w_o
//
// Numbers go to the first parameter that holds two or more of them, then to the others in their order: uc of (wo, uc,
// u) is the third.
#pragma once

#include "subjects/user_ways.h"

namespace crescent::user {

template <class S>
concept HasSample = requires { &S::sample; } && HasSignature<decltype(&S::sample)>;
template <class S>
concept HasPdf = requires { &S::pdf; } && HasSignature<decltype(&S::pdf)>;
template <class S>
concept HasF = requires { &S::f; } && HasSignature<decltype(&S::f)>;

/// A class that inherits a name from both of its bases cannot say which it means: so a name shows that S has it, though
/// it be overloaded, private or a template, which would else pass for a sampler without.
struct Names {
    int sample, pdf, f;
};
template <class S> struct Named : S, Names {};
template <class S>
concept Derivable = std::is_class_v<S> && !std::is_final_v<S>;
template <class S> consteval bool names_pdf() {
    if constexpr (Derivable<S>) return !requires { &Named<S>::pdf; };
    else return HasPdf<S>;
}
template <class S> consteval bool names_f() {
    if constexpr (Derivable<S>) return !requires { &Named<S>::f; };
    else return HasF<S>;
}
template <class S>
concept HasTraits = requires { &S::traits; } || requires(S s) { s.traits(); };
template <class S> using OfSample = Signature<decltype(&S::sample)>;
template <class S> using OfPdf = Signature<decltype(&S::pdf)>;
template <class S> using OfF = Signature<decltype(&S::f)>;
template <class S> using SampleParameters = typename OfSample<S>::Parameters;

template <class T> inline constexpr std::size_t count_of = std::tuple_size_v<T>;
template <class T, std::size_t i> using At = std::tuple_element_t<i, T>;

/// Parameters of a tuple that are not written through; those that are stand at the end.
template <class T> consteval std::size_t read_of() {
    return []<std::size_t... i>(std::index_sequence<i...>) {
        return (std::size_t{0} + ... + (Written<At<T, i>> ? 0 : 1));
    }(std::make_index_sequence<count_of<T>>{});
}
template <class T> consteval std::size_t written_of() { return count_of<T> - read_of<T>(); }

/// A pointer to u says by S::numbers how many there are, else two.
template <class S, class C> consteval int numbers_in() {
    constexpr int n = size_of<C>();
    if constexpr (n != 0) return n;
    else if constexpr (requires { S::numbers; }) return static_cast<int>(S::numbers);
    else return 2;
}
template <class C>
concept Direction = size_of<C>() == 3 || size_of<C>() == 0 || size_of<C>() == 4;  // the fourth of a padded one is 0

/// sample(u): w_o is not asked for.
template <class S> consteval bool without_wo() { return read_of<SampleParameters<S>>() == 1; }

/// Which numbers parameter `i` of sample gets: the first of them, and how many.
struct Share {
    int first = 0, count = 0;
};
template <class S> consteval auto shares() {
    using T = SampleParameters<S>;
    constexpr std::size_t reads = read_of<T>(), from = without_wo<S>() ? 0 : 1;
    std::array<Share, reads + 1> out{};
    int next = 0;
    [&]<std::size_t... i>(std::index_sequence<i...>) { ((out[i].count = numbers_in<S, At<T, i>>()), ...); }(
        std::make_index_sequence<reads>{});
    for (int pass = 0; pass < 2; ++pass)  // those with two or more members first
        for (std::size_t i = from; i < reads; ++i) {
            if ((out[i].count > 1) != (pass == 0)) continue;
            out[i].first = next;
            next += out[i].count;
        }
    out[reads].count = next;
    return out;
}
template <class S> consteval int numbers() { return shares<S>()[read_of<SampleParameters<S>>()].count; }

/// What is written through stands as a value; handed over as it is wanted.
template <class C> using Value = std::remove_cv_t<std::remove_pointer_t<Bare<C>>>;
template <class C> decltype(auto) hand(Value<C>& v) {
    if constexpr (std::is_pointer_v<Bare<C>>) return &v;
    else return (v);
}

template <class S, class C, std::size_t i> Filled<C> filled(Vec3d wo, const Numbers& u) {
    constexpr Share share = shares<S>()[i];
    const std::array<double, 4> w = {wo.x, wo.y, wo.z, 0};
    if constexpr (i == 0 && !without_wo<S>())
        return Filled<C>(std::span<const double>(w).first(size_of<C>() == 4 ? 4 : 3));
    std::array<double, Numbers::most> v{};
    for (int k = 0; k < share.count; ++k) v[static_cast<std::size_t>(k)] = u[share.first + k];
    return Filled<C>(std::span<const double>(v).first(static_cast<std::size_t>(share.count)));
}

/// f, a weight or nothing of a draw that says so by its members.
template <class D> Draw described(const D& d) {
    Draw out{direction(d.wi), 1};
    if constexpr (requires { d.pdf; }) out.pdf = number_of(d.pdf);
    const auto weigh = [&](Vec3d w, bool coloured) { out.weights = w, out.weight = coloured ? luminance(w) : w.x; };
    if constexpr (requires { d.weight; }) weigh(colour(d.weight), Coloured<Bare<decltype(d.weight)>>);
    else if constexpr (requires { colour(d.f); }) {
        if (out.pdf > 0) weigh(colour(d.f) * (std::fabs(out.wi.z) / out.pdf), Coloured<Bare<decltype(d.f)>>);
    }
    double q = 0;
    if constexpr (requires {
                      { d.delta } -> std::convertible_to<double>;
                  })
        q = std::is_same_v<Bare<decltype(d.delta)>, bool> ? (d.delta ? out.pdf : 0) : static_cast<double>(d.delta);
    else if constexpr (requires { d.IsSpecular(); }) q = d.IsSpecular() ? out.pdf : 0;
    else if constexpr (requires { d.specular; }) q = d.specular ? out.pdf : 0;
    if (q > 0) out.delta = q, out.pdf = 0;
    return out;
}
template <class D> Draw drawn(const D& d) {
    if constexpr (Optional<D>) return d.has_value() ? drawn(*d) : Draw{{0, 0, 1}, 0};
    else return described(d);
}
template <class D> struct Inner {
    using Type = D;
};
template <Optional D> struct Inner<D> {
    using Type = Bare<decltype(*std::declval<const D&>())>;
};
template <class S> using Result = typename Inner<Bare<typename OfSample<S>::Result>>::Type;
template <class D>
concept TellsDelta = requires(const D d) {
    { d.delta } -> std::convertible_to<double>;
} || requires(const D d) { d.IsSpecular(); } || requires(const D d) { d.specular; };
template <class D>
concept TellsWeight = requires(const D d) { d.weight; } || requires(const D d) { d.f; };

/// bool or void, with wi and pdf written through, and then a weight.
template <class S, class... C> Draw written(S& s, Vec3d wo, const Numbers& u, std::type_identity<std::tuple<C...>>) {
    using T = std::tuple<C...>;
    constexpr std::size_t reads = read_of<T>();
    std::tuple<Value<C>...> store{};
    bool is_drawn = true;
    [&]<std::size_t... i, std::size_t... k>(std::index_sequence<i...>, std::index_sequence<k...>) {
        const auto given = std::make_tuple(filled<S, At<T, i>, i>(wo, u)...);
        const auto call = [&] {
            return s.sample(std::get<i>(given).get()..., hand<At<T, reads + k>>(std::get<reads + k>(store))...);
        };
        if constexpr (std::convertible_to<typename OfSample<S>::Result, bool>) is_drawn = static_cast<bool>(call());
        else call();
    }(std::make_index_sequence<reads>{}, std::make_index_sequence<written_of<T>()>{});
    if (!is_drawn) return {{0, 0, 1}, 0};
    Draw out{direction(std::get<reads>(store)), number_of(std::get<reads + 1>(store))};
    if constexpr (written_of<T>() > 2) {
        const auto& weight = std::get<reads + 2>(store);
        out.weights = colour(weight);
        out.weight = Coloured<Bare<decltype(weight)>> ? luminance(out.weights) : out.weights.x;
    }
    return out;
}

template <class S> Draw sample(S& s, Vec3d wo, const Numbers& u) {
    using T = SampleParameters<S>;
    if constexpr (written_of<T>() > 0) return written(s, wo, u, std::type_identity<T>{});
    else
        return [&]<std::size_t... i>(std::index_sequence<i...>) {
            return drawn(s.sample(filled<S, At<T, i>, i>(wo, u).get()...));
        }(std::make_index_sequence<count_of<T>>{});
}

/// pdf and f: of (wo, wi), or of wi alone.
template <class T, class Call> decltype(auto) with_pair(const Pair& p, Call&& call) {
    const auto four = [](Vec3d w) { return std::array<double, 4>{w.x, w.y, w.z, 0}; };
    const auto take = []<class C>(std::type_identity<C>, const std::array<double, 4>& w) {
        return Filled<C>(std::span<const double>(w).first(size_of<C>() == 4 ? 4 : 3));
    };
    const std::array<double, 4> wo = four(p.wo), wi = four(p.wi);
    if constexpr (count_of<T> == 1) return call(take(std::type_identity<At<T, 0>>{}, wi).get());
    else return call(take(std::type_identity<At<T, 0>>{}, wo).get(), take(std::type_identity<At<T, 1>>{}, wi).get());
}
template <class S> double pdf(S& s, const Pair& p) {
    return with_pair<typename OfPdf<S>::Parameters>(p, [&](const auto&... w) { return number_of(s.pdf(w...)); });
}
template <class S> Vec3d f(S& s, const Pair& p) {
    return with_pair<typename OfF<S>::Parameters>(p, [&](const auto&... w) { return colour(s.f(w...)); });
}

}  // namespace crescent::user
