// Lights of a case, random numbers of a sampler, and adapters.
#include "check/sources/sampler_adapter.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <unordered_map>

#include "base/text.h"
#include "check/estimate/stream.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "math/simd/scalar.h"
#include "output/format.h"

namespace crescent {

// ---- The nearest light along w_i counts. Disks emit from the side of their normal; distances in m.

std::optional<double> CaseDiskLight::distance(Vec3d wi) const {
    const double c = dot(center, normal), v = dot(wi, normal);
    if (!(v < 0 && c < 0)) return {};
    const Vec3d offset = wi * c - center * v;
    if (!(dot(offset, offset) <= sqr(radius * v))) return {};
    return c / v;
}

std::optional<double> CaseAreaLight::distance(Vec3d wi) const {
    const Vec3d here{};
    return std::visit(
        [&](const auto& light) -> std::optional<double> {
            const double t = light.shines_on(here) ? light.body().intersect(here, wi).t : never;
            return t < never ? std::optional(t) : std::nullopt;
        },
        form);
}

double CaseAreaLight::power() const {
    return radiance * std::visit([](const auto& light) { return light.disk_area(); }, form);
}

std::optional<CaseLighting::Met> CaseLighting::first_met(Vec3d wi) const {
    std::optional<Met> first;
    const auto look = [&](const auto& lights) {
        for (const auto& light : lights)
            if (const std::optional<double> d = light.distance(wi); d && (!first || *d < first->distance))
                first = Met{*d, light.radiance};
    };
    look(disks);
    look(area_lights);
    return first;
}

double CaseLighting::operator()(Vec3d wi) const {
    if (wi.z <= 0) return 0;
    const std::optional<Met> met = first_met(wi);
    if (around) {
        const Vec3d w = frame.to_world(wi);
        if (around->triangles) {
            const std::uint32_t k = around->triangles->nearest(position, w);
            if (k != no_triangle && (!met || around->triangles->distance(k, position, w) < met->distance))
                return crescent::luminance(around->triangles->triangles()[k].radiance);
        }
        if (!met && around->sky) return crescent::luminance(around->sky->radiance(around->sky->texel_at(w)));
    }
    return met ? met->radiance : fill;
}

std::string CheckCase::text() const {
    const bool none = adapter && adapter->traits().wo == Traits::WoDomain::none;
    std::string s = none ? std::string(without_wo) : fmt::format("w_o {:g} deg", theta_deg);
    if (theta_deg > 0) s += fmt::format(" az {:g}", azimuth_deg);
    for (const auto& [name, value] : parameters) s += fmt::format(", {}={:g}", name, value);
    for (const std::string& part : {brdf, lighting})
        if (!part.empty()) s += ", " + part;
    return s;
}

std::vector<PrimarySample> numbers_of_chart(int count) {
    constexpr check::StreamKey key{.seed = 0x6c696e65, .purpose = check::Purpose::pilot};
    std::vector<PrimarySample> out(draws_of_chart);
    for (std::uint32_t i = 0; i < draws_of_chart; ++i)
        out[i] = check::numbers_at(key, i, count, check::Resolution::standard);
    return out;
}

Draw draw_of_point(
    const DomainChart& domain, std::span<const double> point, double pdf, const PrimarySample& u, int numbers) {
    if (pdf == 0) return {{0, 0, 1}, 0};
    if (!domain.domain().fault(point).empty()) {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        domain.note_outside(point);
        return {{none, none, none}, pdf};
    }
    std::array<double, PrimarySample::most_numbers> spread{};
    const std::size_t count = domain.spreads();
    for (std::size_t k = 0; k < count; ++k) spread[k] = u[numbers + static_cast<int>(k)];
    const Vec3d w = domain.direction(point, std::span(spread).first(count));
    std::array<double, Domain::most_coordinates> image{};
    return {w, pdf * domain.point(w, std::span(image).first(point.size()))};
}

std::string place_text(const Traits& traits, Vec3d w) {
    if (std::isnan(w.x + w.y + w.z)) return traits.domain ? traits.domain->first_outside() : "w_i NaN";
    return traits.domain ? traits.domain->text(w) : "w_i = " + direction_text(w);
}

Vec3d tilt(double theta_deg, double azimuth_deg) {
    const math::SinCos theta = math::sincos(theta_deg * pi / 180);
    return math::spherical(theta.sin, theta.cos, azimuth_deg * pi / 180);
}

// ---- Random numbers in pairs from the stream of the pixel, at most 1 - 2^-24.

PrimarySample drawn_numbers(
    std::uint32_t seed, std::uint32_t pixel, std::uint64_t i, std::uint32_t technique, int count) {
    PrimarySample out;
    for (int k = 0; k < count; k += 2) {
        const Vec2<float> u = draw(seed, pixel, i, technique + 16 * static_cast<std::uint32_t>(k) / 2);
        out[k] = u.x;
        if (k + 1 < PrimarySample::most_numbers) out[k + 1] = u.y;
    }
    return out;
}

// ---- Caches answers by the bits of (w_o, w_i), and draws by the bits of w_o and u. Only new pairs are evaluated, in
// their order. If a sampler throws, nothing of that call is cached.

namespace {

struct Key {
    std::array<std::uint64_t, 6> bits;
    explicit Key(const Pair& p)
        : bits{std::bit_cast<std::uint64_t>(p.wo.x), std::bit_cast<std::uint64_t>(p.wo.y),
              std::bit_cast<std::uint64_t>(p.wo.z), std::bit_cast<std::uint64_t>(p.wi.x),
              std::bit_cast<std::uint64_t>(p.wi.y), std::bit_cast<std::uint64_t>(p.wi.z)} {}
    bool operator==(const Key&) const = default;
};

struct KeyHash {
    std::size_t operator()(const Key& key) const {
        std::uint64_t h = 0x9e3779b97f4a7c15u;
        for (std::uint64_t b : key.bits) h = (h ^ (b >> 29) ^ b) * 0xbf58476d1ce4e5b9u;
        return static_cast<std::size_t>(h ^ (h >> 32));
    }
};

template <class Value> using Cache = std::unordered_map<Key, Value, KeyHash>;

/// Returns cached answers; `forward` is called once with the new pairs, in their order.
template <class Value, class Forward>
void answer(Cache<Value>& cache, std::span<const Pair> pairs, std::span<Value> out, const Forward& forward) {
    std::vector<Pair> fresh;
    for (const Pair& p : pairs)
        if (cache.try_emplace(Key(p)).second) fresh.push_back(p);
    std::vector<Value> values(fresh.size());
    try {
        if (!fresh.empty()) forward(std::span<const Pair>(fresh), std::span<Value>(values));
    } catch (...) {
        for (const Pair& p : fresh) cache.erase(Key(p));
        throw;
    }
    for (std::size_t i = 0; i < fresh.size(); ++i) cache[Key(fresh[i])] = values[i];
    for (std::size_t i = 0; i < pairs.size(); ++i) out[i] = cache[Key(pairs[i])];
}

bool same(const PrimarySample& a, const PrimarySample& b) { return a.x == b.x && a.y == b.y && a.more == b.more; }

/// Counts the calls of one case, independent of other cases of the same sampler.
class Counted : public ForwardingAdapter {
public:
    using ForwardingAdapter::ForwardingAdapter;
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        answers_ += u.size();
        inner().sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        answers_ += pairs.size();
        inner().pdf(t, pairs, out);
    }
    void exact_pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        answers_ += pairs.size();
        inner().exact_pdf(t, pairs, out);
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const override {
        answers_ += pairs.size();
        inner().f(pairs, out);
    }
    void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const override {
        answers_ += pairs.size();
        inner().f_channels(pairs, out);
    }
    QueryUsage spending() const override {
        const QueryUsage of_all = inner().spending();
        return {answers_, of_all.seconds, of_all.allowed};
    }

private:
    mutable std::uint64_t answers_ = 0;
};

class CachingAdapter : public ForwardingAdapter {
public:
    CachingAdapter(std::shared_ptr<const SamplerAdapter> sampler, bool draws)
        : ForwardingAdapter(std::make_shared<Counted>(std::move(sampler))), caches_draws_(draws) {}
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        if (!caches_draws_) return inner().sample(t, wo, u, out);
        for (const Drawn& d : drawn_)
            if (d.technique == t && Key({wo, wo}) == Key({d.wo, d.wo}) && std::ranges::equal(d.u, u, same)) {
                std::ranges::copy(d.draws, out.begin());
                return;
            }
        inner().sample(t, wo, u, out);
        drawn_.push_back({t, wo, {u.begin(), u.end()}, {out.begin(), out.end()}});
    }
    void pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        if (!caches_draws_ || t > 1) return inner().pdf(t, pairs, out);
        answer<double>(plain_pdf_[static_cast<std::size_t>(t)], pairs, out,
            [&](std::span<const Pair> a, std::span<double> o) { inner().pdf(t, a, o); });
    }
    void exact_pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        if (t > 1) return inner().exact_pdf(t, pairs, out);
        answer<double>(pdf_[static_cast<std::size_t>(t)], pairs, out,
            [&](std::span<const Pair> a, std::span<double> o) { inner().exact_pdf(t, a, o); });
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const override {
        if (inner().traits().channels == 1)
            return answer<double>(f_, pairs, out, [&](auto a, auto o) { inner().f(a, o); });
        std::vector<Vec3d> by_channel(pairs.size());
        f_channels(pairs, by_channel);
        for (std::size_t i = 0; i < pairs.size(); ++i) out[i] = luminance(by_channel[i]);
    }
    void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const override {
        answer<Vec3d>(channels_, pairs, out, [&](auto a, auto o) { inner().f_channels(a, o); });
    }
    void reference_f(std::span<const Pair> pairs, std::span<double> out) const override {
        if (has_true_f()) inner().reference_f(pairs, out);
        else f(pairs, out);
    }
    const SamplerAdapter& uncached_sampler() const { return inner(); }

