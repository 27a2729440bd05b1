// The mirror direction tilts, and part of the hemisphere is never reached: measured against (1 - cos theta)/2.
#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "hemisphere.h"
#include "measures/measures.h"
#include "shots.h"
#include "words.h"

namespace crescent::explainer {

namespace {

// Seconds from the shot's beginning.
constexpr double leans = 0.8, leant = 2.8, unreached = 3.2, top_view = 7.8, sweep = 12.4, swept = 15.6,
                 measured_at = 16, end = 19.2;
constexpr double degree = pi / 180;
constexpr Point side_centre{330, 640}, disc_centre{920, 520};
constexpr double side_radius = 250, disc_radius = 250;
constexpr Rect chart{1370, 260, 450, 430};

class Tilt {
public:
    explicit Tilt(const Data& data)
        : data_(data),
          measures_(*data.measures),
          side_(side_centre, side_radius, 0, {-1, 0, 0}),
          disc_(disc_centre, disc_radius, 90, {-1, 0, 0}) {
        double top = 0;
        for (const LostSupport& l : lost()) {
            largest_tilt_ = std::max(largest_tilt_, l.theta_R_deg);
            top = std::max({top, l.theory, l.measured});
        }
        const LostSupport& surround = measures_.surround_lost;
        top = std::max({top, surround.theory, surround.measured});
        axes_ = {chart, {0, std::max(largest_tilt_, surround.theta_R_deg), false}, {0, 110 * top, false}};
    }

    void draw(Frame& f) const {
        const double first = f.ease(leans, leant) * first_tilt_, home = f.ease(sweep, sweep + 0.7),
                     growth = f.ramp(sweep + 0.8, swept);
        const double share = f.ease(measured_at, measured_at + 0.8),
                     last = largest_tilt_ + (measures_.surround_lost.theta_R_deg - largest_tilt_) * share;
        const double theta = share > 0 ? last : growth > 0 ? growth * largest_tilt_ : first * (1 - home);
        from_the_side(f, theta);
        from_above(f, theta);
        curve(f, growth * largest_tilt_);
    }
    std::vector<Cue> cues() const;

private:
    const std::vector<LostSupport>& lost() const { return data_.evidence.lost; }
    /// R tilted from n in the plane of the drawing, and the edge of the hemisphere around it.
    static Vec3d mirror(double theta) { return {-math::sin(theta * degree), 0, math::cos(theta * degree)}; }
    static Vec3d edge(double theta) { return {math::cos(theta * degree), 0, math::sin(theta * degree)}; }

    void from_the_side(Frame& f, double theta) const {
        const double opacity = f.ease(0, 0.6), wedge_opacity = f.ease(unreached, unreached + 0.6);
        std::vector<Point> wedge{side_centre}, arc;
        for (int k = 0; k <= 60; ++k) wedge.push_back(side_.at(direction(90 - theta * k / 60, 0)));
        f.polygon(wedge, alert, 0.45 * wedge_opacity);
        for (int k = 0; k <= 120; ++k) arc.push_back(side_.at(direction(-90 + 1.5 * k, 0)));
        f.polyline(arc, muted, 3, opacity);
        f.line(side_.at({-1, 0, 0}, 1.1), side_.at({1, 0, 0}, 1.1), bright, 4, opacity);
        std::vector<Point> lobe;
        for (int k = -90; k <= 90; ++k) {
            const double reach = math::pow(math::cos(k * degree), data_.cast.s);
            const Vec3d w = direction(k - theta, 0);
            if (w.z >= 0) lobe.push_back(side_.at(w, 0.92 * reach));
        }
        f.polygon(lobe, data_.ink(data_.cast.phong), 0.5 * opacity);
        f.polyline(lobe, data_.ink(data_.cast.phong), 3, opacity);
        const Vec3d e = edge(theta);
        f.line(side_centre, side_.at(e, 1.1), alert, 3, wedge_opacity, 10);
        side_.arrow(f, {0, 0, 1}, 1.16, Words("n"), bright, opacity * f.ease(leans + 0.4, leans + 1));
        side_.arrow(f, mirror(theta), 1.16, Words("R"), data_.ink(data_.cast.phong), opacity);
        f.text({side_centre.x - 250, side_centre.y + 20, 500, 44},
            Words("from the side:  θ = ", number(std::round(theta), 3, "tilt of the mirror direction"), "°"),
            with(label_text, Align::centre), opacity);
    }

