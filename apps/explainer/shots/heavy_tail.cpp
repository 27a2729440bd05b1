// Shows why more samples do not remove it: the histogram of the weights, its tail index in theory and as fitted, and
// the white furnace that is too low in float and in double.
#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "estimator_formula.h"
#include "measures/measures.h"
#include "shots.h"
#include "words.h"

namespace crescent::explainer {

namespace {

// Seconds from the shot's beginning.
constexpr double histogram = 0.8, halves = 4.4, law = 8.8, furnace = 14.4, agreement = 18.8, end = 24;
constexpr Rect left{190, 240, 760, 470}, right{1160, 240, 660, 470};

/// Returns the results of one arithmetic, ascending in N.
std::vector<FurnaceQuantiles> readings(const Evidence& evidence, const std::string& arithmetic, int bits) {
    std::vector<FurnaceQuantiles> out;
    for (const FurnaceQuantiles& q : evidence.furnace)
        if (q.arithmetic == arithmetic && q.u_bits == bits) out.push_back(q);
    return out;
}

class HeavyTail {
public:
    explicit HeavyTail(const Data& data) : data_(data), tail_(data.measures->tail), phong_(data.cast.phong) {
        single_ = readings(data.evidence, "float32", 24);
        twofold_ = readings(data.evidence, "float64", 53);
        const double largest = double(*std::max_element(tail_.bins.begin(), tail_.bins.end()));
        histogram_ = {left, {tail_.edge(0), tail_.edge(tail_.bins.size()), true}, {0.7, 40 * largest, true}};
        double top = data.evidence.expected;
        for (const auto* list : {&single_, &twofold_})
            for (const FurnaceQuantiles& q : *list) top = std::max(top, q.q95);
        readings_ = {
            right, {0.03 * double(single_.front().n), 2 * double(single_.back().n), true}, {0, 1.1 * top, false}};
    }

    void draw(Frame& f) const {
        weights(f);
        furnaces(f);
    }
    std::vector<Cue> cues() const;

private:
    void weights(Frame& f) const {
        const double opacity = f.ease(0, 0.6);
        histogram_.draw(f, decades(histogram_.horizontal, 2), decades(histogram_.vertical, 2),
            Words("weight of a sample"), Words("how many samples of ", count(tail_.n, "draws of the weights")),
            opacity);
        const int bars = f.steps(histogram, histogram + 3, int(tail_.bins.size()));
        const Colour ink = data_.ink(phong_);
        for (std::size_t k = 0; k < std::size_t(bars); ++k) {
            if (tail_.bins[k] == 0) continue;
            const double x0 = histogram_.x(tail_.edge(k)), x1 = histogram_.x(tail_.edge(k + 1)),
                         y = histogram_.y(double(tail_.bins[k]));
            f.fill({x0 + 1, y, x1 - x0 - 2, left.bottom() - y}, ink, 0.75);
        }
        mark(f, tail_.median, Words("half below"), 0, f.ease(halves, halves + 0.5));
        mark(f, 1, Words("mean ", number(1, 1, "mean of the weights")), 1, f.ease(halves + 2, halves + 2.5));
        std::vector<Point> line;
        for (std::size_t k = 0; k < tail_.bins.size(); ++k) {
            const double expected = tail_.expected(k);
            if (k == 0 || expected < histogram_.vertical.low) continue;
            line.push_back(histogram_.at(std::sqrt(tail_.edge(k) * tail_.edge(k + 1)), expected));
        }
        const double fit_opacity = f.ease(law, law + 0.8);
        f.polyline(line, bright, 4, fit_opacity, 14);
        const Rect box{left.x + 380, left.y + 10, 480, 50};
        f.text(box, Words(formulas::tail_index, " = ", figure(tail_.k, 3, "tail index of the weights in theory")),
            label_text, fit_opacity);
        if (tail_.fit)
            f.text({box.x, box.y + 54, box.w, 50},
                Words("fitted: k̂ = ", figure(tail_.fit->k, 3, "k-hat of the weights"), " ± ",
                    figure(tail_.fit->se, 1, "standard error of k-hat")),
                with(label_text, ink), f.ease(law + 1.4, law + 2));
    }

    /// Draws a vertical line at a weight, its words above it; `row` 0 or 1 counts from the top.
    void mark(Frame& f, double weight, const Words& words, int row, double alpha) const {
        const double x = histogram_.x(weight), y = left.y + 12 + 50 * row;
        f.line({x, y}, {x, left.bottom()}, bright, 2, alpha, 8);
        f.text({x + 10, y - 8, 240, 40}, words, with(small_text, bright), alpha);
    }

