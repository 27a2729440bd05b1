// The list of engines, and the measurement of a run: CPU time of this process and of its children, and the number of
// calls of the sampler.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/time.h>

#include "base/errors.h"
#include "base/text.h"
#include "check/sources/check_case.h"
#include "tests/calibration/engine.h"

#define CRESCENT_ENGINES(engine) engine(engine_0_2)

namespace crescent::calibration {

#define CRESCENT_DECLARED(engine) std::unique_ptr<Engine> engine();
CRESCENT_ENGINES(CRESCENT_DECLARED)
#undef CRESCENT_DECLARED

namespace {

using Count = std::shared_ptr<std::atomic<std::uint64_t>>;

/// The sampler, whose answers are counted.
std::shared_ptr<const SamplerAdapter> with_count(std::shared_ptr<const SamplerAdapter> sampler, const Count& count) {
    return std::make_shared<DecoratedSampler>(
        std::move(sampler), [count](const SamplerAdapter& inner, const SamplerQuery& query, const SamplerAnswers& out) {
            if (query.is_counted()) *count += query.rows();
            inner.evaluate(query, out);
        });
}

double cpu_seconds() {
    double out = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used{};
        getrusage(who, &used);
        for (const timeval& t : {used.ru_utime, used.ru_stime})
            out += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    }
    return out;
}

}  // namespace

const std::vector<std::unique_ptr<Engine>>& engines() {
    static const std::vector<std::unique_ptr<Engine>> all = [] {
        std::vector<std::unique_ptr<Engine>> out;
#define CRESCENT_ADDED(engine) out.push_back(engine());
        CRESCENT_ENGINES(CRESCENT_ADDED)
#undef CRESCENT_ADDED
        return out;
    }();
    return all;
}

const Engine& engine_named(std::string_view name) {
    std::vector<std::string> names;
    for (const auto& e : engines()) {
        if (e->name() == name) return *e;
        names.emplace_back(e->name());
    }
    throw InputError({"--engine", 0, 0}, fmt::format("no engine '{}'{}", name, did_you_mean(name, names)));
}

Result measured(
    const Engine& engine, const std::function<std::vector<CheckCase>()>& check_cases, const Request& request) {
    const auto count = std::make_shared<std::atomic<std::uint64_t>>(0);
    const double start = cpu_seconds();
    Result out;
    int wo = 0;
    {
        std::vector<CheckCase> all = check_cases();
        std::map<const SamplerAdapter*, std::shared_ptr<const SamplerAdapter>> counted;
        for (CheckCase& t : all) {
            if (t.baseline) continue;  // it evaluates only f of a sampler whose calls are counted already
            ++wo;
            auto& one = counted[t.adapter.get()];
            if (!one) one = with_count(t.adapter, count);
            t.adapter = one;
        }
        out = engine.run(all, request);
    }
    out.cpu_seconds = cpu_seconds() - start;
    out.evaluations = *count;
    out.wo = wo;
    return out;
}

}  // namespace crescent::calibration
