// The engine of crescent 0.1: judge() over trials, as `crescent check` calls it.
#include <set>

#include "tests/calibration/engine.h"
#include "verdicts/judge.h"

namespace crescent::calibration {

namespace {

void add_once(std::vector<std::string>& to, const std::string& word) {
    if (std::ranges::find(to, word) == to.end()) to.push_back(word);
}

/// Evidence "p" and "p_...": the least of each over the w_o.
void collect_p(const Verdict& v, std::map<std::string, double>& out) {
    for (const auto& [key, value] : v.evidence.items()) {
        if (!value.is_number() || (key != "p" && !key.starts_with("p_")) || key == "p_unconfirmed") continue;
        const auto [at, fresh] = out.emplace(v.name + "." + key, value.get<double>());
        if (!fresh) at->second = std::min(at->second, value.get<double>());
    }
}

class Engine01 : public Engine {
public:
    std::string_view name() const override { return "0.1"; }
    Result run(std::span<const Trial> trials, const Request& request) const override {
        TestSettings settings = request.full ? TestSettings::thorough() : TestSettings::quick();
        settings.seed = request.seed;
        if (request.draws) settings.draws = request.draws;
        if (request.evaluations) settings.questions = request.evaluations;
        ProgressMonitor monitor;
        const Judgement j = judge(trials, settings, monitor);
        Result out;
        out.state = j.state;
        for (const Verdict& v : j.verdicts) {
            collect_p(v, out.p);
            if (v.state == State::right) state_sizes(v, out.stated);
            if (v.expected || v.state == State::right || v.state == State::skipped) continue;
            add_once(v.state == State::inconclusive ? out.open : out.wrong, v.name);
            if (out.say.empty() && v.state != State::inconclusive) out.say = v.say;
            if (v.evidence.contains("diagnosis") && v.evidence["diagnosis"] != "none")
                add_once(out.causes, v.evidence["diagnosis"].get<std::string>());
        }
        return out;
    }

private:
    /// "What is right could hide p that integrates to one but for ..., and ... of the draws in one bin."
    static void state_sizes(const Verdict& v, std::map<std::string, double>& out) {
        const auto most = [&](const char* key, const char* as) {
            if (!v.evidence.contains(key)) return;
            double& size = out[as];
            size = std::max(size, v.evidence[key].get<double>());
        };
        most("unseen", "constant");
        most("unseen_in_one_bin", "hole");
    }
};

}  // namespace

std::unique_ptr<Engine> engine_0_1() { return std::make_unique<Engine01>(); }

}  // namespace crescent::calibration
