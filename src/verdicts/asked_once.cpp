#include "verdicts/asked_once.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace crescent::inline verdicts {

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

template <class Value> using Kept = std::unordered_map<Key, Value, KeyHash>;

/// Answers from what is kept; `ask` is called once, with the pairs that are new, in their order.
template <class Value, class Ask>
void answer(Kept<Value>& kept, std::span<const Pair> at, std::span<Value> out, const Ask& ask) {
    std::vector<Pair> fresh;
    for (const Pair& p : at)
        if (kept.try_emplace(Key(p)).second) fresh.push_back(p);
    std::vector<Value> values(fresh.size());
    try {
        if (!fresh.empty()) ask(std::span<const Pair>(fresh), std::span<Value>(values));
    } catch (...) {
        for (const Pair& p : fresh) kept.erase(Key(p));
        throw;
    }
    for (std::size_t i = 0; i < fresh.size(); ++i) kept[Key(fresh[i])] = values[i];
    for (std::size_t i = 0; i < at.size(); ++i) out[i] = kept[Key(at[i])];
}

bool same(const Numbers& a, const Numbers& b) { return a.x == b.x && a.y == b.y && a.more == b.more; }

class AskedOnce : public JudgedSampler {
public:
    AskedOnce(std::shared_ptr<const JudgedSampler> inner, bool draws) : inner_(std::move(inner)), keeps_draws_(draws) {}
    std::string name() const override { return inner_->name(); }
    Traits traits() const override { return inner_->traits(); }
    int techniques() const override { return inner_->techniques(); }
    void sample(int t, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        if (!keeps_draws_) return inner_->sample(t, wo, u, out);
        for (const Drawn& d : drawn_)
            if (d.technique == t && Key({wo, wo}) == Key({d.wo, d.wo}) && std::ranges::equal(d.u, u, same)) {
                std::ranges::copy(d.draws, out.begin());
                return;
            }
        inner_->sample(t, wo, u, out);
        drawn_.push_back({t, wo, {u.begin(), u.end()}, {out.begin(), out.end()}});
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        if (!keeps_draws_ || t > 1) return inner_->pdf(t, at, out);
        answer<double>(plain_pdf_[static_cast<std::size_t>(t)], at, out,
            [&](std::span<const Pair> a, std::span<double> o) { inner_->pdf(t, a, o); });
    }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        if (t > 1) return inner_->exact_pdf(t, at, out);
        answer<double>(pdf_[static_cast<std::size_t>(t)], at, out,
            [&](std::span<const Pair> a, std::span<double> o) { inner_->exact_pdf(t, a, o); });
    }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        inner_->mis_weight(t, at, out);
    }
    bool has_f() const override { return inner_->has_f(); }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        if (inner_->traits().channels == 1)
            return answer<double>(f_, at, out, [&](auto a, auto o) { inner_->f(a, o); });
        std::vector<Vec3d> by_channel(at.size());
        f_channels(at, by_channel);
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = luminance(by_channel[i]);
    }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
        answer<Vec3d>(channels_, at, out, [&](auto a, auto o) { inner_->f_channels(a, o); });
    }
    bool has_true_f() const override { return inner_->has_true_f(); }
    void true_f(std::span<const Pair> at, std::span<double> out) const override {
        if (has_true_f()) inner_->true_f(at, out);
        else f(at, out);
    }
    bool has_drawn_f() const override { return inner_->has_drawn_f(); }
    std::vector<TabulationError> tabulation_errors() const override { return inner_->tabulation_errors(); }
    double tabulation_error(Vec3d w) const override { return inner_->tabulation_error(w); }
    std::string place(int round, std::size_t draw) const override { return inner_->place(round, draw); }
    bool draws_at_will() const override { return inner_->draws_at_will(); }
    Spending spending() const override { return inner_->spending(); }
    bool serial() const override { return inner_->serial(); }
    const JudgedSampler& inner() const { return *inner_; }

private:
    struct Drawn {
        int technique;
        Vec3d wo;
        std::vector<Numbers> u;
        std::vector<Draw> draws;
    };
    std::shared_ptr<const JudgedSampler> inner_;
    bool keeps_draws_;
    mutable std::vector<Drawn> drawn_;
    mutable std::array<Kept<double>, 2> plain_pdf_;  // by technique
    mutable std::array<Kept<double>, 2> pdf_;        // by technique
    mutable Kept<double> f_;
    mutable Kept<Vec3d> channels_;
};

}  // namespace

std::shared_ptr<const JudgedSampler> asked_once(std::shared_ptr<const JudgedSampler> sampler, bool draws) {
    return std::make_shared<AskedOnce>(std::move(sampler), draws);
}

Side AskedByDirection::of(const Trial& trial, std::uint32_t stream) {
    if (!trial.subject->serial()) return {trial, stream};
    const std::array<double, 3> wo = {trial.wo.x, trial.wo.y, trial.wo.z};
    if (asked_ != trial.subject || wo != wo_)
        asked_ = trial.subject, wo_ = wo, stream_ = stream, kept_ = asked_once(trial.subject, true);
    Side out{trial, stream_};
    out.trial.subject = kept_;
    return out;
}

const JudgedSampler& afresh(const JudgedSampler& sampler) {
    const auto* kept = dynamic_cast<const AskedOnce*>(&sampler);
    return kept ? kept->inner() : sampler;
}

}  // namespace crescent::inline verdicts