    void furnaces(Frame& f) const {
        const double opacity = f.ease(furnace, furnace + 0.6);
        if (opacity <= 0) return;
        std::vector<double> n;
        for (const FurnaceQuantiles& q : single_) n.push_back(double(q.n));
        std::vector<Tick> x_ticks;
        for (const double v : n) x_ticks.push_back({v, Words(count(std::uint64_t(v), "N of a furnace"))});
        readings_.draw(f, x_ticks, round_values(readings_.vertical, 5), Words("N"),
            Words("white furnace: median and ", percent(0.9, 2, "width of an interval"), " of runs"), opacity);
        const double level = readings_.y(data_.evidence.expected);
        f.line({right.x, level}, {right.right(), level}, bright, 2, opacity, 12);
        f.text({right.x + 16, level - 44, 300, 40},
            Words("answer: ", figure(data_.evidence.expected, 3, "expected reading of the furnace")),
            with(small_text, bright), opacity);
        series(f, single_, -11, data_.ink(phong_), f.steps(furnace + 0.8, furnace + 3, int(single_.size())));
        series(f, twofold_, 11, bright, f.steps(agreement, agreement + 2, int(twofold_.size())));
        legend(f, 0, data_.ink(phong_), Words("float"), opacity);
        legend(f, 1, bright, Words("double"), f.ease(agreement, agreement + 0.4));
    }

    void series(
        Frame& f, const std::vector<FurnaceQuantiles>& list, double offset, Colour ink, int interval_count) const {
        for (std::size_t k = 0; k < std::size_t(interval_count); ++k) {
            const double x = readings_.x(double(list[k].n)) + offset;
            f.line({x, readings_.y(list[k].q05)}, {x, readings_.y(list[k].q95)}, ink, 3, 0.8);
            f.dot({x, readings_.y(list[k].median)}, 9, ink);
        }
    }

    void legend(Frame& f, int row, Colour ink, const Words& words, double alpha) const {
        const double y = right.bottom() - 90 + 44 * row;
        f.dot({right.x + 40, y}, 9, ink, alpha);
        f.text({right.x + 60, y - 20, 200, 40}, words, with(small_text, bright), alpha);
    }

    const Data& data_;
    const WeightTail& tail_;
    std::string phong_;
    std::vector<FurnaceQuantiles> single_, twofold_;
    Axes histogram_, readings_;
};

std::vector<Cue> HeavyTail::cues() const {
    const bool is_heavy = tail_.k >= 0.5;  // the variance is infinite from here on
    const double expected = data_.evidence.expected, single = single_.back().median, twofold = twofold_.back().median;
    const auto is_short = [&](double median) { return median < 0.98 * expected; };
    std::vector<Cue> out;
    out.push_back(
        {0.3, Words("What samples of ", data_.arm(phong_), " weigh on a matt surface, R = n, in even light.")});
    Words half("Half weigh under ", figure(tail_.median, 2, "median weight"), ". The mean, ",
        number(1, 1, "mean of the weights in theory"));
    out.push_back({halves, is_heavy ? Words(half, ", rests on few huge ones.") : Words(half, ", is not far above.")});
    const Words slope("A straight fall of slope ", formulas::tail_slope,
        ", k = ", figure(tail_.k, 3, "tail index of the weights in theory"), ". ");
    out.push_back({law,
        is_heavy ? Words(slope, "From ", formulas::half, " on the variance is infinite.")
                 : Words(slope, "Below ", formulas::half, " the variance is finite.")});
    out.push_back({furnace,
        Words("In white light the answer is known: ", figure(expected, 3, "expected reading of the furnace"),
            is_short(single) ? ". Most runs read less." : ". Runs read it.")});
    const Words both(figure(single, 3, "median reading of the furnace in float"), " in float, ",
        figure(twofold, 3, "median reading of the furnace in double"), " in double.");
    out.push_back(
        {agreement, is_short(single) && is_short(twofold) ? Words(both, " The tail does it, not rounding.") : both});
    return out;
}

}  // namespace

Shot heavy_tail(const Data& data) {
    if (data.evidence.furnace.empty()) return {};
    const auto drawing = std::make_shared<const HeavyTail>(data);
    Shot shot;
    shot.name = "heavy-tail";
    shot.kind = Kind::backend;
    shot.title = Words("Why it does not go away");
    shot.description = Words("Left, on logarithmic axes, how many samples of ", data.arm(data.cast.phong),
        " weigh how much: a straight fall over many decades. "
        "Right, the reading of a white furnace against N, in float and in double, with the value it should have.");
    shot.seconds = end;
    shot.still = end - 0.5;
    shot.cues = drawing->cues();
    shot.draw = [drawing](Frame& f) { drawing->draw(f); };
    return shot;
}

}  // namespace crescent::explainer
