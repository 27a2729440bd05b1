// Checks of a user's sampler. The sampler is a struct with
//
//   sample(wo, u)   -> a struct with .wi and .pdf; optional: .weight, the value f cos / p; .delta, for a draw of
//                      a delta part: true or its probability, which is .pdf too; .weight is then required
//   pdf(wo, wi)     -> a number, 1/sr; optional: without it only the remaining tests are made
//   f(wo, wi)       -> a number, 1/sr, or three, without the cosine; optional
//   traits()        -> crescent::Traits: w_o on both sides, the index, own random numbers; optional
//
// in plain floats or doubles: directions and u may be arrays, spans, const T* or structs that braces initialise. u
// holds one to eight numbers, in one parameter or several: (wo, u), (wo, uc, u). wi and pdf may be output references.
// An environment light has sample(u), or sample(uc, u), and pdf(wi). n = +z; both directions leave the surface. SIMD or
// a base class is not needed:
//
//   crescent::CheckResult j = crescent::check_sampler("mine", MySampler{});
//
// Points of other domains than directions: a PointSampler (check/sources/point_sampler.h).
//
// A pointer to a sampler is checked like the sampler; sampler_of(sample, pdf, f) makes a sampler from lambdas.
//
// Members that are const are called by many threads at the same time, others by one; so are closures of sampler_of that
// capture something and draw with random numbers of their own (Traits::own_random), such as one generator. An exception
// of a sampler gives the state "error", not "wrong". An empty std::optional, and false with output references, mean
// that there is no sample.
#pragma once

#include <fmt/format.h>

#include "check/check.h"
#include "check/sources/point_sampler.h"
#include "check/sources/decorators.h"
#include "check/sources/check_case.h"
#include "check/sources/user_sampler.h"

