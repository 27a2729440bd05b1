// All w_o of the lists have the azimuth 130 degrees.
#include "tests/known_samplers/reported/known.h"

#include "check/sources/cases.h"

namespace crescent {

namespace {

std::vector<CheckCase> cases_at(SyntheticSampler r, std::initializer_list<double> theta) {
    const auto adapter = make_adapter(std::move(r));
    std::vector<CheckCase> out;
    for (double t : theta) out.push_back(make_user_case(adapter, t, 130));
    return out;
}

}  // namespace

void KnownList::add(std::string name, Known known, std::string verdict, std::vector<CheckCase> check_cases) {
    list_.push_back({std::move(name), known, std::move(verdict), std::move(check_cases)});
}
void KnownList::right(std::string name, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::right, "", cases_at(std::move(r), theta));
}
void KnownList::not_wrong(std::string name, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::not_wrong, "", cases_at(std::move(r), theta));
}
void KnownList::wrong(std::string name, std::string verdict, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::wrong, std::move(verdict), cases_at(std::move(r), theta));
}

void KnownList::missed(std::string name, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::missed, "", cases_at(std::move(r), theta));
}
void KnownList::called_wrong(
    std::string name, std::string verdict, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::called_wrong, std::move(verdict), cases_at(std::move(r), theta));
}

std::vector<KnownSampler> known_samplers() {
    std::vector<KnownSampler> out;
    for (const auto& list : {delta_samplers(), phase_functions(), single_precision_samplers(), lobe_samplers(),
             small_fault_samplers(), numbers_samplers()})
        out.insert(out.end(), list.begin(), list.end());
    return out;
}

}  // namespace crescent
