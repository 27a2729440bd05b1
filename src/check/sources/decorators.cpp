// Caches keep answers by the bits of (w_o, w_i), and draws by the bits of w_o and u. Only new pairs are evaluated, in
// their order. If a sampler throws, nothing of that call is cached.
#include "check/sources/decorators.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <fmt/format.h>
#include <unordered_map>
#include <vector>

#include "base/text.h"

namespace crescent {

namespace {

using Kind = SamplerQuery::Kind;

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

bool are_same(const PrimarySample& a, const PrimarySample& b) { return a.x == b.x && a.y == b.y && a.more == b.more; }

/// Counts the calls of one case, independent of other cases of the same sampler.
class Counted : public DecoratedSampler {
public:
    explicit Counted(std::shared_ptr<const SamplerAdapter> sampler) : DecoratedSampler(std::move(sampler), {}) {}
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override {
        if (query.is_counted()) answers_ += query.rows();
        inner().evaluate(query, out);
    }
    QueryUsage spending() const override {
        const QueryUsage total = inner().spending();
        return {answers_, total.seconds, total.allowed};
    }

private:
    mutable std::uint64_t answers_ = 0;
};

class CachedSampler : public DecoratedSampler {
public:
    CachedSampler(std::shared_ptr<const SamplerAdapter> sampler, bool draws)
        : DecoratedSampler(std::make_shared<Counted>(std::move(sampler)), {}),
          declaration_(inner().declaration()),
          caches_draws_(draws) {}
    SamplerDeclaration declaration() const override { return declaration_; }
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override {
        const std::size_t technique = static_cast<std::size_t>(query.technique);
        const bool has_cache = technique < pdf_.size();
        switch (query.kind) {
            case Kind::sample:
                if (caches_draws_) return sample(query, out.draws);
                break;
            case Kind::pdf:
                if (caches_draws_ && has_cache) return answer(query, plain_pdf_[technique], out.values);
                break;
            case Kind::exact_pdf:
                if (has_cache) return answer(query, pdf_[technique], out.values);
                break;
            case Kind::f: return f(query, out.values);
            case Kind::f_channels: return answer(query, channels_, out.channels);
            case Kind::reference_f:
                if (!declaration_.has_true_f) return f(query, out.values);
                break;
            default: break;
        }
        inner().evaluate(query, out);
    }
    const SamplerAdapter& uncached_sampler() const { return inner(); }

private:
    struct DrawSet {
        int technique;
        Vec3d wo;
        std::vector<PrimarySample> u;
        std::vector<Draw> draws;
    };
    SamplerDeclaration declaration_;
    bool caches_draws_;
    mutable std::vector<DrawSet> draw_sets_;
    mutable std::array<Cache<double>, 2> plain_pdf_;  // by technique
    mutable std::array<Cache<double>, 2> pdf_;        // by technique
    mutable Cache<double> f_;
    mutable Cache<Vec3d> channels_;

    void sample(const SamplerQuery& query, std::span<Draw> out) const {
        std::vector<PrimarySample> room;
        const std::span<const PrimarySample> u = query.u.samples(room);
        for (const DrawSet& d : draw_sets_)
            if (d.technique == query.technique && Key({query.wo, query.wo}) == Key({d.wo, d.wo}) &&
                std::ranges::equal(d.u, u, are_same)) {
                std::ranges::copy(d.draws, out.begin());
                return;
            }
        inner().evaluate(query, {.draws = out});
        draw_sets_.push_back({query.technique, query.wo, {u.begin(), u.end()}, {out.begin(), out.end()}});
    }
    void f(const SamplerQuery& query, std::span<double> out) const {
        SamplerQuery f_query = query;
        if (declaration_.traits.channels == 1) {
            f_query.kind = Kind::f;
            return answer(f_query, f_, out);
        }
        f_query.kind = Kind::f_channels;
        std::vector<Vec3d> by_channel(out.size());
        answer(f_query, channels_, std::span(by_channel));
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = luminance(by_channel[i]);
    }
    static SamplerAnswers answers_to(std::span<double> out) { return {.values = out}; }
    static SamplerAnswers answers_to(std::span<Vec3d> out) { return {.channels = out}; }

