// Cases of the calibration: a sampler, its w_o, and what an engine should find. Case INDEX of SET at SEED is the same
// on every machine; its numbers come from streams of its own.
#pragma once

#include "check/sources/cases.h"
#include "check/verdict.h"
#include "tests/calibration/faults.h"

namespace crescent::calibration {

struct CaseKey {
    std::string set;
    std::uint64_t seed = 1, index = 0;
    int wo = 0;         // so many w_o at random; 0: those of the quick mode
    bool full = false;  // the w_o of the full mode
};

struct Case {
    std::string family, parameters;
    std::string kind;   // "right", or the word of the fault
    std::string cause;  // a key of names_cause(), or a part of the text that names it; "" where none is known
    double size = 0;
    State expected = State::right;
    bool held_out = false;
    Real real = Real::f64;
    std::vector<CheckCase> check_cases;  // of the engine: one a w_o, with other samplers beside it where f is known
    /// Where all cases are of one sampler that can be served over a pipe.
    std::optional<Sampler> sampler{};
    std::vector<std::pair<double, double>> grid{};  // theta and azimuth of the w_o in degrees; empty: those of the mode
};

/// One set: how many cases it has (0: as many as are asked for), and how one is made.
struct CaseSet {
    std::string name, what;
    std::uint64_t count = 0;
    int wo = 0;  // w_o a case where none is given
    Case (*make)(const CaseKey&) = nullptr;
};
const std::vector<CaseSet>& case_sets();
/// Throws InputError for an unknown name.
const CaseSet& case_set(std::string_view name);

/// w_o at random: n in one of eight, 0.5 to 80 degrees in three of four of the others, 80 to 89 in the rest; under the
/// surface at times where the sampler answers there.
std::vector<std::pair<double, double>> random_grid(Rng& dice, Traits::WoDomain asked, int count);
/// The case of a sampler: its cases are made. `wrong`: what an engine should say.
Case case_of(const Sampler& sampler, const CaseKey& key, State expected, std::string kind);

/// For set `stated`: the right sampler's member with a fault of a size that is known later.
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
Case make_known(const CaseKey& key);  // known.cpp
std::uint64_t count_known();

}  // namespace crescent::calibration
