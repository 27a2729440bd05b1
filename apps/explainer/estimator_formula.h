// The estimator as a formula whose terms appear and light up one by one: (1/N) sum of f L cos / p.
#pragma once

#include "frame.h"

namespace crescent::explainer {

/// alpha: how far a term has appeared; lit: how much it is meant just now.
struct Term {
    double alpha = 0, lit = 0;
};
struct EstimatorTerms {
    Term average, f, light, cosine, density;
};

/// Sets it with its left end at `at`, the fraction's bar at at.y.
void draw_estimator(Frame& frame, Point at, double px, const EstimatorTerms& terms);

/// Between two inks.
Colour mixed(const Colour& a, const Colour& b, double t);
/// A term's words in a box with a wash behind them as far as it is lit.
void draw_term(Frame& frame, const Rect& box, const Words& words, Text how, const Term& term);

}  // namespace crescent::explainer
