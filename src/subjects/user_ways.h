// How a user's sampler takes directions and random numbers and gives its draws back, read off the signatures
// of its members: scalars, arrays, spans, pointers, and structs that are built from so many numbers with braces.
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

#include "subjects/subject.h"

namespace crescent::user {

/// Result and parameters of a member that is not overloaded.
template <class M> struct Signature;
template <class R, bool is_const_, class... A> struct Told {
    using Result = R;
    using Parameters = std::tuple<A...>;
    static constexpr bool is_const = is_const_;
};
template <class R, class S, class... A> struct Signature<R (S::*)(A...)> : Told<R, false, A...> {};
template <class R, class S, class... A> struct Signature<R (S::*)(A...) const> : Told<R, true, A...> {};
template <class R, class S, class... A> struct Signature<R (S::*)(A...) noexcept> : Told<R, false, A...> {};
template <class R, class S, class... A> struct Signature<R (S::*)(A...) const noexcept> : Told<R, true, A...> {};
template <class R, class... A> struct Signature<R (*)(A...)> : Told<R, true, A...> {};
template <class R, class... A> struct Signature<R (*)(A...) noexcept> : Told<R, true, A...> {};
/// Data members that can be called: lambdas, function pointers; a std::function, which may hold what is not const.
template <class C>
concept Called = std::is_class_v<C> && requires { &C::operator(); };
template <class S, Called C> struct Signature<C S::*> : Signature<decltype(&C::operator())> {};
template <class S, class R, class... A> struct Signature<R (*S::*)(A...)> : Told<R, true, A...> {};
template <class S, class R, class... A> struct Signature<std::function<R(A...)> S::*> : Told<R, false, A...> {};
template <class M>
concept HasSignature = requires { typename Signature<M>::Parameters; };

/// The sampler itself, of one that is handed over behind a pointer: T*, unique_ptr, shared_ptr.
template <class S>
concept Pointing = std::is_pointer_v<S> || requires(const S s) {
    typename S::element_type;
    s.get();
    *s;
};
template <class S> struct Sampler {
    using Type = S;
    static S& of(S& s) { return s; }
};
template <Pointing S> struct Sampler<S> {
    using Type = std::remove_reference_t<decltype(*std::declval<S&>())>;
    static Type& of(S& s) { return *s; }
};
/// What can be copied of a sampler that is looked at: itself, or a pointer to it.
template <class S> auto handed(const S& s) {
    if constexpr (Pointing<S>) return &*s;
    else return s;
}
template <class S> using SamplerOf = std::remove_const_t<typename Sampler<S>::Type>;

/// Turns into whichever number a struct of the sampler's own is built from.
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
/// const T*: how many it points to is not written there.
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
/// Written through: V& or V*.
template <class C>
concept Written = (std::is_lvalue_reference_v<C> && !std::is_const_v<std::remove_reference_t<C>>) ||
    (std::is_pointer_v<Bare<C>> && !std::is_const_v<std::remove_pointer_t<Bare<C>>>);

/// How many numbers a parameter holds; 0: it does not say; -1: it holds none.
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
                int most = -1;
                ((is_built_from<B, n + 2>() ? most = n + 2 : 0), ...);
                return most;
            }(std::make_integer_sequence<int, 7>{});
        }
    } else return -1;
}

/// A parameter filled with numbers; it lives as long as the call.
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
    std::array<T, Numbers::most> value{};
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

/// How many numbers [0], [1] ... reach; 0: the type does not say.
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
/// A direction that is given back: {x, y, z}, or at least three in a row.
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
/// What f and a weight may be.
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

}  // namespace crescent::user
