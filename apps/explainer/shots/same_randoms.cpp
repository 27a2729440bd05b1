// The same random numbers move from their square to the hemisphere, by cosine, then by Phong: only the map differs.
#include <cmath>

#include "drawing.h"
#include "hemisphere.h"
#include "measures/measures.h"
#include "shots.h"
#include "words.h"

namespace crescent::explainer {

namespace {

// Seconds from the shot's beginning.
constexpr double appear = 0.5, appeared = 2.6, cosine_go = 4.1, cosine_hit = 8, return_start = 10.4, phong_go = 11.6,
                 phong_hit = 14.8, long_run = 16, end = 21.6;
constexpr Rect square{190, 250, 500, 500};
constexpr double one_way = 1.4, all_way = 2.8;  // of one point, of all points

struct MovingPoint {
    Point from, cosine, phong;
    bool cosine_hit = false, phong_hit = false, phong_below_horizon = false;
    Colour ink;
};

Point between(Point a, Point b, double t) { return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t}; }
Vec3d wide(Vec3f v) { return {double(v.x), double(v.y), double(v.z)}; }

class SameRandoms {
public:
    explicit SameRandoms(const Data& data)
        : data_(data),
          story_(data.measures->story),
          pixel_(*story_.pixel),
          disc_({1260, 525}, 340, 90, pixel_.mirror()) {
        for (std::size_t k = 0; k < story_.cosine.samples.size(); ++k) {
            const PixelSample& a = story_.cosine.samples[k];
            const PixelSample& b = story_.phong.samples[k];
            MovingPoint t;
            t.from = {square.x + square.w * double(a.u.x), square.bottom() - square.h * double(a.u.y)};
            t.cosine = disc_.at(wide(a.wi));
            t.phong = disc_.at(wide(b.wi));
            t.cosine_hit = a.meets_light();
            t.phong_hit = b.meets_light();
            t.phong_below_horizon = b.cos <= 0;
            t.ink = plates::colour(turbo(0.1 + 0.8 * double(a.u.x)));
            points_.push_back(t);
        }
    }

    void draw(Frame& f) const {
        randoms(f);
        hemisphere(f);
        moving_points(f);
        counts(f);
    }

    std::vector<Cue> cues() const {
        const std::string cosine = data_.cast.cosine, phong = data_.cast.phong;
        std::vector<Cue> out;
        out.push_back(
            {appear, Words(data_.n_of(data_.key(cosine)), " pairs of random numbers: every arm gets the same.")});
        out.push_back({cosine_go, Words(data_.arm(cosine), " makes directions of them, seen from above.")});
        out.push_back({cosine_hit, Words(hits_text(story_.cosine), " hit the light.")});
        out.push_back({return_start,
            Words("The same pairs by ", data_.arm(phong), " gather about R. ", hits_text(story_.phong),
                " hit the light.")});
        out.push_back({long_run,
            Words("Only the map differs: by ", data_.arm(cosine), " ", one_in(story_.cosine), " meets the light, by ",
                data_.arm(phong), " ", one_in(story_.phong), ".")});
        return out;
    }

private:
    Words hits_text(const ArmAtPixel& arm) const {
        if (arm.hits == 0) return Words("None");
        return Words(count(arm.hits, "samples of " + arm.arm + " that hit a light in the opened pixel"), " of ",
            count(arm.samples.size(), "samples of " + arm.arm));
    }
    Words one_in(const ArmAtPixel& arm) const {
        if (!(arm.hit_share > 0)) return Words("none");
        const double interval = 1 / arm.hit_share,
                     unit = math::pow(10.0, std::max(0.0, std::floor(math::log10(interval)) - 1));
        const auto rounded_interval = static_cast<std::uint64_t>(unit * std::round(interval / unit));  // to two digits
        return Words("one in ", count(rounded_interval, "share of a long series of " + arm.arm + " that hit a light"));
    }

    void randoms(Frame& f) const {
        const double opacity = f.ease(0, appear);
        f.outline(square, muted, 3, opacity);
        f.text({square.x, square.bottom() + 14, square.w, 40}, Words(formulas::first_random),
            with(label_text, Align::centre), opacity);
        f.text({square.x - 90, square.y + square.h / 2 - 20, 70, 40}, Words(formulas::second_random),
            with(label_text, Align::right), opacity);
        f.text(
            {square.x, square.y - 64, square.w, 44}, Words("random pairs u"), with(label_text, Align::centre), opacity);
    }

