// Shot 16: the command that regenerates it, the commit, the seed, the hashes.
#include "drawing.h"
#include "shots.h"

namespace crescent::explainer {

Shot closing(const Data& data) {
    const Provenance& p = data.provenance;
    const RunKey key = data.key(data.cast.phong);
    const auto hash = data.metrics.film_hashes.find(to_string(key));
    std::vector<std::pair<Words, Words>> lines = {
        {Words("experiment"), Words(name(p.experiment_file))},
        {Words("its hash"), Words(name(data.experiment_hash))},
        {Words("version, commit"), Words(name(p.version), ", ", name(p.commit))},
        {Words("seed"), Words(name(std::to_string(data.cast.seed)))},
    };
    if (hash != data.metrics.film_hashes.end())
        lines.push_back({Words("film ", name(to_string(key))), Words(name(hash->second))});

    Shot shot;
    shot.name = "closing";
    shot.title = Words("Make it again");
    shot.description = Words(
        "The command that makes the film again, with the experiment, its hash, the commit, the seed and the hash of a "
        "film.");
    shot.cues = {{0.5, Words("Every picture, curve and number came out of this one command.")}};
    shot.seconds = 8;
    shot.still = 7;
    const Words command(name(p.command));
    shot.draw = [=](Frame& f) {
        f.fill({90, 200, 1740, 116}, panel, f.ease(0.3, 0.8));
        f.text({130, 200, 1660, 116}, command,
            Text{50, photograph_accent, Weight::medium, Align::left, Vertical::middle, 1, 28}, f.ease(0.3, 0.8));
        for (std::size_t k = 0; k < lines.size(); ++k) {
            const double y = 384 + 88.0 * double(k), in = f.ease(0.9 + 0.4 * double(k), 1.4 + 0.4 * double(k));
            f.text({130, y, 560, 64}, lines[k].first, with(label_text, muted), in);
            f.text({720, y, 1100, 64}, lines[k].second, label_text, in);
        }
    };
    return shot;
}

}  // namespace crescent::explainer
