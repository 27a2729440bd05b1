// Shot 1: the gallery at one doubling of N after another, then its converged reference; the title.
#include "drawing.h"
#include "shots.h"
#include "timeline.h"

namespace crescent::explainer {

namespace {

constexpr double first = 1.0, interval = 0.7;  // s: when the first film appears, and the duration of each
constexpr Rect slot{480, 300, 960, 540};

}  // namespace

Shot title(const Data& data) {
    const Cast& cast = data.cast;
    std::vector<Block> blocks;
    std::vector<Words> labels;
    const Closeup part = whole_or_part(data, slot);
    const auto add = [&](const plates::View& view, Words label) {
        blocks.push_back(photograph_of(data, view, part.box));
        labels.push_back(std::move(label));
    };
    for (const Film& film : data.opening) {
        const RunKey key = data.key(cast.cosine, film.n);
        add(plates::view(&film), Words(data.arm(cast.cosine), ", N\u00a0=\u00a0", data.n_of(key)));
    }
    add(plates::view(&data.reference()), Words("converged reference"));

    const Words subtitle("one integral, two ways of aiming, one N");
    const double last = first + interval * double(blocks.size() - 1);
    Shot shot;
    shot.name = "title";
    shot.title = length(data.experiment.title) > 50 ? Words("The experiment") : Words(name(data.experiment.title));
    shot.kind = Kind::photograph;
    shot.description =
        Words("A lacquer sphere on a plinth comes out of noise as the number of samples doubles; then the title.");
    shot.seconds = last + 6.5;
    shot.still = shot.seconds - 1.5;
    shot.cues = {{0.5, Words("A picture is computed by aiming rays at random.")},
        {last - 1.5, Words("More rays, less noise. But how they are aimed decides where the noise goes.")}};
    shot.draw = [=](Frame& f) {
        const int n = static_cast<int>(blocks.size());
        const int k = f.after(first) ? std::min(f.steps(first, first + interval * n, n), n - 1) : 0;
        const Block& block = blocks[std::size_t(k)];
        const double in = f.ease(0, 0.8);
        const Rect r = show(f, block, part.times, slot, in);
        f.text({slot.x, r.bottom() + 10, slot.w, 48}, labels[std::size_t(k)],
            with(with(label_text, muted), Align::right), in);
        f.text({60, 120, sheet_width - 120, 110}, Words("Where the noise goes"), with(big_text, Align::centre),
            f.ease(last, last + 0.8));
        f.text({60, 226, sheet_width - 120, 54}, subtitle, with(with(label_text, muted), Align::centre),
            f.ease(last + 0.6, last + 1.4));
    };
    return shot;
}

}  // namespace crescent::explainer
