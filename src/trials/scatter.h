// Answers that are themselves random estimates: a layered surface may walk at random inside itself to tell f and pdf,
// and its f and pdf are right in the mean alone. Two answers for one direction then differ; or, where the walk takes
// its random numbers from a hash of the directions, the answers for two directions beside one another do.
#pragma once

#include <array>
#include <string>

#include "base/vec.h"

namespace crescent::inline trials {

class Draws;

struct Scatter {
    double of_pdf = 0, of_f = 0;  // median relative difference of two answers; 0: no estimate
    bool hashed = false;          // told apart by neighbours, not by asking again
    bool pdf() const { return of_pdf > 0; }
    bool f() const { return of_f > 0; }
    bool any() const { return pdf() || f(); }
};

/// Asks for f and pdf twice where the sampler draws and all over the upper half, and beside these directions.
Scatter look_for_scatter(const Draws& work);

/// "pdf(w) and f(w) are random estimates (...)"; "" where they are none.
std::string told(const Scatter& scatter);

}  // namespace crescent::inline trials
