// One pixel of the crescent and its hemisphere: f, then L with its light, then the cosine; the estimator builds term by
// term.
#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "estimator_formula.h"
#include "hemisphere.h"
#include "measures/measures.h"
#include "shots.h"
#include "words.h"

namespace crescent::explainer {

namespace {

// Seconds from the shot's beginning.
constexpr double zoomed = 1.4, opening = 3.9, reflects = 10.4, lights = 13.6, leans = 17.2, product = 20.2,
                 divided = 25, averaged = 26.4, end = 29.4;
constexpr Rect photo_slot{120, 232, 960, 540};
constexpr int crop_side = 24, crop_times = 20;
constexpr Point crop_corner{1260, 262};
constexpr Point formula_at{1190, 420};
constexpr double formula_px = 70;
constexpr Point bar_corner{1190, 640};
constexpr int bar_width = 660, bar_height = 30;

/// A field over the hemisphere in turbo colours, from 0 to its own maximum.
struct Field {
    Block block;
    double top = 0;
};

Field field_of(const Hemisphere& dome, const std::function<double(Vec3d)>& value) {
    double top = 0;
    dome.field([&](Vec3d w) { return top = std::max(top, value(w)), Srgb8{}; });
    return {dome.field([&](Vec3d w) { return turbo(top > 0 ? value(w) / top : 0); }), top};
}

Block bar_block() {
    Block block(bar_width, bar_height);
    for (int y = 0; y < bar_height; ++y)
        for (int x = 0; x < bar_width; ++x) block.set(x, y, turbo((x + 0.5) / bar_width));
    return block;
}

class OnePixel {
public:
    explicit OnePixel(const Data& data)
        : data_(data),
          story_(data.measures->story),
          pixel_(*story_.pixel),
          dome_({530, 560}, 350, 48, pixel_.mirror()) {
        const RunKey key = data.key(data.cast.cosine);
        const plates::View view = plates::view(data.film(key));
        const Box pixel_box{pixel_.i(), pixel_.j(), pixel_.i(), pixel_.j()};
        photo_box_ = around(data, data.box(data.cast.highlight), int(photo_slot.w), int(photo_slot.h));
        crop_box_ = around(data, pixel_box, crop_side, crop_side);
        photo_ = photograph_of(data, view, photo_box_);
        crop_ = photograph_of(data, view, crop_box_);
        const auto f = [&](Vec3d w) { return pixel_.f(w, pixel_.disk_met(w)); };
        fields_[0] = field_of(dome_, f);
        fields_[1] = field_of(dome_, [&](Vec3d w) { return pixel_.light(w); });
        fields_[2] = field_of(dome_, [&](Vec3d w) { return w.z; });
        fields_[3] = field_of(dome_, [&](Vec3d w) { return f(w) * pixel_.light(w) * w.z; });
        bar_ = bar_block();
    }

    void draw(Frame& f) const {
        photograph(f);
        opened(f);
        fields(f);
        estimator(f);
    }

    std::vector<Cue> cues() const;

private:
    /// Returns the pixel's square in the enlarged crop.
    Rect square() const {
        const double x = crop_corner.x + (pixel_.i() - crop_box_.x0) * crop_times;
        return {x, crop_corner.y + (crop_box_.y1 - pixel_.j()) * crop_times, crop_times, crop_times};
    }
    Point in_photo(int i, int j) const {
        return {photo_slot.x + (i - photo_box_.x0), photo_slot.y + (photo_box_.y1 - j)};
    }

    void photograph(Frame& f) const {
        const double opacity = f.ease(0, 0.6) * (1 - f.ease(opening, opening + 0.8));
        if (opacity <= 0) return;
        f.picture(photo_, photo_slot.x, photo_slot.y, 1, opacity);
        f.text({photo_slot.x, photo_slot.bottom() + 10, 960, 40},
            Words("photograph: ", data_.arm(data_.cast.cosine), ", N = ", data_.n_of(data_.key(data_.cast.cosine))),
            small_text, opacity);
        const double crop_opacity = opacity * f.ease(zoomed, zoomed + 0.6);
        const Point a = in_photo(crop_box_.x0, crop_box_.y1), b = in_photo(crop_box_.x1 + 1, crop_box_.y0 - 1);
        f.outline({a.x, a.y, b.x - a.x, b.y - a.y}, highlight_ink, 4, crop_opacity);
        const double side = crop_side * crop_times;
        f.line({b.x, a.y}, crop_corner, rule, 2, crop_opacity);
        f.line({b.x, b.y}, {crop_corner.x, crop_corner.y + side}, rule, 2, crop_opacity);
        f.picture(crop_, crop_corner.x, crop_corner.y, crop_times, crop_opacity);
        f.outline(square().inset(-3), highlight_ink, 6, crop_opacity);
        f.text({crop_corner.x, crop_corner.y + side + 10, side, 40},
            Words("pixel ", count(std::uint64_t(pixel_.i()), "the opened pixel"), ", ",
                count(std::uint64_t(pixel_.j()), "the opened pixel"), ",  × ", number(crop_times, 2, "enlargement")),
            small_text, crop_opacity);
    }

