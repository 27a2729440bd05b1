// The estimator as a formula whose terms appear and are highlighted one by one: (1/N) sum of f L cos / p.
#pragma once

#include "frame.h"

namespace crescent::explainer {

/// alpha: opacity of a term; lit: how much it is highlighted.
struct Term {
    double alpha = 0, lit = 0;
};
struct EstimatorTerms {
    Term average, f, light, cosine, density;
};

/// Sets it with its left end at `origin`, the fraction's bar at origin.y.
void draw_estimator(Frame& frame, Point origin, double px, const EstimatorTerms& terms);

/// Returns a colour between two colours.
Colour mixed(const Colour& a, const Colour& b, double t);
/// Draws a term's words in a box, with a background if it is highlighted.
void draw_term(Frame& frame, const Rect& box, const Words& words, Text style, const Term& term);

}  // namespace crescent::explainer