namespace crescent::user {

/// Whether all parameters are directions.
template <class T> consteval bool are_directions() {
    return []<std::size_t... i>(std::index_sequence<i...>) { return (Direction<At<T, i>> && ...); }(
               std::make_index_sequence<count_of<T>>{});
}
/// Whether pdf takes directions and returns a number; whether f takes them and returns its channels; whether traits()
/// is valid; whether sample takes wo and random numbers; whether it returns a direction and a density.
template <class S> consteval bool takes_directions() {
    if constexpr (!HasPdf<S>) return true;
    else {
        using T = typename OfPdf<S>::Parameters;
        return are_directions<T>() && count_of<T> == (without_wo<S>() ? 1 : 2);
    }
}
template <class S> consteval bool gives_pdf() {
    if constexpr (!HasPdf<S>) return true;
    else return Scalar<Bare<typename OfPdf<S>::Result>>;
}
template <class S> consteval bool f_fits() {
    if constexpr (!HasF<S>) return true;
    else {
        using T = typename OfF<S>::Parameters;
        return are_directions<T>() && (count_of<T> == 1 || count_of<T> == 2) && Channels<Bare<typename OfF<S>::Result>>;
    }
}
template <class S> consteval bool traits_fit() {
    return !HasTraits<S> || requires(const S s) {
        { s.traits() } -> std::convertible_to<Traits>;
    };
}
template <class S> consteval bool takes_numbers() {
    using T = SampleParameters<S>;
    if constexpr (input_count<T>() < 1 || output_count<T>() == 1 || output_count<T>() > 3) return false;
    else {
        constexpr bool is_known = []<std::size_t... i>(std::index_sequence<i...>) {
            return ((Written<At<T, i>> || size_of<At<T, i>>() >= 0) && ...);
        }(std::make_index_sequence<count_of<T>>{});
        if constexpr (!is_known) return false;
        else
            return numbers<S>() >= 1 && numbers<S>() <= PrimarySample::most_numbers &&
                (without_wo<S>() || Direction<At<T, 0>>);
    }
}
template <class S> consteval bool gives_draws() {
    using T = SampleParameters<S>;
    constexpr std::size_t reads = input_count<T>();
    if constexpr (output_count<T>() > 1) return Three<Value<At<T, reads>>> && Scalar<Value<At<T, reads + 1>>>;
    else
        return requires(const Result<S> d) { direction(d.wi); } &&
            (!HasPdf<S> || requires(const Result<S> d) { number_of(d.pdf); });
}
template <class S> consteval bool gives_weights() {
    using T = SampleParameters<S>;
    if constexpr (output_count<T>() > 2) return Channels<Value<At<T, input_count<T>() + 2>>>;
    else if constexpr (output_count<T>() > 0) return true;
    else if constexpr (requires(const Result<S> d) { d.weight; })
        return requires(const Result<S> d) { colour(d.weight); };
    else if constexpr (requires(const Result<S> d) { d.f; }) return requires(const Result<S> d) { colour(d.f); };
    else return true;
}
/// Whether pdf and f, if the class declares them, can be called.
template <class S> consteval bool pdf_is_plain() { return HasPdf<S> || !names_pdf<S>(); }
template <class S> consteval bool f_is_plain() { return HasF<S> || !names_f<S>(); }
/// Whether f, which is what is called, has that name: an eval next to no f would be ignored.
template <class S> consteval bool f_is_named() { return names_f<S>() || !names_eval<S>(); }
template <class S> consteval bool is_checkable() {
    if constexpr (!HasSample<S> || !pdf_is_plain<S>() || !f_is_plain<S>() || !f_is_named<S>()) return false;
    else if constexpr (!takes_numbers<S>()) return false;
    else
        return takes_directions<S>() && gives_pdf<S>() && f_fits<S>() && traits_fit<S>() && gives_draws<S>() &&
            gives_weights<S>();
}
template <class S>
concept Checkable = std::is_class_v<SamplerOf<S>> && is_checkable<SamplerOf<S>>();

/// Reports what a struct lacks for a check as a compile-time message.
template <class S> consteval bool require_checkable() {
    static_assert(HasSample<S>,
        "a sampler has sample(wo, u), one public member of that name that is no template and not overloaded; otherwise "
        "pass crescent::sampler_of(sample, pdf, f), three lambdas that call yours");
    if constexpr (HasSample<S>) {
        static_assert(pdf_is_plain<S>(),
            "pdf is private, overloaded or a template: pass crescent::sampler_of(sample, pdf, f), three lambdas that "
            "call yours");
        static_assert(f_is_plain<S>(),
            "f is private, overloaded or a template: pass crescent::sampler_of(sample, pdf, f), three lambdas that "
            "call yours");
        static_assert(f_is_named<S>(),
            "eval is not called: name it f, without the cosine, or pass crescent::sampler_of(sample, pdf, f), whose f "
            "divides your eval by |cos| if it includes the cosine");
        static_assert(takes_numbers<S>(),
            "sample takes wo and then one to eight random numbers, sample(wo, u), sample(wo, uc, u), sample(u) or "
            "sample(uc, u): "
            "directions and u are arrays, spans, const T* or structs of floats or doubles that braces initialise; wi "
            "and pdf "
            "may be output references after them");
        if constexpr (takes_numbers<S>()) {
            static_assert(takes_directions<S>(),
                "pdf takes (wo, wi), directions in floats or doubles, or (wi) where sample takes no wo");
            static_assert(gives_pdf<S>(), "pdf returns one number, 1/sr");
            static_assert(f_fits<S>(),
                "f takes (wo, wi), directions in floats or doubles, and returns one number, 1/sr, or three: {r, g, b}, "
                "{x, y, z} or an array of three");
            static_assert(traits_fit<S>(), "traits() is const and returns crescent::Traits");
            static_assert(gives_draws<S>(),
                "sample returns something with .wi, a direction, and .pdf, a number in 1/sr (or a std::optional of "
                "that), or writes wi and pdf to references");
            static_assert(gives_weights<S>(),
                "the .weight or .f of a draw is one number or three: {r, g, b}, {x, y, z} or an array of three");
        }
    }
    return is_checkable<S>();
}

/// 3 if f or the weight is a colour, else 1; whether all members are const, so that several threads may call them;
/// whether a draw includes its weight; and the resulting traits.
template <class S> consteval int channels() {
    bool has_colour = false;
    if constexpr (HasF<S>) has_colour = Coloured<Bare<typename OfF<S>::Result>>;
    if constexpr (output_count<SampleParameters<S>>() == 0) {
        using D = Result<S>;
        if constexpr (requires(const D d) { d.weight; })
            has_colour = has_colour || Coloured<Bare<decltype(std::declval<D>().weight)>>;
        else if constexpr (requires(const D d) { colour(d.f); })
            has_colour = has_colour || Coloured<Bare<decltype(std::declval<D>().f)>>;
    }
    return has_colour ? 3 : 1;
}
template <class S> consteval bool all_const() {
    bool out = OfSample<S>::is_const;
    if constexpr (HasPdf<S>) out = out && OfPdf<S>::is_const;
    if constexpr (HasF<S>) out = out && OfF<S>::is_const;
    return out;
}
/// Whether sample is a closure that captures something, which its copies may share.
template <class S> consteval bool shares_state() {
    if constexpr (std::is_member_object_pointer_v<decltype(&S::sample)>)
        return !std::is_empty_v<Bare<decltype(std::declval<S&>().sample)>>;
    else return false;
}
template <class S> consteval bool returns_weights() {
    if constexpr (output_count<SampleParameters<S>>() > 0) return output_count<SampleParameters<S>>() > 2;
    else return HasWeight<Result<S>>;
}
template <class S> Traits traits_of(const S& s) {
    Traits t;
    if constexpr (requires {
                      { s.traits() } -> std::convertible_to<Traits>;
                  })
        t = s.traits();
    t.numbers = numbers<S>();
    t.channels = channels<S>();
    t.has_pdf = HasPdf<S>;
    if constexpr (without_wo<S>()) t.wo = Traits::WoDomain::none;
    if constexpr (output_count<SampleParameters<S>>() == 0) t.delta = HasDelta<Result<S>>;
    return t;
}

}  // namespace crescent::user