    /// Moves the pixel's outline to the edge of its hemisphere.
    void opened(Frame& f) const {
        const double t = f.ease(opening + 0.6, opening + 2), alpha = f.ease(opening, opening + 0.6);
        if (alpha <= 0) return;
        const Rect q = square().inset(-2);
        std::vector<Point> loop;
        for (int k = 0; k <= 96; ++k) {
            const double turns = k / 96.0, c = math::cos(2 * pi * turns), s = math::sin(2 * pi * turns);
            const double reach = 1 / std::max(std::fabs(c), std::fabs(s));  // from the middle to the square's edge
            const Point from{q.x + q.w / 2 * (1 + c * reach), q.y + q.h / 2 * (1 - s * reach)};
            const Point to = dome_.rim(turns);
            loop.push_back({from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t});
        }
        f.polyline(loop, bright, 4, alpha * (1 - f.ease(opening + 2.6, opening + 3)));
    }

    void fields(Frame& f) const {
        const double starts[] = {reflects, lights, leans, product};
        for (int k = 0; k < 4; ++k) {
            const double opacity = f.ease(starts[k], starts[k] + 0.8);
            const double fade = k < 3 ? f.ease(starts[k + 1] + 0.8, starts[k + 1] + 0.81) : 0;
            if (opacity > 0 && fade < 1) f.field(fields_[k].block, dome_.corner(), opacity);
        }
        const double dome = f.ease(opening + 1.9, opening + 2.6);
        dome_.grid(f, dome);
        dome_.arrow(f, {0, 0, 1}, 1.62, Words("n"), bright, dome);
        dome_.arrow(
            f, pixel_.wo(), 1.6, Words("ω<sub>o</sub>, to the eye"), bright, f.ease(opening + 3, opening + 3.6));
        dome_.arrow(f, pixel_.mirror(), 1.45, Words("R"), bright, f.ease(reflects + 0.8, reflects + 1.4));
        disk(f);
        scale(f, starts);
    }

    void disk(Frame& f) const {
        const double opacity = f.ease(lights + 0.9, lights + 1.5);
        if (story_.disk < 0 || opacity <= 0) return;
        const PixelLight& disk = pixel_.lights()[std::size_t(story_.disk)];
        dome_.trace(f, disk.rim, bright, 3, opacity);
        const Point position = dome_.at(disk.towards), label{900, position.y + 60};
        f.line({position.x + 26, position.y + 10}, {label.x - 10, label.y}, bright, 2, opacity);
        f.text({label.x, label.y - 24, 240, 44}, Words(name(disk.name)), label_text, opacity);
        if (round(disk))
            f.text({label.x, label.y + 20, 240, 44},
                Words("radius ", number(disk.angular_radius, 3, "angle of the light"), "°"), small_text, opacity);
    }

    /// Returns whether a light is described by its angular radius, unlike a rectangle.
    bool round(const PixelLight& light) const {
        const std::vector<LightTable> tables = all_lights(data_.experiment);
        const auto is_it = [&](const LightTable& table) { return table.light.name == light.name; };
        const auto match = std::ranges::find_if(tables, is_it);
        return match != tables.end() && match->light.kind() != "rectangle";
    }

