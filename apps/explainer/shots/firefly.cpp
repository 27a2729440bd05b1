// Shows how a firefly arises: the running mean of the selected pixel, draw after draw, and the factors of its largest
// sample.
#include <algorithm>
#include <cmath>
#include <limits>

#include "drawing.h"
#include "estimator_formula.h"
#include "measures/measures.h"
#include "shots.h"
#include "words.h"

namespace crescent::explainer {

namespace {

// Seconds from the shot's beginning.
constexpr double start = 0.6, giant = 3.9, factors = 7.2, sharp = 10.6, comparison = 15, remainder = 19.4, end = 24.6;
constexpr double lead_seconds = 2.8, remainder_seconds = 3;  // duration of the draws before and after the largest
constexpr Rect chart{200, 240, 860, 470};
constexpr Rect table{1240, 470, 600, 340};
constexpr int crop_side = 13, crop_times = 20;
constexpr Point crop_corner{1410, 150};

class Firefly {
public:
    explicit Firefly(const Data& data) : data_(data), story_(data.measures->story), arm_(story_.cosine) {
        const double n = double(arm_.mean.size());
        const double top = std::max(*std::max_element(arm_.mean.begin(), arm_.mean.end()), story_.reference);
        axes_ = {chart, {0, n, false}, {0, 1.08 * top, false}};
        const OpenPixel& pixel = *story_.pixel;
        const Box crop_box = around(data, {pixel.i(), pixel.j(), pixel.i(), pixel.j()}, crop_side, crop_side);
        for (const Film& film : data.opening)
            crops_.push_back({film.n, photograph_of(data, plates::view(&film), crop_box)});
        pixel_rect_ = {crop_corner.x + (pixel.i() - crop_box.x0) * crop_times,
            crop_corner.y + (crop_box.y1 - pixel.j()) * crop_times, crop_times, crop_times};
    }

    void draw(Frame& f) const {
        const int first = int(arm_.largest), n = int(arm_.mean.size());
        const int draw_count = f.steps(start, start + lead_seconds, first) + (f.after(giant) ? 1 : 0) +
            f.steps(remainder, remainder + remainder_seconds, n - first - 1);
        chart_of(f, draw_count);
        crop(f, draw_count);
        taken_apart(f);
    }

    std::vector<Cue> cues() const;

private:
    void chart_of(Frame& f, int draw_count) const {
        const double opacity = f.ease(0, 0.6);
        std::vector<Tick> x_ticks = round_values(axes_.horizontal, 8);
        axes_.draw(f, x_ticks, round_values(axes_.vertical, 6), Words("draws n"),
            Words("mean of X over the first n draws"), opacity);
        const double level = axes_.y(story_.reference);
        f.line({chart.x, level}, {chart.right(), level}, bright, 2, opacity, 12);
        f.text({chart.right() - 330, level - 46, 330, 40},
            Words("reference: ", figure(story_.reference, 3, "reference of the opened pixel")),
            with(with(small_text, bright), Align::right), opacity);
        std::vector<Point> path;
        for (int k = 0; k < draw_count; ++k) {
            const double y = axes_.y(arm_.mean[std::size_t(k)]);
            if (k > 0 && arm_.samples[std::size_t(k)].meets_light()) path.push_back({axes_.x(k + 1), path.back().y});
            path.push_back({axes_.x(k + 1), y});
        }
        const Colour ink = data_.ink(arm_.arm);
        if (path.size() > 1) f.polyline(path, ink, 4);
        if (path.empty()) return;
        f.dot(path.back(), 9, ink);
        const double clear = std::min(path.back().y - 22, level - 56);  // of the line at the correct value
        const Rect label{path.back().x + 18, clear, 150, 44};
        f.text(label, Words(figure(arm_.mean[std::size_t(draw_count - 1)], 3, "running mean of " + arm_.arm)),
            with(label_text, ink));
    }

    void crop(Frame& f, int draw_count) const {
        const Crop* current = nullptr;
        for (const Crop& c : crops_)
            if (int(c.n) <= draw_count) current = &c;
        if (!current) return;
        const double side = crop_side * crop_times;
        f.picture(current->block, crop_corner.x, crop_corner.y, crop_times);
        f.outline(pixel_rect_.inset(-3), highlight_ink, 6);
        f.text({crop_corner.x - 20, crop_corner.y + side + 6, side + 40, 40},
            Words("photograph at N = ", count(current->n, "samples at a count")), with(small_text, Align::centre));
    }

