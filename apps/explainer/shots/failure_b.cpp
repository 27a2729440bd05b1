// Shot 9: Failure B. Why not aim at the mirror direction everywhere; the surround enlarged; the mean of the frame.
#include <algorithm>

#include "drawing.h"
#include "shots.h"

namespace crescent::explainer {

namespace {

constexpr Rect whole_slot{480, 230, 960, 540};

double mean_of(const std::vector<float>& y) {
    double sum = 0;
    for (const float v : y) sum += v;
    return sum / double(y.size());
}

struct Bar {
    Words name, value;
    double part = 0;  // of the longest
    Colour ink;
};

std::vector<Bar> bars_of(const Data& data) {
    const Cast& c = data.cast;
    const double reference = mean_of(data.reference().y);
    std::vector<std::pair<Bar, double>> bars;
    bars.push_back(
        {{Words("reference"), Words(figure(reference, 3, "mean Y of the reference")), 0, bright}, reference});
    for (const std::string& arm : {c.cosine, c.phong}) {
        const RunKey key = data.key(arm);
        const double mean = data.metric(key)->y_mean;
        bars.push_back(
            {{Words(data.arm(arm)), Words(figure(mean, 3, "y_mean of " + to_string(key))), 0, data.ink(arm)}, mean});
    }
    double largest = 0;
    for (const auto& [bar, value] : bars) largest = std::max(largest, value);
    std::vector<Bar> out;
    for (auto& [bar, value] : bars) {
        bar.part = largest > 0 ? value / largest : 0;
        out.push_back(bar);
    }
    return out;
}

void draw_bars(Frame& f, const std::vector<Bar>& bars, double opacity) {
    for (std::size_t k = 0; k < bars.size(); ++k) {
        const double y = 730 + 54.0 * double(k), growth = f.ease(21.6 + 0.6 * double(k), 22.6 + 0.6 * double(k));
        f.text({90, y, 300, 44}, bars[k].name, with(label_text, bars[k].ink), opacity);
        f.fill({400, y + 6, 1150 * bars[k].part * growth, 32}, bars[k].ink, opacity);
        f.text({1600, y, 200, 44}, bars[k].value, label_text,
            opacity * f.ease(22.4 + 0.6 * double(k), 22.8 + 0.6 * double(k)));
    }
}

bool is_starved(const Data& data) {
    const Cast& c = data.cast;
    return order_of(data, data.key(c.cosine), data.key(c.phong), c.surround).high.arm == c.phong;
}

std::vector<Cue> cues_of(const Data& data) {
    const Cast& c = data.cast;
    const Order h = order_of(data, data.key(c.cosine), data.key(c.phong), c.highlight);
    const double reference = mean_of(data.reference().y), phong = data.metric(data.key(c.phong))->y_mean;
    const bool starved = is_starved(data);
    return {
        {0.5,
            h.low.arm == c.phong ? Words("It wins the highlight. So why not aim along the mirror direction everywhere?")
                                 : Words("And if every pixel is aimed along the mirror direction?"),
            true},
        {10.5, Words("Plinth and floor are matt: they gather light from the whole hemisphere.")},
        {16,
            starved ? Words("A lobe around one direction leaves the rest to rare, huge samples: specks.")
                    : Words("Here the lobe does no worse than the cosine, at this seed.")},
        {21.5,
            phong < 0.9 * reference
                ? Words("And the whole picture is too dark: ",
                      percent(1 - phong / reference, 2, "y_mean and reference"), " of its light is missing.")
                : Words("The mean of the frame is close to the reference, at this seed.")}};
}

}  // namespace

Shot failure_b(const Data& data) {
    const Cast& c = data.cast;
    const Closeup overview = whole_or_part(data, whole_slot),
                  crop = close_up(data, data.box(c.surround), {0, 0, 840, 552}, 0.98);
    const Block picture = photograph_of(data, plates::view(data.film(data.key(c.phong))), overview.box);
    const std::vector<std::string> arms = {c.cosine, c.phong};
    std::vector<Block> blocks;
    std::vector<Words> names, errors;
    std::vector<Colour> inks;
    for (const std::string& arm : arms) {
        const RunKey key = data.key(arm);
        blocks.push_back(photograph_of(data, plates::view(data.film(key)), crop.box));
        names.push_back(Words(data.arm(arm), ", N\u00a0=\u00a0", data.n_of(key)));
        errors.push_back(Words("RMSE, surround: ", data.rmse(key, c.surround)));
        inks.push_back(data.ink(arm));
    }
    const std::vector<Bar> bars = bars_of(data);
    const bool starved = is_starved(data);

    Shot shot;
    shot.name = "failure-b";
    shot.kind = Kind::photograph;
    shot.title = starved ? Words("Failure B: Phong starves the surround") : Words("The surround, both ways");
    shot.description = Words(
        "The whole picture by the Phong arm. Then the surround enlarged, cosine next to Phong; then the mean of the "
        "frame as bars: "
        "reference, cosine, Phong.");
    shot.cues = cues_of(data);
    shot.seconds = 27.5;
    shot.still = 26.5;
    shot.draw = [=](Frame& f) {
        const double overview_opacity = f.ease(0.2, 0.9) * (1 - f.ease(9.8, 10.3)), pair_opacity = f.ease(10.4, 11.1);
        if (overview_opacity > 0) show(f, picture, overview.times, whole_slot, overview_opacity);
        const double bars_opacity = f.ease(20.9, 21.5);
        for (std::size_t k = 0; k < blocks.size() && pair_opacity > 0; ++k) {
            const double x = 90 + 900.0 * double(k);
            f.text({x, 112, 840, 46}, names[k], with(with(title_text, inks[k]), Align::centre), pair_opacity);
            show(f, blocks[k], crop.times, {x, 162, 840, 552}, pair_opacity);
            f.text({x, 720, 840, 44}, errors[k], with(with(body_text, Vertical::middle), Align::centre),
                f.ease(16, 16.6) * (1 - bars_opacity));
        }
        if (bars_opacity > 0) draw_bars(f, bars, bars_opacity);
    };
    return shot;
}

}  // namespace crescent::explainer