    void hemisphere(Frame& f) const {
        const double opacity = f.ease(appeared, appeared + 0.8);
        disc_.grid(f, opacity);
        f.circle(disc_.centre(), disc_.radius(), muted, 3, opacity);
        const Point n = disc_.at({0, 0, 1});
        f.dot(n, 6, bright, opacity);
        f.text({n.x - 60, n.y + 8, 44, 40}, Words("n"), with(label_text, Align::right), opacity);
        const double mirror = f.ease(phong_go - 0.8, phong_go - 0.2);
        const Point r = disc_.at(pixel_.mirror());
        f.dot(r, 6, bright, mirror);
        f.text({1640, r.y - 22, 60, 44}, Words("R"), label_text, mirror);
        f.line({r.x + 40, r.y}, {1630, r.y}, bright, 2, mirror);
    }

    /// Draws the light's outline over the dots.
    void light(Frame& f) const {
        if (story_.disk < 0) return;
        const double opacity = f.ease(appeared, appeared + 0.8);
        const PixelLight& disk = pixel_.lights()[std::size_t(story_.disk)];
        std::vector<Point> rim;
        for (const Vec3d& w : disk.rim) rim.push_back(disc_.at(w));
        f.polyline(rim, bright, 3, opacity);
        const Point position = disc_.at(disk.towards), label{1640, 290};
        f.line({position.x + 20, position.y - 20}, {label.x - 10, label.y + 10}, bright, 2, opacity);
        f.text({label.x, label.y - 22, 220, 44}, Words(name(disk.name)), label_text, opacity);
    }

    void moving_points(Frame& f) const {
        const int n = static_cast<int>(points_.size());
        const int point_count = f.steps(appear, appeared, n);
        const double stagger = (all_way - one_way) / n;
        for (int k = 0; k < point_count; ++k) {
            const MovingPoint& p = points_[std::size_t(k)];
            f.circle(p.from, 6, p.ink, 1.5, 0.5);
            const double cosine_way = f.ease(cosine_go + stagger * k, cosine_go + stagger * k + one_way),
                         way_back = f.ease(return_start, return_start + 1);
            const double phong_way = f.ease(phong_go + stagger * k, phong_go + stagger * k + one_way);
            const Point position = phong_way > 0 ? between(p.from, p.phong, phong_way)
                                                 : between(between(p.from, p.cosine, cosine_way), p.from, way_back);
            if (phong_way >= 1 && p.phong_below_horizon) f.circle(position, 6, muted, 2);
            else f.dot(position, 7, p.ink);
        }
        for (const MovingPoint& p : points_) {
            if (p.cosine_hit) f.circle(p.cosine, 11, bright, 3, f.during(cosine_hit + 0.3, return_start - 0.3));
            if (p.phong_hit) f.circle(p.phong, 11, bright, 3, f.ease(phong_hit + 0.3, phong_hit + 0.7));
        }
        light(f);
    }

    void counts(Frame& f) const {
        const Rect box{disc_.centre().x - 330, 122, 660, 50};
        const auto draw_heading = [&](const std::string& arm, double alpha) {
            const Words words(data_.arm(arm), ":  ",
                Formula{arm == data_.cast.cosine ? formulas::cosine_density.markup : formulas::phong_density.markup});
            f.text(box, words, with(with(label_text, data_.ink(arm)), Align::centre), alpha);
        };
        draw_heading(data_.cast.cosine, f.during(cosine_go + 0.4, return_start));
        draw_heading(data_.cast.phong, f.ease(phong_go - 0.4, phong_go));
    }

    const Data& data_;
    const PixelStory& story_;
    const OpenPixel& pixel_;
    Hemisphere disc_;
    std::vector<MovingPoint> points_;
};

}  // namespace

Shot same_randoms(const Data& data) {
    const auto drawing = std::make_shared<const SameRandoms>(data);
    Shot shot;
    shot.name = "same-randoms";
    shot.kind = Kind::backend;
    shot.title = Words("The same random numbers, two maps");
    shot.description = Words(
        "Dots in a square, one for each pair of random numbers, travel to the hemisphere seen from above: first by ",
        data.arm(data.cast.cosine), ", all over it; then by ", data.arm(data.cast.phong),
        ", about the mirror direction. The light is outlined.");
    shot.seconds = end;
    shot.still = end - 0.5;
    shot.cues = drawing->cues();
    shot.draw = [drawing](Frame& f) { drawing->draw(f); };
    return shot;
}

}  // namespace crescent::explainer
