// All w_o of the lists have the azimuth 130 degrees.
#include "tests/known_samplers/reported/known.h"

#include "check/sources/cases.h"

namespace crescent {

namespace {

std::vector<CheckCase> trials_at(SyntheticSampler r, std::initializer_list<double> theta) {
    const auto subject = subject_of(std::move(r));
    std::vector<CheckCase> out;
    for (double t : theta) out.push_back(make_user_case(subject, t, 130));
    return out;
}

}  // namespace

void KnownList::add(std::string name, Known known, std::string verdict, std::vector<CheckCase> trials) {
    list_.push_back({std::move(name), known, std::move(verdict), std::move(trials)});
}
void KnownList::right(std::string name, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::right, "", trials_at(std::move(r), theta));
}
void KnownList::not_wrong(std::string name, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::not_wrong, "", trials_at(std::move(r), theta));
}
void KnownList::wrong(std::string name, std::string verdict, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::wrong, std::move(verdict), trials_at(std::move(r), theta));
}

void KnownList::missed(std::string name, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::missed, "", trials_at(std::move(r), theta));
}
void KnownList::called_wrong(
    std::string name, std::string verdict, SyntheticSampler r, std::initializer_list<double> theta) {
    add(std::move(name), Known::called_wrong, std::move(verdict), trials_at(std::move(r), theta));
}

std::vector<KnownSampler> known_samplers() {
    std::vector<KnownSampler> out;
    for (const auto& list : {delta_samplers(), phase_functions(), single_precision_samplers(), lobe_samplers(),
             small_fault_samplers(), numbers_samplers()})
        out.insert(out.end(), list.begin(), list.end());
    return out;
}

}  // namespace crescent