    /// Draws the colour bar of the field that is shown, with its name and its ends.
    void scale(Frame& f, const double (&starts)[4]) const {
        const double opacity = f.ease(reflects, reflects + 0.8);
        f.field(bar_, bar_corner, opacity);
        const Rect label_box{bar_corner.x, bar_corner.y + bar_height + 8, bar_width, 40};
        f.text(label_box, Words(number(0, 1, "least of a scale")), small_text, opacity);
        const Words whats[] = {Words(formulas::f, ", per sr"), Words(formulas::light, ", ", formulas::radiance_unit),
            Words(formulas::cosine), Words(formulas::f, " ", formulas::light, " ", formulas::cosine)};
        for (int k = 0; k < 4; ++k) {
            const double fade = k < 3 ? f.ease(starts[k + 1], starts[k + 1] + 0.1) : 0;
            const double label_opacity = f.ease(starts[k] + 0.1, starts[k] + 0.6) * (1 - fade);
            f.text({bar_corner.x, bar_corner.y - 56, bar_width, 44}, whats[k], with(label_text, Align::centre),
                label_opacity);
            f.text(label_box, Words(figure(fields_[k].top, 3, "largest value over the hemisphere")),
                with(small_text, Align::right), label_opacity);
        }
    }

    void estimator(Frame& f) const {
        const auto lit = [&](double from, double to) { return f.during(from + 0.4, to); };
        EstimatorTerms terms;
        const double product_lit = lit(product, divided);
        terms.f = {f.ease(reflects, reflects + 0.6), std::max(product_lit, lit(reflects, lights))};
        terms.light = {f.ease(lights, lights + 0.6), std::max(product_lit, lit(lights, leans))};
        terms.cosine = {f.ease(leans, leans + 0.6), std::max(product_lit, lit(leans, product))};
        terms.density = {f.ease(divided, divided + 0.6), lit(divided, averaged)};
        terms.average = {f.ease(averaged, averaged + 0.6), f.ease(averaged, averaged + 0.6)};
        draw_estimator(f, formula_at, formula_px, terms);
    }

    const Data& data_;
    const PixelStory& story_;
    const OpenPixel& pixel_;
    Hemisphere dome_;
    Box photo_box_, crop_box_;
    Block photo_, crop_, bar_;
    Field fields_[4];
};

std::vector<Cue> OnePixel::cues() const {
    std::vector<Cue> out;
    const std::string region = data_.cast.highlight;
    out.push_back({0.4,
        Words("The pixel of region ", name(region), " that ", data_.arm(data_.cast.cosine), " gets most wrong.")});
    out.push_back({opening, Words("What light does it send to the eye?"), true});
    out.push_back({reflects, Words("f: what it passes on to the eye.")});
    if (story_.disk < 0) {
        out.push_back({lights, Words("L: what comes in, here alike all round.")});
    } else if (const std::size_t disks = pixel_.lights().size(); disks > 1) {
        out.push_back({lights, Words("L: what comes in, dim but for ", count(disks, "lights"), " lights.")});
    } else if (const PixelLight& light = pixel_.lights()[std::size_t(story_.disk)]; round(light)) {
        out.push_back({lights,
            Words("L: what comes in, dim but for a disk of ",
                number(light.angular_radius, 3, "angular radius of the light"), "° radius.")});
    } else {
        out.push_back({lights, Words("L: what comes in, dim but for the light.")});
    }
    out.push_back({leans, Words("cos θ: low light is spread thin.")});
    const double part = story_.solid_angle / (2 * pi);
    if (story_.disk >= 0)
        out.push_back({product,
            Words("The product: ", percent(story_.disk_share, 2, "what does not come from the fill"),
                " of the light comes through ", percent(part, 2, "the light's share of the hemisphere"),
                " of the hemisphere.")});
    else out.push_back({product, Words("The product is what must be summed over all directions.")});
    out.push_back({divided, Words("Draw directions, divide by their density p, average.")});
    return out;
}

}  // namespace

Shot one_pixel(const Data& data) {
    const auto drawing = std::make_shared<const OnePixel>(data);
    Shot shot;
    shot.name = "one-pixel";
    shot.kind = Kind::backend;
    shot.title = Words("One pixel, opened");
    shot.description = Words(
        "A pixel of the crescent grows into the hemisphere above its surface point. Colours show in turn the "
        "reflectance f, "
        "the light L, the cosine and their product; the estimator is written next to them, term by term.");
    shot.seconds = end;
    shot.still = shot.seconds - 0.5;
    shot.cues = drawing->cues();
    shot.draw = [drawing](Frame& f) { drawing->draw(f); };
    return shot;
}

}  // namespace crescent::explainer