private:
    struct Drawn {
        int technique;
        Vec3d wo;
        std::vector<PrimarySample> u;
        std::vector<Draw> draws;
    };
    bool caches_draws_;
    mutable std::vector<Drawn> drawn_;
    mutable std::array<Cache<double>, 2> plain_pdf_;  // by technique
    mutable std::array<Cache<double>, 2> pdf_;        // by technique
    mutable Cache<double> f_;
    mutable Cache<Vec3d> channels_;
};

}  // namespace

std::shared_ptr<const SamplerAdapter> cached(std::shared_ptr<const SamplerAdapter> sampler, bool draws) {
    return std::make_shared<CachingAdapter>(std::move(sampler), draws);
}

Side PerDirectionCache::of(const CheckCase& check_case, std::uint32_t stream) {
    Side out{check_case, stream};
    if (!check_case.adapter->limited()) return out;
    if (!check_case.adapter->serial())
        return out.check_case.adapter = cached(check_case.adapter), out;  // called by many threads
    const std::array<double, 3> wo = {check_case.wo.x, check_case.wo.y, check_case.wo.z};
    if (cached_of_ != check_case.adapter || wo != wo_) {
        cached_of_ = check_case.adapter;
        wo_ = wo;
        stream_ = stream;
        cache_ = cached(check_case.adapter, true);
    }
    out.stream = stream_;
    out.check_case.adapter = cache_;
    return out;
}

