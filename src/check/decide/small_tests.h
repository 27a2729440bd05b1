// Tests at one w_o other than the identity E[h(w)] = integral of h p: numbers at the corners of u, repeated u,
// few bits, numbers without effect. Only the test points are random.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/verdicts/questions.h"

namespace crescent::check {

/// A description of the fault of a draw; none if it is usable.
std::optional<const char*> fault_of(const Draw& d, const Traits& traits);

/// A small test that failed.
struct SmallFault {
    Family family = Family::corners;
    double times = 0, trials = 0;  // number of failures, number of tests
    double size = 0;               // relative, if it has one
    Example first{};
    const char* what = "";      // begins a sentence
    std::optional<Vec3d> wo{};  // of the first, if it is not a w_o of the call
    std::string place{};        // of the first in a file
};

/// All rows of a file of draws, independent of the test that uses them.
std::optional<SmallFault> rows_of_file(const Source& source);
/// u at 0, next to 0, at quarters and next to 1, in every two numbers and in every corner: samplers divide by 0 there.
std::optional<SmallFault> corners_of_u(Source& source);
/// The same u in another order, in other batches and alone.
std::optional<SmallFault> same_u_again(Source& source, const StreamKey& key);
/// pdf(w) and f(w) of the same directions in blocks of other sizes: a program may mix up the rows of a block.
std::optional<SmallFault> same_answers_again(Source& source, const StreamKey& key);
/// Random numbers of which few bits are used: a draw moves with large changes of u, and does not move with its last
/// bits.
std::optional<SmallFault> few_bits(Source& source, const StreamKey& key);
/// Random numbers that change no draw.
std::vector<int> numbers_without_effect(Source& source, const StreamKey& key);

/// All of them.
std::vector<SmallFault> small_tests(Source& source, const StreamKey& key);

}  // namespace crescent::check