namespace crescent {

/// A user's struct as a SamplerAdapter. Members that are not const are called by one thread at a time.
template <class Given> class UserSampler : public InProcessAdapter {
    using S = user::SamplerOf<Given>;

public:
    /// `name` is used in messages; `sampler` may be a pointer.
    UserSampler(std::string name, Given sampler) : name_(std::move(name)), sampler_(std::move(sampler)) {}
    std::string name() const override { return name_; }
    Traits traits() const override { return user::traits_of(sampler()); }
    bool serial() const override { return !user::all_const<S>() || (user::shares_state<S>() && traits().own_random); }
    bool limited() const override { return false; }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        count(u.size());
        for (std::size_t i = 0; i < u.size(); ++i) {
            out[i] = called(
                "sample(wo, u)", wo, [&] { return text_of(u[i]); }, [&] { return user::sample(sampler(), wo, u[i]); });
            if (!user::HasPdf<S> && out[i].pdf > 0) out[i].pdf = 1;
        }
    }
    void pdf(int, std::span<const Pair> pairs, std::span<double> out) const override {
        if constexpr (user::HasPdf<S>) {
            count(pairs.size());
            for (std::size_t i = 0; i < pairs.size(); ++i)
                out[i] = called(
                    "pdf(wo, wi)", pairs[i].wo, [&] { return text_of(pairs[i].wi); },
                    [&] { return user::pdf(sampler(), pairs[i]); });
        } else
            for (double& p : out) p = 1;
    }
    bool has_f() const override { return user::HasF<S>; }
    bool has_drawn_f() const override { return user::HasF<S> || user::returns_weights<S>(); }
    void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const override {
        if constexpr (user::HasF<S>) count(pairs.size());
        if constexpr (user::HasF<S>)
            for (std::size_t i = 0; i < pairs.size(); ++i)
                out[i] = called(
                    "f(wo, wi)", pairs[i].wo, [&] { return text_of(pairs[i].wi); },
                    [&] { return user::f(sampler(), pairs[i]); });
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const override {
        std::vector<Vec3d> channel_values(out.size());
        f_channels(pairs, channel_values);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = user::channels<S>() == 3 ? luminance(channel_values[i]) : channel_values[i].x;
    }

private:
    std::string name_;
    mutable Given sampler_;  // called by one thread if a member is not const
    decltype(auto) sampler() const { return user::Sampler<Given>::of(sampler_); }

    static std::string text_of(Vec3d w) { return fmt::format("w_i = ({:.9g}, {:.9g}, {:.9g})", w.x, w.y, w.z); }
    static std::string text_of(const PrimarySample& u) {
        std::string out = "u = (";
        for (int k = 0; k < user::numbers<S>(); ++k) out += fmt::format("{}{:.9g}", k ? ", " : "", u[k]);
        return out + ")";
    }
    template <class Where, class Call>
    static auto called(const char* what, Vec3d wo, Where&& describe_place, Call&& call) {
        try {
            return call();
        } catch (const std::exception& e) { throw fault(what, e.what(), wo, describe_place()); } catch (...) {
            throw fault(what, "something", wo, describe_place());
        }
    }
    static SamplerError fault(const char* what, const char* why, Vec3d wo, const std::string& place) {
        return SamplerError(
            fmt::format("{} threw '{}' at w_o = ({:.9g}, {:.9g}, {:.9g}), {}", what, why, wo.x, wo.y, wo.z, place));
    }
};

/// Checks a sampler, or the target of a pointer, over a grid of w_o under a uniform light. TestSettings::thorough()
/// detects smaller faults and takes minutes. A sampler of another process, such as shader_sampler() returns, has limits
/// of time of its own. Throws Interrupted if `monitor` requests a stop.
template <class Given> CheckResult check_sampler(std::string name, Given&& sampler,
    const TestSettings& settings = TestSettings::quick(), ProgressMonitor* monitor = nullptr) {
    using S = std::decay_t<Given>;
    static_assert(!std::is_abstract_v<S>,
        "a sampler is copied, and one of an abstract class cannot be: pass a pointer to it, check_sampler(name, "
        "&sampler)");
    static_assert(std::is_abstract_v<S> || std::is_constructible_v<S, Given>,
        "a sampler is copied, and this one cannot be: pass a pointer to it, check_sampler(name, &sampler), or move it");
    if constexpr (std::is_abstract_v<S> || !std::is_constructible_v<S, Given>) return {};
    else if constexpr (user::Adapted<S>) {
        ProgressMonitor default_monitor;
        return run_checks(make_user_cases(renamed(sampler, name), settings.full, settings.wo), settings,
            monitor ? *monitor : default_monitor);
    } else if constexpr (std::is_same_v<S, PointSampler>) {
        ProgressMonitor default_monitor;
        return run_checks(
            make_user_cases(limited_in_time(adapter_of(sampler, name), settings.seconds), settings.full, settings.wo),
            settings, monitor ? *monitor : default_monitor);
    } else if constexpr (user::require_checkable<user::SamplerOf<S>>()) {
        const auto adapter = std::make_shared<UserSampler<S>>(std::move(name), S(std::forward<Given>(sampler)));
        ProgressMonitor default_monitor;
        return run_checks(make_user_cases(limited_in_time(adapter, settings.seconds), settings.full, settings.wo),
            settings, monitor ? *monitor : default_monitor);
    } else {
        return {};
    }
}

/// A sampler from functions: lambdas, std::functions or pointers to functions in place of members.
template <class Sample, class Pdf> struct SampleAndPdf {
    Sample sample;
    Pdf pdf;
    Traits stated_traits{};
    Traits traits() const { return stated_traits; }
};
/// The same with f.
template <class Sample, class Pdf, class F> struct SamplePdfAndF {
    Sample sample;
    Pdf pdf;
    F f;
    Traits stated_traits{};
    Traits traits() const { return stated_traits; }
};
/// For classes whose members are overloaded, templates or have other names; parameters and results are those of
/// members:
///
///   check_sampler("mine", sampler_of([&](V wo, float uc, V2 u) { return bsdf.Sample(wo, uc, u); },
///                                    [&](V wo, V wi) { return bsdf.Pdf(wo, wi); }));
template <class Sample, class Pdf> SampleAndPdf<Sample, Pdf> sampler_of(Sample sample, Pdf pdf, Traits traits = {}) {
    return {std::move(sample), std::move(pdf), traits};
}
/// The same with f(wo, wi).
template <class Sample, class Pdf, class F>
    requires(!std::is_same_v<F, Traits>)
SamplePdfAndF<Sample, Pdf, F> sampler_of(Sample sample, Pdf pdf, F f, Traits traits = {}) {
    return {std::move(sample), std::move(pdf), std::move(f), traits};
}

}  // namespace crescent
