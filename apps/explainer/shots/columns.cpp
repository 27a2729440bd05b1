// Shot 2: the converged picture with both regions, the question, then three columns that differ only in the density,
// and the error of each in both regions.
#include "drawing.h"
#include "shots.h"

namespace crescent::explainer {

namespace {

constexpr Rect whole_slot{480, 200, 960, 540};

struct Column {
    Block block;
    Words name, density, highlight, surround;
    Colour ink;
};

std::vector<Column> columns_of(const Data& data, const Box& crop) {
    const Cast& c = data.cast;
    std::vector<Column> out;
    for (const std::string& arm : {c.uniform, c.cosine, c.phong}) {
        if (arm.empty()) continue;
        RunKey key = data.key(arm);
        if (!data.film(key)) key.n = data.experiment.find_arm(arm)->n.back();
        Words name(data.arm(arm));
        if (key.n != c.n) name << ", N\u00a0=\u00a0" << data.n_of(key);
        out.push_back({photograph_of(data, plates::view(data.film(key)), crop), name,
            Words(Number{plates::density_formula(arm, data.experiment), "density of " + arm}),
            Words(data.rmse(key, c.highlight)), Words(data.rmse(key, c.surround)), data.ink(arm)});
    }
    return out;
}

/// "the other way round" only if it is.
Words second_answer(const Data& data, const Order& h, const Order& s) {
    const Cast& c = data.cast;
    const bool is_reversed = h.low.arm != s.low.arm;
    return Words(
        is_reversed ? "In the surround it is the other way round: " : "In the surround too: ", data.arm(s.low.arm), " ",
        data.rmse(s.low, c.surround), ", ", data.arm(s.high.arm), " ", data.rmse(s.high, c.surround), ".");
}

std::vector<Cue> cues_of(const Data& data) {
    const Cast& c = data.cast;
    const Order h = order_of(data, data.key(c.cosine), data.key(c.phong), c.highlight);
    const Order s = order_of(data, data.key(c.cosine), data.key(c.phong), c.surround);
    return {{0.6, Words("One scene. A small bright key light, a dim even fill, and a glossy ball.")},
        {5.4,
            Words("Each pixel gets N\u00a0=\u00a0", data.n_of(data.key(c.cosine)),
                " rays, in one of three ways of aiming.")},
        {10, Words("Same light, same N: which will sparkle here, and which there?"), true},
        {18, Words("Only the density p differs: where the rays go. The random numbers are the same.")},
        {23.5,
            Words("In the highlight, ", data.arm(h.low.arm), " is off by ", data.rmse(h.low, c.highlight), " and ",
                data.arm(h.high.arm), " by ", data.rmse(h.high, c.highlight), ".")},
        {29, second_answer(data, h, s)}};
}

}  // namespace

Shot columns(const Data& data) {
    const Cast& c = data.cast;
    const Closeup overview = whole_or_part(data, whole_slot), crop = whole_or_part(data, {0, 0, 580, 500});
    const Block picture = photograph_of(data, plates::view(&data.reference()), overview.box);
    const std::vector<Column> cols = columns_of(data, crop.box);
    const Box box_h = data.box(c.highlight), box_s = data.box(c.surround);

    Shot shot;
    shot.name = "columns";
    shot.title = Words("Same light, same N");
    shot.kind = Kind::photograph;
    shot.description = Words(
        "The converged picture with two regions outlined, the highlight and the surround. Then three columns of the "
        "same view, aimed three ways; under each its error in both regions.");
    shot.cues = cues_of(data);
    shot.seconds = 35;
    shot.still = 34;
    shot.draw = [=](Frame& f) {
        const double overview_opacity = 1 - f.ease(17.2, 17.7), columns_opacity = f.ease(17.8, 18.5);
        if (overview_opacity > 0) {
            const Rect r = show(f, picture, overview.times, whole_slot, overview_opacity * f.ease(0.2, 0.9));
            mark(
                f, explainer::on_picture(r, overview.box, box_h), highlight_ink, overview_opacity * f.ease(10.6, 11.1));
            mark(f, explainer::on_picture(r, overview.box, box_s), surround_ink, overview_opacity * f.ease(12, 12.5));
            const Rect h_rect = explainer::on_picture(r, overview.box, box_h),
                       s_rect = explainer::on_picture(r, overview.box, box_s);
            tag(f, {h_rect.right() + 14, h_rect.bottom()}, Words("here"), highlight_ink,
                overview_opacity * f.ease(10.6, 11.1));
            tag(f, {s_rect.right() + 14, s_rect.bottom()}, Words("there"), surround_ink,
                overview_opacity * f.ease(12, 12.5));
        }
        const double w = 580, gap = 30, total = w * double(cols.size()) + gap * double(cols.size() - 1),
                     x0 = (sheet_width - total) / 2;
        for (std::size_t k = 0; k < cols.size() && columns_opacity > 0; ++k) {
            const Column& col = cols[k];
            const Rect column = column_of(x0, w, gap, k);
            const double in = f.ease(17.8 + 0.5 * double(k), 18.5 + 0.5 * double(k));
            f.text({column.x, 112, w, 50}, col.name, with(with(title_text, col.ink), Align::centre), in);
            const Rect r = show(f, col.block, crop.times, {column.x, 170, w, 500}, in);
            const double lit_h = f.ease(23.5, 24), lit_s = f.ease(29, 29.5);
            mark(f, explainer::on_picture(r, crop.box, box_h), highlight_ink, lit_h);
            f.text({column.x, 684, w, 46}, col.density,
                with(with(with_px(body_text, 34), Align::centre), Vertical::middle), in * (1 - lit_h));
            f.text({column.x, 684, w, 72}, Words(col.highlight), with(number_text, highlight_ink), lit_h);
            f.text({column.x, 756, w, 40}, Words("RMSE, highlight"), with(small_text, Align::centre), lit_h);
            f.text({column.x, 796, w, 62}, Words(col.surround), with(with_px(number_text, 46), surround_ink), lit_s);
            f.text({column.x, 856, w, 40}, Words("RMSE, surround"), with(small_text, Align::centre), lit_s);
        }
    };
    return shot;
}

}  // namespace crescent::explainer