    /// Draws X of a direction as a column of factors, with a sampler's density.
    void column(
        Frame& f, const std::string& arm, const PixelSample& s, double x, double alpha, const double (&lit)[5]) const {
        const std::string source = "largest sample of " + arm_.arm + ", weighed by " + arm;
        const double row = table.h / 6;
        const double over_p = s.pdf > 0 ? 1 / double(s.pdf) : std::numeric_limits<double>::infinity();
        const Number values[] = {figure(double(s.f), 3, source), figure(double(s.light), 3, source),
            figure(double(s.cos), 3, source), figure(over_p, 3, source), figure(double(s.x), 3, source)};
        f.text({x, table.y, 220, row}, Words(data_.arm(arm)), with(with(label_text, data_.ink(arm)), Align::centre),
            alpha);
        for (int k = 0; k < 5; ++k)
            draw_term(f, {x + 20, table.y + row * (k + 1) + 3, 180, row - 6}, Words(values[k]),
                with(label_text, Align::centre), {alpha, lit[k]});
    }

    void taken_apart(Frame& f) const {
        const double opacity = f.ease(giant + 0.8, giant + 1.4), second = f.ease(comparison, comparison + 0.6);
        if (opacity <= 0) return;
        const double row = table.h / 6;
        const Words names[] = {Words(formulas::f), Words("× ", formulas::light), Words("× ", formulas::cosine),
            Words("× ", formulas::one_over_density), Words("= X")};
        double lit[5] = {};
        for (int k = 0; k < 3; ++k) lit[k] = f.during(factors + 0.4 + 0.9 * k, factors + 0.9 + 0.9 * k);
        lit[3] = f.ease(sharp, sharp + 0.4);
        lit[4] = std::max(f.during(giant + 1.4, factors), f.ease(comparison, comparison + 0.4));
        for (int k = 0; k < 5; ++k)
            f.text({table.x - 20, table.y + row * (k + 1), 160, row}, names[k], label_text, opacity);
        f.line({table.x - 20, table.y + 5 * row}, {table.right(), table.y + 5 * row}, muted, 2, opacity);
        column(f, arm_.arm, arm_.largest_sample(), table.x + 130, opacity, lit);
        column(f, story_.phong.arm, story_.by_phong, table.x + 370, second, lit);
    }

    struct Crop {
        std::uint64_t n;
        Block block;
    };
    const Data& data_;
    const PixelStory& story_;
    const ArmAtPixel& arm_;
    Axes axes_;
    std::vector<Crop> crops_;
    Rect pixel_rect_;
};

std::vector<Cue> Firefly::cues() const {
    const PixelSample& s = arm_.largest_sample();
    const PixelSample& p = story_.by_phong;
    const std::string source = "largest sample of " + arm_.arm;
    std::vector<Cue> out;
    out.push_back({0.3, Words("The same pixel by ", data_.arm(arm_.arm), ", draw after draw.")});
    out.push_back({giant,
        Words("Draw ", count(arm_.largest + 1, source), s.meets_light() ? " meets the light" : " is the largest",
            " and weighs ", figure(double(s.x), 4, source), ".")});
    out.push_back({factors, Words("f, L and cos θ are as they should be.")});
    out.push_back(
        {sharp, Words("But ", data_.arm(arm_.arm), " seldom aims there: p is small, and X is divided by it.")});
    const Number phong = data_.arm(story_.phong.arm);
    if (p.pdf > 0)
        out.push_back({comparison,
            Words("The same direction, drawn by ", phong, ", would weigh ",
                figure(double(p.x), 3, source + ", weighed by " + story_.phong.arm), ". Only p differs.")});
    else out.push_back({comparison, Words(phong, " would never draw this direction.")});
    const double error = std::fabs(arm_.mean.back() - story_.reference);
    const bool is_firefly = error > data_.experiment.firefly_k * story_.reference;
    out.push_back({remainder,
        Words("More draws wear it down only as ", formulas::one_over_n,
            ". At N = ", count(arm_.mean.size(), "samples of " + arm_.arm), ": ",
            figure(arm_.mean.back(), 3, "mean of " + arm_.arm), is_firefly ? ". A firefly." : ".")});
    return out;
}

}  // namespace

Shot firefly(const Data& data) {
    const auto drawing = std::make_shared<const Firefly>(data);
    Shot shot;
    shot.name = "firefly";
    shot.kind = Kind::backend;
    shot.title = Words("A firefly is born");
    shot.description = Words("The running mean of the pixel by ", data.arm(data.cast.cosine),
        " against the number of draws leaps at one of them. "
        "That sample is written as the product of f, L, the cosine and one over p, and beside it as it "
        "would weigh if drawn by ",
        data.arm(data.cast.phong), ".");
    shot.seconds = end;
    shot.still = end - 0.5;
    shot.cues = drawing->cues();
    shot.draw = [drawing](Frame& f) { drawing->draw(f); };
    return shot;
}

}  // namespace crescent::explainer
