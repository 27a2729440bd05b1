// Determines from the signatures of a user's members how they take directions and random numbers and return draws:
// scalars, arrays, spans, pointers, and structs that are initialised from numbers with braces.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "check/sources/check_case.h"

namespace crescent::user {

/// Result and parameters of a member that is not overloaded.
template <class M> struct Signature;
template <class R, bool is_const_, class... A> struct CallSignature {
    using Result = R;
    using Parameters = std::tuple<A...>;
    static constexpr bool is_const = is_const_;
};
template <class R, class S, class... A> struct Signature<R (S::*)(A...)> : CallSignature<R, false, A...> {};
template <class R, class S, class... A> struct Signature<R (S::*)(A...) const> : CallSignature<R, true, A...> {};
template <class R, class S, class... A> struct Signature<R (S::*)(A...) noexcept> : CallSignature<R, false, A...> {};
template <class R, class S, class... A> struct Signature<R (S::*)(A...) const noexcept> : CallSignature<R, true, A...> {
};
template <class R, class... A> struct Signature<R (*)(A...)> : CallSignature<R, true, A...> {};
template <class R, class... A> struct Signature<R (*)(A...) noexcept> : CallSignature<R, true, A...> {};
/// Callable data members: lambdas, function pointers, and std::function, whose target may not be const.
template <class C>
concept Called = std::is_class_v<C> && requires { &C::operator(); };
template <class S, Called C> struct Signature<C S::*> : Signature<decltype(&C::operator())> {};
template <class S, class R, class... A> struct Signature<R (*S::*)(A...)> : CallSignature<R, true, A...> {};
template <class S, class R, class... A> struct Signature<std::function<R(A...)> S::*> : CallSignature<R, false, A...> {
};
template <class M>
concept HasSignature = requires { typename Signature<M>::Parameters; };

/// The sampler itself, for one that is passed by a pointer: T*, unique_ptr, shared_ptr.
template <class S>
concept Pointing = requires(const S s) { *s; } && (std::is_pointer_v<S> || requires(const S s) {
    typename S::element_type;
    s.get();
});
template <class S> struct Sampler {
    using Type = S;
    static S& of(S& s) { return s; }
};
template <Pointing S> struct Sampler<S> {
    using Type = std::remove_reference_t<decltype(*std::declval<S&>())>;
    static Type& of(S& s) { return *s; }
};
/// A pointer to a sampler of another process.
template <class S>
concept Adapted = Pointing<S> && std::convertible_to<S, std::shared_ptr<const SamplerAdapter>>;
/// A copy of a sampler for the check: the sampler itself, or a pointer to it.
template <class S> auto copy_for_check(const S& s) {
    if constexpr (Adapted<S>) return s;
    else if constexpr (Pointing<S>) return &*s;
    else return s;
}
template <class S> using SamplerOf = std::remove_const_t<typename Sampler<S>::Type>;

/// Converts to any number type that initialises a user's struct.
struct Anything {
    double v = 0;
    template <std::floating_point T> operator T() const { return static_cast<T>(v); }
};
template <class C, int n> consteval bool is_built_from() {
    return []<std::size_t... i>(std::index_sequence<i...>) { return requires(Anything a) { C{((void)i, a)...}; }; }(
               std::make_index_sequence<n>{});
}

template <class C> using Bare = std::remove_cvref_t<C>;
template <class C>
concept Number = std::floating_point<Bare<C>>;
/// const T*: the type does not state how many numbers it points to.
template <class C>
concept Pointer = std::is_pointer_v<Bare<C>> && std::is_const_v<std::remove_pointer_t<Bare<C>>> &&
    std::floating_point<std::remove_cv_t<std::remove_pointer_t<Bare<C>>>>;
template <class C> struct SpanOf : std::false_type {};
template <class T, std::size_t n> struct SpanOf<std::span<T, n>> : std::bool_constant<std::is_const_v<T>> {
    using Value = std::remove_const_t<T>;
    static constexpr int extent = n == std::dynamic_extent ? 0 : static_cast<int>(n);
};
template <class C>
concept Span = SpanOf<Bare<C>>::value;
/// An output parameter: V& or V*.
template <class C>
concept Written = (std::is_lvalue_reference_v<C> && !std::is_const_v<std::remove_reference_t<C>>) ||
    (std::is_pointer_v<Bare<C>> && !std::is_const_v<std::remove_pointer_t<Bare<C>>>);

/// The number of numbers in a parameter; 0: not stated by the type; -1: not a container of numbers.
template <class C> consteval int size_of() {
    using B = Bare<C>;
    if constexpr (Written<C>) return -1;
    else if constexpr (Number<C>) return 1;
    else if constexpr (Pointer<C>) return 0;
    else if constexpr (Span<C>) return SpanOf<B>::extent;
    else if constexpr (std::is_class_v<B>) {
        if constexpr (is_built_from<B, 9>()) return -1;
        else {
            return []<int... n>(std::integer_sequence<int, n...>) {
                int largest = -1;
                ((is_built_from<B, n + 2>() ? largest = n + 2 : 0), ...);
                return largest;
            }(std::make_integer_sequence<int, 7>{});
        }
    } else return -1;
}

/// A parameter filled with numbers; it exists as long as the call.
template <class C> struct Filled {
    Bare<C> value;
    explicit Filled(std::span<const double> v)
        : value(make(v, std::make_index_sequence<static_cast<std::size_t>(size_of<C>())>{})) {}
    const Bare<C>& get() const { return value; }

private:
    template <std::size_t... i> static Bare<C> make(std::span<const double> v, std::index_sequence<i...>) {
        return Bare<C>{Anything{v[i]}...};
    }
};
template <Number C> struct Filled<C> {
    Bare<C> value;
    explicit Filled(std::span<const double> v) : value(static_cast<Bare<C>>(v[0])) {}
    Bare<C> get() const { return value; }
};
template <class T> struct Stored {
    std::array<T, PrimarySample::most_numbers> value{};
    explicit Stored(std::span<const double> v) {
        for (std::size_t i = 0; i < v.size() && i < value.size(); ++i) value[i] = static_cast<T>(v[i]);
    }
};
template <Pointer C> struct Filled<C> : Stored<std::remove_cv_t<std::remove_pointer_t<Bare<C>>>> {
    using Stored<std::remove_cv_t<std::remove_pointer_t<Bare<C>>>>::Stored;
    auto get() const { return this->value.data(); }
};
template <Span C> struct Filled<C> : Stored<typename SpanOf<Bare<C>>::Value> {
    std::size_t count;
    explicit Filled(std::span<const double> v) : Stored<typename SpanOf<Bare<C>>::Value>(v), count(v.size()) {}
    Bare<C> get() const { return Bare<C>(this->value.data(), count); }
};

/// The number of numbers that [0], [1] ... access; 0: not stated by the type.
template <class V> consteval std::size_t length_of() {
    if constexpr (std::is_array_v<V>) return std::extent_v<V>;
    else if constexpr (requires { std::tuple_size<V>::value; }) return std::tuple_size_v<V>;
    else if constexpr (SpanOf<V>::value) return static_cast<std::size_t>(SpanOf<V>::extent);
    else return 0;
}
template <class V>
concept Xyz = requires(const V v) {
    static_cast<double>(v.x);
    static_cast<double>(v.y);
    static_cast<double>(v.z);
};
template <class V>
concept Indexed = requires(const V v) { static_cast<double>(v[0]); };
/// A returned direction: {x, y, z}, or at least three numbers in a row.
template <class V>
concept Three = Xyz<V> || (Indexed<V> && (length_of<V>() == 0 || length_of<V>() >= 3));

template <Three V> Vec3d direction(const V& v) {
    if constexpr (Xyz<V>) return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    else return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}
template <class P>
concept Scalar = requires(const P p) { static_cast<double>(p); } || requires(const P p) { static_cast<double>(p.v); };
template <Scalar P> double number_of(const P& p) {
    if constexpr (requires { p.v; }) return static_cast<double>(p.v);
    else return static_cast<double>(p);
}
template <class P>
concept Rgb3 = requires(const P p) {
    static_cast<double>(p.r);
    static_cast<double>(p.g);
    static_cast<double>(p.b);
};
/// Three channels: an array of three, or a struct {r, g, b} or {x, y, z}.
template <class P>
concept Coloured = !Scalar<P> && (Rgb3<P> || Xyz<P> || (Three<P> && length_of<P>() <= 3));
/// The types of f and of a weight.
template <class P>
concept Channels = Scalar<P> || Coloured<P>;
template <Channels P> Vec3d colour(const P& p) {
    if constexpr (Scalar<P>) return {number_of(p), number_of(p), number_of(p)};
    else if constexpr (Rgb3<P>) return {static_cast<double>(p.r), static_cast<double>(p.g), static_cast<double>(p.b)};
    else return direction(p);
}
template <class D>
concept Optional = requires(const D d) {
    d.has_value();
    *d;
};

// ---- Calls of a user's sampler: the parameters that are w_o, random numbers or outputs, and the result of a draw.
//
//   sample(wo, u)   sample(wo, uc, u)   sample(wo, u, wi&, pdf&)   sample(u) and sample(uc, u), without w_o
//
// Numbers are assigned to the first parameter that holds two or more of them, then to the others in their order: uc of
// (wo, uc, u) is the third.

template <class S>
concept HasSample = requires { &S::sample; } && HasSignature<decltype(&S::sample)>;
template <class S>
concept HasPdf = requires { &S::pdf; } && HasSignature<decltype(&S::pdf)>;
template <class S>
concept HasF = requires { &S::f; } && HasSignature<decltype(&S::f)>;

/// A name inherited from two bases is ambiguous, which shows that S has a member of that name even if it is overloaded,
/// private or a template; otherwise S would count as a sampler without it.
struct Names {
    int sample, pdf, f, eval;
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
/// Whether a class without f has a member eval, as the BSDFs of Mitsuba have.
template <class S> consteval bool names_eval() {
    if constexpr (Derivable<S>) return !requires { &Named<S>::eval; };
    else return requires { &S::eval; };
}
template <class S>
concept HasTraits = requires { &S::traits; } || requires(S s) { s.traits(); };
template <class S> using OfSample = Signature<decltype(&S::sample)>;
template <class S> using OfPdf = Signature<decltype(&S::pdf)>;
template <class S> using OfF = Signature<decltype(&S::f)>;
template <class S> using SampleParameters = typename OfSample<S>::Parameters;

template <class T> inline constexpr std::size_t count_of = std::tuple_size_v<T>;
template <class T, std::size_t i> using At = std::tuple_element_t<i, T>;

/// Number of input parameters of a tuple; output parameters are at its end.
template <class T> consteval std::size_t input_count() {
    return []<std::size_t... i>(std::index_sequence<i...>) {
        return (std::size_t{0} + ... + (Written<At<T, i>> ? 0 : 1));
    }(std::make_index_sequence<count_of<T>>{});
}
template <class T> consteval std::size_t output_count() { return count_of<T> - input_count<T>(); }

/// For a pointer to u S::numbers gives the number of its elements, by default two.
template <class S, class C> consteval int numbers_in() {
    constexpr int n = size_of<C>();
    if constexpr (n != 0) return n;
    else if constexpr (requires { S::numbers; }) return static_cast<int>(S::numbers);
    else return 2;
}
template <class C>
concept Direction = size_of<C>() == 3 || size_of<C>() == 0 || size_of<C>() == 4;  // the fourth of a padded one is 0

/// Whether the member takes no w_o: sample(u), or sample(choice, u), whose first parameter is one number or two.
template <class S> consteval bool without_wo() {
    using T = SampleParameters<S>;
    if constexpr (input_count<T>() <= 1) return input_count<T>() == 1;
    else return size_of<At<T, 0>>() == 1 || size_of<At<T, 0>>() == 2;
}

/// The numbers of parameter `i` of sample: the first one, and how many.
struct Share {
    int first = 0, count = 0;
};
template <class S> consteval auto shares() {
    using T = SampleParameters<S>;
    constexpr std::size_t inputs = input_count<T>(), from = without_wo<S>() ? 0 : 1;
    std::array<Share, inputs + 1> out{};
    int next = 0;
    [&]<std::size_t... i>(std::index_sequence<i...>) { ((out[i].count = numbers_in<S, At<T, i>>()), ...); }(
        std::make_index_sequence<inputs>{});
    for (int pass = 0; pass < 2; ++pass)  // those with two or more members first
        for (std::size_t i = from; i < inputs; ++i) {
            if ((out[i].count > 1) != (pass == 0)) continue;
            out[i].first = next;
            next += out[i].count;
        }
    out[inputs].count = next;
    return out;
}
template <class S> consteval int numbers() { return shares<S>()[input_count<SampleParameters<S>>()].count; }

/// The value type of an output parameter; passed as the parameter declares.
template <class C> using Value = std::remove_cv_t<std::remove_pointer_t<Bare<C>>>;
template <class C> decltype(auto) pass_output(Value<C>& v) {
    if constexpr (std::is_pointer_v<Bare<C>>) return &v;
    else return (v);
}

template <class S, class C, std::size_t i> Filled<C> filled(Vec3d wo, const PrimarySample& u) {
    constexpr Share share = shares<S>()[i];
    const std::array<double, 4> w = {wo.x, wo.y, wo.z, 0};
    if constexpr (i == 0 && !without_wo<S>())
        return Filled<C>(std::span<const double>(w).first(size_of<C>() == 4 ? 4 : 3));
    std::array<double, PrimarySample::most_numbers> v{};
    for (int k = 0; k < share.count; ++k) v[static_cast<std::size_t>(k)] = u[share.first + k];
    return Filled<C>(std::span<const double>(v).first(static_cast<std::size_t>(share.count)));
}

/// Adds f and the weight of a draw if its type has these members.
template <class D> Draw described(const D& d) {
    Draw out{direction(d.wi), 1};
    if constexpr (requires { d.pdf; }) out.pdf = number_of(d.pdf);
    const auto set_weight = [&](Vec3d w, bool is_coloured) {
        out.weights = w;
        out.weight = is_coloured ? luminance(w) : w.x;
    };
    if constexpr (requires { d.weight; }) set_weight(colour(d.weight), Coloured<Bare<decltype(d.weight)>>);
    else if constexpr (requires { colour(d.f); }) {
        if (out.pdf > 0) set_weight(colour(d.f) * (std::fabs(out.wi.z) / out.pdf), Coloured<Bare<decltype(d.f)>>);
    }
    double q = 0;
    if constexpr (requires {
                      { d.delta } -> std::convertible_to<double>;
                  })
        q = std::is_same_v<Bare<decltype(d.delta)>, bool> ? (d.delta ? out.pdf : 0) : static_cast<double>(d.delta);
    else if constexpr (requires { d.IsSpecular(); }) q = d.IsSpecular() ? out.pdf : 0;
    else if constexpr (requires { d.specular; }) q = d.specular ? out.pdf : 0;
    if (q > 0) {
        out.delta = q;
        out.pdf = 0;
    }
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
concept HasDelta = requires(const D d) {
    { d.delta } -> std::convertible_to<double>;
} || requires(const D d) { d.IsSpecular(); } || requires(const D d) { d.specular; };
template <class D>
concept HasWeight = requires(const D d) { d.weight; } || requires(const D d) { d.f; };

/// bool or void with wi and pdf as outputs, and then a weight.
template <class S, class... C>
Draw written(S& s, Vec3d wo, const PrimarySample& u, std::type_identity<std::tuple<C...>>) {
    using T = std::tuple<C...>;
    constexpr std::size_t inputs = input_count<T>();
    std::tuple<Value<C>...> store{};
    bool is_drawn = true;
    [&]<std::size_t... i, std::size_t... k>(std::index_sequence<i...>, std::index_sequence<k...>) {
        const auto arguments = std::make_tuple(filled<S, At<T, i>, i>(wo, u)...);
        const auto call = [&] {
            return s.sample(
                std::get<i>(arguments).get()..., pass_output<At<T, inputs + k>>(std::get<inputs + k>(store))...);
        };
        if constexpr (std::convertible_to<typename OfSample<S>::Result, bool>) is_drawn = static_cast<bool>(call());
        else call();
    }(std::make_index_sequence<inputs>{}, std::make_index_sequence<output_count<T>()>{});
    if (!is_drawn) return {{0, 0, 1}, 0};
    Draw out{direction(std::get<inputs>(store)), number_of(std::get<inputs + 1>(store))};
    if constexpr (output_count<T>() > 2) {
        const auto& weight = std::get<inputs + 2>(store);
        out.weights = colour(weight);
        out.weight = Coloured<Bare<decltype(weight)>> ? luminance(out.weights) : out.weights.x;
    }
    return out;
}

template <class S> Draw sample(S& s, Vec3d wo, const PrimarySample& u) {
    using T = SampleParameters<S>;
    if constexpr (output_count<T>() > 0) return written(s, wo, u, std::type_identity<T>{});
    else
        return [&]<std::size_t... i>(std::index_sequence<i...>) {
            return drawn(s.sample(filled<S, At<T, i>, i>(wo, u).get()...));
        }(std::make_index_sequence<count_of<T>>{});
}

/// Calls pdf or f: with (wo, wi), or with wi alone.
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
