// `check` in the page: a built-in sampler at one w_o, or a planted fault at the nearest of its own, checked by the same
// calls as the program's. `crescent check ARM --wo THETA` gives the same verdicts and the same evidence, for the same
// number of evaluations.
#include <algorithm>
#include <cmath>

#include "disk.h"
#include "tests/known_samplers/faulty/planted.h"

namespace crescent::web {

namespace {

/// Returns those of a fault at the w_o nearest to theta, in degrees.
std::vector<CheckCase> nearest_of(const std::vector<CheckCase>& check_cases, double theta) {
    const auto distance_of = [&](const CheckCase& t) { return std::fabs(t.theta_deg - theta); };
    const double least_distance = distance_of(*std::ranges::min_element(check_cases, {}, distance_of));
    std::vector<CheckCase> out;
    std::ranges::copy_if(
        check_cases, std::back_inserter(out), [&](const CheckCase& t) { return distance_of(t) == least_distance; });
    return out;
}

std::vector<CheckCase> cases_named(const std::string& name, double theta) {
    if (find_arm_info(name)) return make_cases(name, {}, false, {{theta, 0}});
    for (const PlantedFault& fault : arm_faults(false))
        if (fault.name == name) return nearest_of(fault.check_cases, theta);
    throw InputError({"check", 0, 0}, "no sampler '" + name + "'");
}

ordered_json verdict_fields(const Verdict& v) {
    ordered_json out = {{"name", v.name}, {"state", word(v.state)}, {"message", v.message()}, {"evidence", v.evidence}};
    if (v.state == State::wrong && v.expected) out["why"] = v.why_expected;
    return out;
}

}  // namespace

/// {sampler, theta, evaluations} -> {name, state, cases: [{surface, case, verdicts: [{name, state, message,
/// evidence}]}]}; `evaluations` at each w_o, by default those of the program; efficiency, which depends on a clock, is
/// omitted.
CRESCENT_EXPORT(checked)()->void {
    const ordered_json query = request();
    const std::string name = query.at("sampler").get<std::string>();
    const std::vector<CheckCase> check_cases = cases_named(name, query.at("theta").get<double>());
    ProgressMonitor monitor;
    TestSettings settings = TestSettings::quick();
    if (query.contains("evaluations"))
        settings.budget = check::CheckBudget::limited(query.at("evaluations").get<double>());
    const CheckResult result = run_checks(check_cases, settings, monitor);
    ordered_json out = {{"name", name}, {"state", word(State::right)}, {"cases", ordered_json::array()}};
    bool is_wrong = false, is_doubtful = false;
    for (const CheckCase& t : check_cases) {
        ordered_json entry = {{"surface", t.brdf}, {"case", t.text()}, {"verdicts", ordered_json::array()}};
        for (const Verdict& v : result.verdicts) {
            if (t.baseline || v.check_case != t.text() || v.name == "efficiency") continue;
            entry["verdicts"].push_back(verdict_fields(v));
            is_wrong = is_wrong || v.state == State::wrong;
            is_doubtful = is_doubtful || v.state == State::inconclusive;
        }
        if (!entry["verdicts"].empty()) out["cases"].push_back(std::move(entry));
    }
    out["state"] = word(is_wrong ? State::wrong : is_doubtful ? State::inconclusive : State::right);
    respond(out);
}

/// {sampler, theta, n} -> {case, draws: [[x, y]]}: its first n draws on the disk; density_disk() paints its stated
/// density.
CRESCENT_EXPORT(drawn)()->void {
    const ordered_json query = request();
    const CheckCase check_case =
        cases_named(query.at("sampler").get<std::string>(), query.at("theta").get<double>()).front();
    const std::uint32_t seed = seed_of(TestSettings::quick().seed, 0);
    std::vector<PrimarySample> u(query.at("n").get<std::size_t>());
    for (std::size_t k = 0; k < u.size(); ++k) u[k] = drawn_numbers(seed, 0, k, 0, PrimarySample::most_numbers);
    std::vector<Draw> draws(u.size());
    check_case.adapter->sample(0, check_case.wo, u, draws);
    const Disk disk({-check_case.wo.x, -check_case.wo.y, check_case.wo.z});
    ordered_json out = {{"case", check_case.text()}, {"draws", ordered_json::array()}};
    for (const Draw& d : draws)
        if (d.pdf > 0 && d.wi.z > 0) out["draws"].push_back(disk.place(d.wi));
    respond(out);
}

/// {sampler, theta, size} -> the density that it states there, as a picture for disk(), `size` pixels across.
CRESCENT_EXPORT(density_disk)()->void {
    const ordered_json query = request();
    const CheckCase check_case =
        cases_named(query.at("sampler").get<std::string>(), query.at("theta").get<double>()).front();
    paint_disk(Disk({-check_case.wo.x, -check_case.wo.y, check_case.wo.z}), query.at("size").get<int>(), [&](Vec3d wi) {
        const Pair pair{check_case.wo, wi};
        double p = 0;
        check_case.adapter->exact_pdf(0, {&pair, 1}, {&p, 1});
        return p;
    });
}

}  // namespace crescent::web
