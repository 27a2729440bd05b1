// Samplers whose verdict is known, beside the planted faults and the right
// samplers at random parameters: a list a theme. known_samplers_test.cpp checks
// them all.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "tests/known_samplers/correct/right.h"

namespace crescent {

/// The last two are what quick mode does not meet: faults that it misses, right samplers that it calls wrong. The test
/// expects that too, so that whoever changes it gives the sampler its place.
enum class Known { right, not_wrong, wrong, missed, called_wrong };

struct KnownSampler {
    std::string name;
    Known known = Known::right;
    std::string verdict{};  // of a wrong one the verdict that is wrong; "" if any may be
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
    /// A right one that it calls wrong.
    void called_wrong(
        std::string name, std::string verdict, SyntheticSampler r, std::initializer_list<double> theta = {45});
    void add(std::string name, Known known, std::string verdict, std::vector<CheckCase> check_cases);
    std::vector<KnownSampler> take() { return std::move(list_); }

private:
    std::vector<KnownSampler> list_;
};

std::vector<KnownSampler> delta_samplers();             // smooth boundaries, thin walls, masks, coats
std::vector<KnownSampler> phase_functions();            // and samplers of both sides
std::vector<KnownSampler> single_precision_samplers();  // where rounding shows
std::vector<KnownSampler> lobe_samplers();              // mixtures, seldom drawn lobes, cones, tables
std::vector<KnownSampler> small_fault_samplers();       // faults in a small part of what is drawn
std::vector<KnownSampler> numbers_samplers();           // values that cannot be used, states, numbers of their own
/// All of them.
std::vector<KnownSampler> known_samplers();

}  // namespace crescent