    /// Answers from the cache; the inner sampler is called once with the new pairs, in their order.
    template <class Value> void answer(const SamplerQuery& query, Cache<Value>& cache, std::span<Value> out) const {
        std::vector<Pair> new_pairs;
        for (const Pair& p : query.pairs)
            if (cache.try_emplace(Key(p)).second) new_pairs.push_back(p);
        std::vector<Value> values(new_pairs.size());
        SamplerQuery new_query = query;
        new_query.pairs = new_pairs;
        try {
            if (!new_pairs.empty()) inner().evaluate(new_query, answers_to(std::span(values)));
        } catch (...) {
            for (const Pair& p : new_pairs) cache.erase(Key(p));
            throw;
        }
        for (std::size_t i = 0; i < new_pairs.size(); ++i) cache[Key(new_pairs[i])] = values[i];
        for (std::size_t i = 0; i < query.pairs.size(); ++i) out[i] = cache[Key(query.pairs[i])];
    }
};

}  // namespace

std::shared_ptr<const SamplerAdapter> cached(std::shared_ptr<const SamplerAdapter> sampler, bool draws) {
    return std::make_shared<CachedSampler>(std::move(sampler), draws);
}

Side PerDirectionCache::of(const CheckCase& check_case, std::uint32_t stream) {
    Side out{check_case, stream};
    if (!check_case.adapter->limited()) return out;
    if (!check_case.adapter->serial())
        return out.check_case.adapter = cached(check_case.adapter), out;  // called by many threads
    const std::array<double, 3> wo = {check_case.wo.x, check_case.wo.y, check_case.wo.z};
    if (sampler_ != check_case.adapter || wo != wo_) {
        sampler_ = check_case.adapter;
        wo_ = wo;
        stream_ = stream;
        cache_ = cached(check_case.adapter, true);
    }
    out.stream = stream_;
    out.check_case.adapter = cache_;
    return out;
}

const SamplerAdapter& uncached(const SamplerAdapter& sampler) {
    const auto* cache = dynamic_cast<const CachedSampler*>(&sampler);
    return cache ? cache->uncached_sampler() : sampler;
}

std::shared_ptr<const SamplerAdapter> renamed(std::shared_ptr<const SamplerAdapter> sampler, const std::string& name) {
    return std::make_shared<DecoratedSampler>(
        std::move(sampler), DecoratedSampler::Evaluate{}, [name](SamplerDeclaration& d) { d.name = name; });
}

std::shared_ptr<const SamplerAdapter> limited_in_number(
    std::shared_ptr<const SamplerAdapter> sampler, std::uint64_t limit) {
    return std::make_shared<DecoratedSampler>(
        std::move(sampler), [limit](const SamplerAdapter& inner, const SamplerQuery& query, const SamplerAnswers& out) {
            if (query.is_counted() && inner.spending().answers + query.rows() > limit)
                throw SamplerTimeout("the limit of queries is reached");
            inner.evaluate(query, out);
        });
}

std::shared_ptr<const SamplerAdapter> limited_in_time(std::shared_ptr<const SamplerAdapter> sampler, double seconds) {
    using Clock = std::chrono::steady_clock;
    if (!(seconds > 0)) return sampler;
    return std::make_shared<DecoratedSampler>(std::move(sampler),
        [seconds, start = Clock::now()](
            const SamplerAdapter& inner, const SamplerQuery& query, const SamplerAnswers& out) {
            if (query.is_counted() && std::chrono::duration<double>(Clock::now() - start).count() > seconds)
                throw SamplerTimeout("the limit of time is reached");
            inner.evaluate(query, out);
        });
}

std::shared_ptr<const SamplerAdapter> named_side(
    std::shared_ptr<const SamplerAdapter> sampler, const std::string& side) {
    static constexpr std::string_view side_prefix = "sampler ";  // no error of a sampler begins with it
    if (!sampler->can_draw() || !sampler->limited()) return sampler;
    const std::string prefix = fmt::format("{}{} ({}): ", side_prefix, side, printable(sampler->name(), 40));
    return std::make_shared<DecoratedSampler>(std::move(sampler),
        [prefix](const SamplerAdapter& inner, const SamplerQuery& query, const SamplerAnswers& out) {
            const auto message_of = [&](const SamplerError& fault) {
                const std::string_view what = fault.what();
                return what.starts_with(side_prefix) ? std::string(what) : prefix + std::string(what);
            };
            try {
                inner.evaluate(query, out);
            } catch (const SamplerTimeout& fault) {
                throw SamplerTimeout(message_of(fault));
            } catch (const SamplerExited& fault) {
                throw SamplerExited(message_of(fault));
            } catch (const SamplerError& fault) { throw SamplerError(message_of(fault)); }
        });
}

}  // namespace crescent
