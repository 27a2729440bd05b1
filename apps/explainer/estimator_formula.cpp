// Words are measured, then set from left to right: 1/N and the sum, f, L and cos above the bar, p below its middle. The
// colour of a term goes from muted to bright when it is highlighted.
#include "estimator_formula.h"

#include <algorithm>

#include "drawing.h"
#include "words.h"

namespace crescent::explainer {

namespace {

constexpr Colour wash{1, 1, 1, 0.16};

struct Setter {
    Frame& frame;
    Text style;
    /// Sets words with their left end at x, their middle at y; returns the right end.
    double put(double x, double y, const Words& words, const Term& term) const {
        const Rect size = frame.measure(words, style);
        draw_term(frame, {x, y - size.h / 2, size.w + 1, size.h}, words, style, term);
        return x + size.w;
    }
    /// The same without the background.
    void bare(double x, double y, const Words& words, const Term& term) const {
        const Rect size = frame.measure(words, style);
        Text inked = style;
        inked.ink = mixed(muted, bright, term.lit);
        frame.text({x, y - size.h / 2, size.w + 1, size.h}, words, inked, term.alpha);
    }
    double width(const Words& words) const { return frame.measure(words, style).w; }
};

}  // namespace

Colour mixed(const Colour& a, const Colour& b, double t) {
    return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t, a.a + (b.a - a.a) * t};
}

void draw_term(Frame& frame, const Rect& box, const Words& words, Text style, const Term& term) {
    frame.fill({box.x - 8, box.y, box.w + 16, box.h}, wash, term.alpha * term.lit);
    style.ink = mixed(muted, bright, term.lit);
    frame.text(box, words, style, term.alpha);
}

void draw_estimator(Frame& frame, Point origin, double px, const EstimatorTerms& terms) {
    const Setter set{frame, with_px(with(title_text, Weight::medium), px)};
    const double rise = 0.66 * px, gap = 0.3 * px;
    const Words one{formulas::one}, n{"N"}, sigma{"Σ"};
    const double bar = std::max(set.width(one), set.width(n)) + 12;
    const double sum = bar + gap + set.width(sigma);
    frame.fill({origin.x - 8, origin.y - 2 * rise, sum + 16, 4 * rise}, wash, terms.average.alpha * terms.average.lit);
    set.bare(origin.x + (bar - set.width(one)) / 2, origin.y - rise, one, terms.average);
    set.bare(origin.x + (bar - set.width(n)) / 2, origin.y + rise, n, terms.average);
    frame.line({origin.x, origin.y}, {origin.x + bar, origin.y}, bright, 3, terms.average.alpha);
    set.bare(origin.x + bar + gap, origin.y, sigma, terms.average);
    double x = origin.x + sum + gap;
    const double left = x;
    x = set.put(x, origin.y - rise, Words(formulas::f), terms.f) + gap;
    x = set.put(x, origin.y - rise, Words(formulas::light), terms.light) + gap;
    x = set.put(x, origin.y - rise, Words(formulas::cosine), terms.cosine);
    const Words p{formulas::density};
    frame.line({left, origin.y}, {x, origin.y}, bright, 3, terms.density.alpha);
    set.put((left + x - set.width(p)) / 2, origin.y + rise, p, terms.density);
}

}  // namespace crescent::explainer