const SamplerAdapter& uncached(const SamplerAdapter& sampler) {
    const auto* cache = dynamic_cast<const CachingAdapter*>(&sampler);
    return cache ? cache->uncached_sampler() : sampler;
}

// ---- What evaluates an external sampler.

void add_device(const std::string& arm, const SamplerAdapter& sampler, DevicesByArm& to) {
    const bool is_listed = std::ranges::any_of(to, [&](const auto& one) { return one.first == arm; });
    if (const EvaluationDevice device = sampler.device(); device.declared() && !is_listed) to.emplace_back(arm, device);
}

// ---- A sampler with another name.

namespace {

class RenamedAdapter : public ForwardingAdapter {
public:
    RenamedAdapter(std::shared_ptr<const SamplerAdapter> sampler, std::string name)
        : ForwardingAdapter(std::move(sampler)), name_(std::move(name)) {}
    std::string name() const override { return name_; }

private:
    std::string name_;
};

}  // namespace

std::shared_ptr<const SamplerAdapter> renamed(std::shared_ptr<const SamplerAdapter> sampler, const std::string& name) {
    return std::make_shared<RenamedAdapter>(std::move(sampler), name);
}

// ---- A sampler with a limited time.

namespace {

class TimedAdapter : public ForwardingAdapter {
    using Clock = std::chrono::steady_clock;

public:
    TimedAdapter(std::shared_ptr<const SamplerAdapter> sampler, double seconds)
        : ForwardingAdapter(std::move(sampler)), seconds_(seconds) {}
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        allow();
        inner().sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        allow();
        inner().pdf(t, pairs, out);
    }
    void exact_pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        allow();
        inner().exact_pdf(t, pairs, out);
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const override {
        allow();
        inner().f(pairs, out);
    }
    void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const override {
        allow();
        inner().f_channels(pairs, out);
    }

private:
    double seconds_;
    Clock::time_point began_ = Clock::now();
    void allow() const {
        if (std::chrono::duration<double>(Clock::now() - began_).count() > seconds_)
            throw SamplerTimeout("the limit of time is reached");
    }
};

}  // namespace

