// Shot 12: the exponent changes density and BRDF together: the lobe narrows, and with it the region in which it has low
// error.
#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "shots.h"

namespace crescent::explainer {

namespace {

constexpr double leaning = 0.6;  // rad, of R from n in the drawings of the lobe

/// Returns the lobe's density as a curve around a foot, its peak `radius` long.
std::vector<Point> lobe_of(const plates::Density& density, Point foot, double radius) {
    double peak = 0;
    std::vector<std::pair<double, double>> values;
    for (int k = -360; k <= 360; ++k) {
        const double angle = k * 0.25 * 3.14159265358979 / 180, p = density.in_plane(angle);
        peak = std::max(peak, p);
        values.emplace_back(angle, p);
    }
    std::vector<Point> out{foot};
    for (const auto& [angle, p] : values) {
        const double r = peak > 0 ? radius * p / peak : 0;
        out.push_back({foot.x + r * math::sin(angle), foot.y - r * math::cos(angle)});
    }
    return out;
}

struct Column {
    Block block;
    Words name, highlight, surround;
    std::vector<Point> lobe;
    Point foot;
    double error = 0;  // in the highlight
};

constexpr double width = 576, gap = 36;

/// Returns the left edge of column k of `count`.
double left_of(std::size_t k, std::size_t count) {
    return (sheet_width - width * double(count) - gap * double(count - 1)) / 2 + (width + gap) * double(k);
}

/// The first, the middle and the last exponent.
std::vector<Column> columns_of(const Data& data, const Box& box) {
    const auto& control = *data.experiment.exponent;
    const std::size_t count = std::min<std::size_t>(control.s.size(), 3);
    const std::string sampler = data.experiment.find_arm(control.arm)->sampler, highlight = data.cast.highlight;
    std::vector<Column> out;
    for (std::size_t k = 0; k < count; ++k) {
        const double s = control.s[k * (control.s.size() - 1) / (count - 1)];
        const RunKey key = data.key(control.arm, control.n, s);
        const Point foot{left_of(k, count) + width / 2 - 60, 312};
        out.push_back({photograph_of(data, plates::view(data.film(key)), box), Words("s\u00a0=\u00a0", data.s_of(key)),
            Words("highlight ", data.rmse(key, highlight)), Words("surround ", data.rmse(key, data.cast.surround)),
            lobe_of(plates::Density(data.experiment, sampler, s, leaning), foot, 150), foot,
            data.region(key, highlight)->rmse});
    }
    return out;
}

}  // namespace

Shot exponent(const Data& data) {
    Shot shot;
    const Cast& c = data.cast;
    const auto& control = data.experiment.exponent;
    if (!control || control->s.size() < 2) return shot;
    const Closeup crop = close_up(data, data.box(c.highlight), {0, 0, 576, 396}, 1.5);
    const std::vector<Column> cols = columns_of(data, crop.box);
    const Colour ink = data.ink(control->arm);
    const auto best = std::size_t(std::ranges::min_element(cols, {}, &Column::error) - cols.begin());

    shot.name = "exponent";
    shot.title = Words("A sharper lobe");
    shot.kind = Kind::photograph;
    shot.description = Words(
        "Three columns, one for each exponent: the lobe as a curve, narrower and narrower, and under it the highlight "
        "as it comes out.");
    shot.cues = {{0.5, Words("The exponent s sharpens the gloss, and with it the lobe that aims.")},
        {6, Words("Density and surface change together, and so does the highlight that is right.")},
        {11.5, Words("Error in the highlight: lowest at ", cols[best].name, " at this seed. Sharper is not safer.")}};
    if (best + 1 == cols.size())
        shot.cues[2].words =
            Words("Error in the highlight: lowest at ", cols[best].name, ", the sharpest, at this seed.");
    shot.seconds = 18;
    shot.still = 17;
    shot.draw = [=](Frame& f) {
        for (std::size_t k = 0; k < cols.size(); ++k) {
            const Column& col = cols[k];
            const double x = left_of(k, cols.size()), in = f.ease(0.5 + 1.2 * double(k), 1.3 + 1.2 * double(k));
            f.line({col.foot.x - 150, col.foot.y}, {col.foot.x + 250, col.foot.y}, muted, 3, in);
            f.polygon(col.lobe, ink, 0.3 * in);
            f.polyline(col.lobe, ink, 4, in);
            f.text({col.foot.x + 124, col.foot.y - 130, 200, 50}, col.name, with_px(title_text, 44), in);
            show(f, col.block, crop.times, {x, 342, width, 396}, f.ease(6 + 0.5 * double(k), 6.7 + 0.5 * double(k)));
            const double opacity = f.ease(11.5, 12.1);
            f.text({x, 748, width, 48}, col.highlight, with(with(label_text, highlight_ink), Align::centre), opacity);
            f.text({x, 796, width, 48}, col.surround, with(with(label_text, surround_ink), Align::centre),
                f.ease(14, 14.6));
        }
    };
    return shot;
}

}  // namespace crescent::explainer
