// Shot 8: the error as a map around the highlight, cosine next to Phong, one shared scale.
#include <algorithm>

#include "drawing.h"
#include "shots.h"

namespace crescent::explainer {

namespace {

struct Map {
    Block block;
    Words name, above;
    Colour ink;
    double part = 0;  // of the pixels above the scale
};

/// Returns the residual below which 98 % of the pixels of both maps lie.
double top_of_scale(const Data& data, const Box& crop) {
    std::vector<double> pooled;
    for (const std::string& arm : {data.cast.cosine, data.cast.phong}) {
        const std::vector<double> values = residuals(*data.film(data.key(arm)), data.reference(), crop);
        pooled.insert(pooled.end(), values.begin(), values.end());
    }
    return std::max(quantile(pooled, 0.98), 1e-12);
}

std::vector<Map> maps_of(const Data& data, const Box& crop, double top) {
    std::vector<Map> maps;
    for (const std::string& arm : {data.cast.cosine, data.cast.phong}) {
        const Film& film = *data.film(data.key(arm));
        const std::vector<double> values = residuals(film, data.reference(), crop);
        const double part =
            double(std::ranges::count_if(values, [top](double v) { return v > top; })) / double(values.size());
        maps.push_back({residual_of(film, data.reference(), crop, top),
            Words(data.arm(arm), ", N\u00a0=\u00a0", data.n_of(data.key(arm))),
            Words(percent(part, 2, "residuals of " + arm), " of the pixels above the scale"), data.ink(arm), part});
    }
    return maps;
}

}  // namespace

Shot heat(const Data& data) {
    const Cast& c = data.cast;
    const Closeup close = close_up(data, data.box(c.highlight), {0, 0, 784, 624}, 3.6);
    const Box crop = close.box;
    const double top = top_of_scale(data, crop);
    const std::vector<Map> maps = maps_of(data, crop, top);
    const Box box_h = data.box(c.highlight);
    const Order h = order_of(data, data.key(c.cosine), data.key(c.phong), c.highlight);
    std::vector<Words> ticks;
    for (int k = 0; k <= 4; ++k) ticks.push_back(Words(number(top * k / 4, 2, "scale of the map")));
    Block bar(1, 128);
    for (int j = 0; j < 128; ++j) bar.set(0, j, turbo(1 - j / 127.0));

    Shot shot;
    shot.name = "heat";
    shot.title = Words("Where the error sits");
    shot.kind = Kind::backend;
    shot.description = Words(
        "Two maps of the same crop around the highlight: how far each pixel of luminance is from the reference, blue "
        "for little, red for much, "
        "on one scale; first for the cosine arm, then for the Phong arm.");
    shot.cues = {{0.5, Words("How far each pixel is from the reference: blue is little, red is much.")},
        {7,
            maps[1].part < maps[0].part
                ? Words("Now aimed along the mirror direction, on the same scale: the heat leaves.")
                : Words("Now aimed along the mirror direction, on the same scale.")},
        {11.5,
            Words("Off by ", data.rmse(h.low, c.highlight), " inside the frame with ", data.arm(h.low.arm), ", by ",
                data.rmse(h.high, c.highlight), " with ", data.arm(h.high.arm), ".")}};
    shot.seconds = 17;
    shot.still = 16;
    shot.draw = [=](Frame& f) {
        for (std::size_t k = 0; k < maps.size(); ++k) {
            const double in = k == 0 ? f.ease(0.3, 1) : f.ease(7.2, 8);
            const Rect r = show(f, maps[k].block, close.times, {70 + 824.0 * double(k), 182, 784, 624}, in);
            f.text({70 + 824.0 * double(k), 122, 784, 50}, maps[k].name,
                with(with(title_text, maps[k].ink), Align::centre), in);
            f.text({70 + 824.0 * double(k), r.bottom() + 12, 784, 48}, maps[k].above,
                with(with(body_text, Vertical::middle), Align::centre), k == 0 ? f.ease(4, 4.6) : f.ease(9, 9.6));
            mark(f, explainer::on_picture(r, crop, box_h), bright, f.ease(12.3, 12.8));
        }
        const double scale = f.ease(2, 2.6);
        const double x = 1722, y = 250, h_bar = 512;
        f.field(bar, x, y, 4, scale);
        for (int k = 1; k < 9; ++k) f.field(bar, x + 4 * k, y, 4, scale);
        for (std::size_t k = 0; k < ticks.size(); ++k)
            f.text({x + 44, y + h_bar * (1 - double(k) / 4) - 20, 110, 40}, ticks[k], small_text, scale);
        f.text({x - 20, y - 66, 160, 48}, Words("|Y − Y<sub>ref</sub>|"), small_text, scale);
    };
    return shot;
}

}  // namespace crescent::explainer