std::shared_ptr<const SamplerAdapter> limited_in_time(std::shared_ptr<const SamplerAdapter> sampler, double seconds) {
    if (!(seconds > 0)) return sampler;
    return std::make_shared<TimedAdapter>(std::move(sampler), seconds);
}

// ---- Adds the side to the message of an error and throws it again with the same type.

namespace {

constexpr std::string_view side_prefix = "sampler ";  // no error of a sampler begins with it

class LabelledAdapter : public ForwardingAdapter {
public:
    LabelledAdapter(std::shared_ptr<const SamplerAdapter> sampler, const std::string& side)
        : ForwardingAdapter(std::move(sampler)),
          prefix_(fmt::format("{}{} ({}): ", side_prefix, side, printable(inner().name(), 40))) {}
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        forward([&] { inner().sample(t, wo, u, out); });
    }
    void pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        forward([&] { inner().pdf(t, pairs, out); });
    }
    void exact_pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        forward([&] { inner().exact_pdf(t, pairs, out); });
    }
    void mis_weight(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        forward([&] { inner().mis_weight(t, pairs, out); });
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const override {
        forward([&] { inner().f(pairs, out); });
    }
    void f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const override {
        forward([&] { inner().f_channels(pairs, out); });
    }
    void reference_f(std::span<const Pair> pairs, std::span<double> out) const override {
        forward([&] { inner().reference_f(pairs, out); });
    }

private:
    std::string prefix_;

    std::string message_of(const SamplerError& fault) const {
        const std::string_view what = fault.what();
        return what.starts_with(side_prefix) ? std::string(what) : prefix_ + std::string(what);
    }
    template <class Call> void forward(Call&& call) const {
        try {
            call();
        } catch (const SamplerTimeout& fault) {
            throw SamplerTimeout(message_of(fault));
        } catch (const SamplerExited& fault) {
            throw SamplerExited(message_of(fault));
        } catch (const SamplerError& fault) { throw SamplerError(message_of(fault)); }
    }
};

}  // namespace

std::shared_ptr<const SamplerAdapter> named_side(
    std::shared_ptr<const SamplerAdapter> sampler, const std::string& side) {
    if (!sampler->can_draw() || !sampler->limited()) return sampler;
    return std::make_shared<LabelledAdapter>(std::move(sampler), side);
}

}  // namespace crescent
