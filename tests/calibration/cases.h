// Cases of the calibration: a sampler, its w_o, and the expected result of an engine. Case INDEX of SET at SEED is the
// same on every machine; its numbers come from its own streams.
#pragma once

#include "check/sources/cases.h"
#include "check/verdict.h"
#include "tests/calibration/faults.h"

namespace crescent::calibration {

struct CaseKey {
    std::string set;
    std::uint64_t seed = 1, index = 0;
    int wo = 0;         // number of random w_o; 0: those of the quick mode
    bool full = false;  // use the w_o of the full mode
};

struct Case {
    std::string family, parameters;
    std::string kind;   // "right", or the name of the fault
    std::string cause;  // a key of names_cause(), or a part of the text that names it; "" if unknown
    double size = 0;
    State expected = State::right;
    bool held_out = false;
    Real real = Real::f64;
    std::vector<CheckCase> check_cases;  // of the engine: one for each w_o, with baselines if f is known
    /// If all cases belong to one sampler that can be served over a pipe.
    std::optional<Sampler> sampler{};
    std::vector<std::pair<double, double>> grid{};  // theta and azimuth of the w_o in degrees; empty: those of the mode
};

/// One set: its number of cases (0: unlimited), and the function that makes a case.
struct CaseSet {
    std::string name, what;
    std::uint64_t count = 0;
    int wo = 0;  // default number of w_o of a case
    Case (*make)(const CaseKey&) = nullptr;
};
const std::vector<CaseSet>& case_sets();
/// Throws InputError for an unknown name.
const CaseSet& case_set(std::string_view name);

/// Random w_o: n in one of eight, 0.5 to 80 degrees in three of four of the others, 80 to 89 in the rest; below the
/// surface in half of them if the sampler accepts these.
std::vector<std::pair<double, double>> random_grid(Rng& rng, Traits::WoDomain asked, int count);
/// Makes the cases of a sampler. `expected`: the state that an engine should return.
Case case_of(const Sampler& sampler, const CaseKey& key, State expected, std::string kind);

/// For set `stated`: the member of the right sampler, and a fault whose size is determined later.
struct StatedCase {
    const Family* family;
    Member member;
    Real real;
    FaultKind kind;
};
StatedCase stated_case(const CaseKey& key);
/// The right case, and the case with a fault of that size.
Case stated_right(const StatedCase& of, const CaseKey& key);
Case stated_faulty(const StatedCase& of, const CaseKey& key, double size);

Case make_hard(const CaseKey& key);  // hard.cpp
std::uint64_t count_hard();
Case make_reported(const CaseKey& key);  // reported.cpp
std::uint64_t count_reported();
Case make_fresh(const CaseKey& key);  // fresh.cpp
std::vector<std::string> fresh_names();
Sampler fresh_sampler(std::size_t family, Real real, Rng& rng);
Case make_known(const CaseKey& key);  // known.cpp
std::uint64_t count_known();

}  // namespace crescent::calibration
