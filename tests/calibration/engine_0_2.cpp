// The engine of src/check.
#include <fmt/format.h>

#include "check/check.h"
#include "check/explain/causes.h"
#include "tests/calibration/engine.h"

namespace crescent::calibration {

namespace {

void add_once(std::vector<std::string>& to, std::string_view word) {
    if (std::ranges::find(to, word) == to.end()) to.emplace_back(word);
}

void take_most(std::map<std::string, double>& to, const char* name, const std::optional<double>& size) {
    if (size) to[name] = std::max(to[name], *size);
}

class Engine02 : public Engine {
public:
    std::string_view name() const override { return "0.2"; }
    Result run(std::span<const CheckCase> check_cases, const Request& request) const override {
        check::CheckSettings settings;
        if (request.full) settings.budget = check::CheckBudget::thorough();
        if (std::ranges::any_of(check_cases, [](const CheckCase& t) { return t.adapter->serial(); }))
            settings.budget = check::CheckBudget::limited();
        if (request.evaluations > 0)
            settings.budget = check::CheckBudget::limited(static_cast<double>(request.evaluations));
        if (!request.full) settings.further_in_all = static_cast<double>(TestSettings::quick().further_in_all);
        settings.seed = request.seed;
        ProgressMonitor monitor;
        Result out;
        for (const check::CheckOutcome& o : check::check_samplers(check_cases, settings, monitor)) {
            for (const check::SmallFault& f : o.small) take(f, out);
            for (const auto& techniques : o.checks)
                for (const check::CheckAt& c : techniques) collect(c, out);
            if (!o.wrong()) continue;
            if (const auto cause = check::cause_of(check_cases, o)) out.causes.push_back(cause->text);
        }
        out.state = !out.wrong.empty() ? State::wrong : !out.open.empty() ? State::inconclusive : State::right;
        return out;
    }

private:
    static void take(const check::SmallFault& f, Result& out) {
        add_once(out.wrong, check::info(f.family).verdict);
        out.message +=
            fmt::format("[{} {} of {} {:.3g}: {}]", check::info(f.family).name, f.times, f.trials, f.size, f.what);
    }
    static void collect(const check::CheckAt& c, Result& out) {
        for (const check::SmallFault& f : c.small) take(f, out);
        for (const check::Finding& f : c.findings) {
            add_once(out.wrong, check::info(f.first.family).verdict);
            out.message += fmt::format("[{} {:.3g} of {:.4g} p {:.2g} {:.2g}]", check::info(f.first.family).name,
                f.first.difference, f.first.expected, f.first.p, f.second.p);
        }
        if (c.inconclusive) {
            add_once(out.open, "density");
            const auto size = [](const std::optional<double>& v) { return v.value_or(-1); };
            out.message += fmt::format("[constant {:.2g} leak {:.2g} cap {:.2g} rotation {:.2g} parameter {:.2g}]",
                size(c.sizes.of("constant")), size(c.sizes.of("leak")), size(c.sizes.of("cap")),
                size(c.sizes.of("rotation")), size(c.sizes.of("parameter")));
        }
        for (const check::Answer& a : c.answers) {
            const auto [at, fresh] = out.p.emplace(check::info(a.family).name, a.p);
            if (!fresh) at->second = std::min(at->second, a.p);
        }
        take_most(out.stated, "constant", c.sizes.of("constant"));
        take_most(out.stated, "leak", c.sizes.of("leak"));
        take_most(out.stated, "hole", c.sizes.of("cap"));
        take_most(out.stated, "rotation", c.sizes.of("rotation"));
        take_most(out.stated, "exponent", c.sizes.of("parameter"));
    }
};

}  // namespace

std::unique_ptr<Engine> engine_0_2() { return std::make_unique<Engine02>(); }

}  // namespace crescent::calibration