    void from_above(Frame& f, double theta) const {
        const double opacity = f.ease(top_view, top_view + 0.8);
        if (opacity <= 0) return;
        const Vec3d r = mirror(theta), e = edge(theta);
        std::vector<Point> lune;
        for (int k = 0; k <= 60; ++k) lune.push_back(disc_.rim(0.25 + 0.5 * k / 60));
        for (int k = 0; k <= 60; ++k) {
            const double a = 3 * k * degree, s = math::sin(a);
            lune.push_back(disc_.at({s * e.x, math::cos(a), s * e.z}));
        }
        f.polygon(lune, alert, 0.3 * opacity);
        for (const Vec3d& w : measures_.cosine_directions)
            f.dot(disc_.at(w), 3, dot(w, r) > 0 ? muted : alert, opacity);
        f.circle(disc_.centre(), disc_.radius(), muted, 3, opacity);
        const Point tip = disc_.at(r);
        f.fill({tip.x - 14, tip.y - 22, 60, 44}, ground, 0.85 * opacity);
        f.dot(tip, 9, data_.ink(data_.cast.phong), opacity);
        f.text({tip.x + 14, tip.y - 22, 50, 44}, Words("R"), with(label_text, data_.ink(data_.cast.phong)), opacity);
        f.text({disc_centre.x - 250, disc_centre.y - disc_radius - 66, 500, 44}, Words("from above"),
            with(label_text, Align::centre), opacity);
        const Rect label_box{disc_centre.x - 280, disc_centre.y + disc_radius + 22, 560, 44};
        f.text(label_box, Words("each dot: the same share of light"), with(label_text, Align::centre), opacity);
    }

    void curve(Frame& f, double theta) const {
        const double opacity = f.ease(sweep, sweep + 0.6);
        if (opacity <= 0) return;
        axes_.draw(f, round_values(axes_.horizontal, 6), round_values(axes_.vertical, 5), Words("tilt θ, degrees"),
            Words("never reached, %"), opacity);
        std::vector<Point> path;
        for (int k = 0; k <= 75 && k * largest_tilt_ / 75 <= theta + 1e-9; ++k) {
            const double a = k * largest_tilt_ / 75;
            path.push_back(axes_.at(a, 50 * (1 - math::cos(a * degree))));
        }
        if (path.size() > 1) f.polyline(path, bright, 3);
        f.text({chart.x + 30, chart.y + 6, 320, 44}, Words(formulas::lost_support), label_text, opacity);
        for (const LostSupport& l : lost())
            if (l.theta_R_deg <= theta + 1e-9 && f.after(sweep + 0.8))
                f.dot(axes_.at(l.theta_R_deg, 100 * l.measured), 9, alert);
        const LostSupport& surround = measures_.surround_lost;
        const double mark_opacity = f.ease(measured_at + 0.8, measured_at + 1.2);
        f.line(axes_.at(surround.theta_R_deg, 0), axes_.at(surround.theta_R_deg, 100 * surround.measured), bright, 2,
            mark_opacity, 8);
        f.circle(axes_.at(surround.theta_R_deg, 100 * surround.measured), 13, bright, 3, mark_opacity);
        f.dot({chart.x + 40, chart.y + 76}, 9, alert, opacity);
        f.text({chart.x + 60, chart.y + 56, 260, 40}, Words("measured"), with(small_text, bright), opacity);
    }

    const Data& data_;
    const Measures& measures_;
    Hemisphere side_, disc_;
    double largest_tilt_ = 0;
    double first_tilt_ = 45;  // degrees, in the first half
    Axes axes_;
};

std::vector<Cue> Tilt::cues() const {
    const LostSupport& l = measures_.surround_lost;
    const Number tilt = number(l.theta_R_deg, 2, "median tilt of R in " + data_.cast.surround);
    std::vector<Cue> out;
    out.push_back({0.3, Words("On most surfaces R leans away from n.")});
    out.push_back({unreached,
        Words("Behind it ", data_.arm(data_.cast.phong), " has no density: it never aims there, at any N.")});
    out.push_back({top_view, Words("From above, each dot is an equal share of light. The coloured are lost.")});
    out.push_back({sweep,
        Words("In region ", name(data_.cast.surround), ", R leans by ", tilt,
            "° in the median: ", figure(100 * l.measured, 3, "share never reached"), " ± ",
            percent(l.se, 1, "standard error of the share never reached"),
            " is lost. Theory: ", percent(l.theory, 3, "share never reached, in theory"), ".")});
    return out;
}

}  // namespace

Shot tilt(const Data& data) {
    if (data.evidence.lost.empty()) return {};
    const auto drawing = std::make_shared<const Tilt>(data);
    Shot shot;
    shot.name = "tilt";
    shot.kind = Kind::backend;
    shot.title = Words("What is never reached");
    shot.description = Words(
        "A hemisphere from the side and from above. As the mirror direction tilts, a growing part behind it is out of "
        "reach; a chart compares its measured share with (one minus the cosine of the tilt) over two.");
    shot.seconds = end;
    shot.still = end - 0.5;
    shot.cues = drawing->cues();
    shot.draw = [drawing](Frame& f) { drawing->draw(f); };
    return shot;
}

}  // namespace crescent::explainer
