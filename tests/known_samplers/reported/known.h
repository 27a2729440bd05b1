// Samplers with a known verdict, other than the planted faults and the correct samplers at random parameters: one list
// per theme. known_samplers_test.cpp checks them all.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "tests/known_samplers/correct/right.h"

namespace crescent {

/// The last two are errors of quick mode: faults that it misses, correct samplers that it reports as wrong. The test
/// expects these results too, so that a change moves the sampler to another list.
enum class Known { right, not_wrong, wrong, missed, called_wrong };

struct KnownSampler {
    std::string name;
    Known known = Known::right;
    std::string verdict{};  // the verdict that fails, for a wrong one; "" if any may
    std::vector<CheckCase> check_cases{};
};

/// A list of known samplers, each at one azimuth and at the given angles of w_o
/// from n, in degrees.
class KnownList {
public:
    void right(std::string name, SyntheticSampler r, std::initializer_list<double> theta = {45});
    /// One whose verdict may be inconclusive.
    void not_wrong(std::string name, SyntheticSampler r, std::initializer_list<double> theta = {45});
    /// Wrong at each of the angles.
    void wrong(std::string name, std::string verdict, SyntheticSampler r, std::initializer_list<double> theta = {45});
    /// A fault that quick mode does not find.
    void missed(std::string name, SyntheticSampler r, std::initializer_list<double> theta = {45});
    /// A correct one that quick mode reports as wrong.
    void called_wrong(
        std::string name, std::string verdict, SyntheticSampler r, std::initializer_list<double> theta = {45});
    void add(std::string name, Known known, std::string verdict, std::vector<CheckCase> check_cases);
    std::vector<KnownSampler> take() { return std::move(list_); }

private:
    std::vector<KnownSampler> list_;
};

std::vector<KnownSampler> delta_samplers();             // smooth boundaries, thin walls, masks, coats
std::vector<KnownSampler> phase_functions();            // and samplers of both sides
std::vector<KnownSampler> single_precision_samplers();  // where rounding matters
std::vector<KnownSampler> lobe_samplers();              // mixtures, rarely drawn lobes, cones, tables
std::vector<KnownSampler> small_fault_samplers();       // faults in a small part of the draws
std::vector<KnownSampler> numbers_samplers();           // unusable values, states, random numbers of their own
/// Returns all of them.
std::vector<KnownSampler> known_samplers();

}  // namespace crescent
