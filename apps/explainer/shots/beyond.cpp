// Shot 14: both densities combined, and also the light: the gain in both regions, and the cost in rays.
#include "drawing.h"
#include "shots.h"

namespace crescent::explainer {

namespace {

struct Column {
    Block block;
    Words name, highlight, surround;
};

}  // namespace

Shot beyond(const Data& data) {
    const Cast& c = data.cast;
    const Closeup crop = whole_or_part(data, {0, 0, 426, 470});
    std::vector<Column> cols;
    for (const std::string& arm : {c.cosine, c.phong, c.mixture, c.mis}) {
        const RunKey key = data.key(arm);
        cols.push_back({photograph_of(data, plates::view(data.film(key)), crop.box), Words(data.arm(arm)),
            Words(data.rmse(key, c.highlight)), Words(data.rmse(key, c.surround))});
    }
    const RunKey mis = data.key(c.mis), half = data.key(c.mis, c.n > 1 ? c.n / 2 : c.n);
    const Order h = order_of(data, data.key(c.cosine), data.key(c.phong), c.highlight);
    const Order s = order_of(data, data.key(c.cosine), data.key(c.phong), c.surround);
    const double mix_h = data.region(data.key(c.mixture), c.highlight)->rmse,
                 mix_s = data.region(data.key(c.mixture), c.surround)->rmse;
    const bool improves_both = mix_h < h.high_value && mix_s < s.high_value;

    Shot shot;
    shot.name = "beyond";
    shot.title = Words("Both at once");
    shot.kind = Kind::photograph;
    shot.description = Words(
        "Four columns of one view: cosine, Phong, their mixture, and multiple importance sampling with the light; "
        "under each its error in both regions.");
    shot.cues = {{0.5, Words("Two ways of aiming, each with its own failure. Can one estimator have both?"), true},
        {10,
            improves_both ? Words("Toss a coin between both lobes and divide by the mixture: neither is undersampled.")
                          : Words("Toss a coin between both lobes and divide by the mixture of both densities.")},
        {15.8, Words("Aim at the light too, and weigh both kinds of ray: multiple importance sampling.")},
        {21.4,
            Words("It costs two rays a sample. At half the N, as many rays: ", data.rmse(half, c.highlight), " and ",
                data.rmse(half, c.surround), ".")}};
    shot.seconds = 27;
    shot.still = 26;
    shot.draw = [=](Frame& f) {
        const double starts[] = {0.4, 0.4, 10, 15.8};
        for (std::size_t k = 0; k < cols.size(); ++k) {
            const Column& col = cols[k];
            const double x = 60 + 458.0 * double(k), in = f.ease(starts[k], starts[k] + 0.7),
                         shown = f.ease(starts[k] + 1.2, starts[k] + 1.8);
            f.text({x, 112, 426, 50}, col.name, with(title_text, Align::centre), in);
            show(f, col.block, crop.times, {x, 170, 426, 470}, in);
            f.text({x, 652, 426, 64}, col.highlight, with(with_px(number_text, 50), highlight_ink), shown);
            f.text({x, 714, 426, 36}, Words("RMSE, highlight"), with(small_text, Align::centre), shown);
            f.text({x, 752, 426, 64}, col.surround, with(with_px(number_text, 50), surround_ink), shown);
            f.text({x, 814, 426, 36}, Words("RMSE, surround"), with(small_text, Align::centre), shown);
        }
    };
    return shot;
}

}  // namespace crescent::explainer
