// timing.json: what varies between equal runs (seconds, threads, instruction set, date), apart from the numbers.
#include "report/provenance_json.h"
#include "report/report.h"

namespace crescent::inline report {
namespace {

Json arm_json(const ArmTiming& a) {
    const double rate = a.seconds > 0 ? static_cast<double>(a.samples) / a.seconds * 1e-6 : 0;
    return {{"arm", a.arm}, {"n", a.n}, {"s", number(a.s)}, {"samples", a.samples}, {"seconds", number(a.seconds)},
        {"msamples_per_s", number(rate)}};
}

}  // namespace

std::string timing_json(const Timing& timing, const Provenance& provenance) {
    Json arms = Json::array(), stages = Json::array();
    for (const ArmTiming& a : timing.arms) arms.push_back(arm_json(a));
    for (const auto& [name, seconds] : timing.stages) stages.push_back({{"name", name}, {"seconds", number(seconds)}});
    const Json out = {{"format", "crescent timing 1"}, {"estimating_s", number(timing.estimating_s)},
        {"total_s", number(timing.total_s)}, {"threads", timing.threads}, {"isa", timing.isa}, {"date", timing.date},
        {"host_cpu", timing.host_cpu}, {"arms", std::move(arms)}, {"stages", std::move(stages)},
        {"provenance", provenance_json(provenance)}};
    return text(out);
}

}  // namespace crescent::inline report
