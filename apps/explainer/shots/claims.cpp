// Shot 15: the limits of this run.
#include <algorithm>

#include "drawing.h"
#include "shots.h"

namespace crescent::explainer {

namespace {

std::vector<Words> claims_of(const Data& data) {
    std::vector<Words> out;
    out.push_back(Words("where the noise of these arms goes, in this scene"));
    if (data.experiment.seeds > 1)
        out.push_back(Words("how far it spreads over ",
            count(std::uint64_t(data.experiment.seeds), "seeds of the experiment"), " seeds"));
    out.push_back(Words("errors against a deterministic reference"));
    std::uint64_t total = 0, passes = 0;
    for (const AssertionResult& a : data.metrics.assertions) {
        if (a.text.find("plate_bytes") != std::string::npos) continue;
        ++total;
        passes += a.pass;
    }
    if (total > 0)
        out.push_back(Words(count(passes, "assertions that hold"), " of ", count(total, "assertions on numbers"),
            " assertions on its numbers hold"));
    out.push_back(Words("the same bits from any number of threads"));
    return out;
}

std::vector<Words> limits_of(const Data& data) {
    std::vector<Words> out = {Words("other scenes, lights or materials"), Words("seconds: N counts rays, not time"),
        Words("light that bounces more than once")};
    if (data.experiment.published) out.push_back(Words("the published scene: its sizes are inferred"));
    out.push_back(Words("that the picture looks better"));
    return out;
}

}  // namespace

Shot claims(const Data& data) {
    const std::vector<Words> can = claims_of(data), cannot = limits_of(data);
    Shot shot;
    shot.name = "claims";
    shot.title = Words("What this can claim, and what it cannot");
    shot.description = Words("Two lists, what the run can claim and what it cannot.");
    shot.cues = {{0.5, Words("The integral never changed. Where the rays went decided where the noise went.")},
        {6.5, Words("Cosine rarely finds the small light. Phong rarely leaves its lobe.")}};
    shot.seconds = 13.5;
    shot.still = 12.5;
    shot.draw = [=](Frame& f) {
        const auto list = [&](double x, const Words& heading, const std::vector<Words>& lines, Colour ink,
                              double from) {
            f.text({x, 170, 840, 60}, heading, with(with_px(title_text, 46), ink), f.ease(from, from + 0.5));
            for (std::size_t k = 0; k < lines.size(); ++k) {
                const double y = 270 + 106.0 * double(k),
                             in = f.ease(from + 0.5 + 0.6 * double(k), from + 1 + 0.6 * double(k));
                f.dot({x + 12, y + 30}, 8, ink, in);
                f.text({x + 48, y, 800, 60}, lines[k], label_text, in);
            }
        };
        list(90, Words("It can claim"), can, plates::series[4], 0.5);
        list(1010, Words("It cannot claim"), cannot, plates::series[3], 4.5);
    };
    return shot;
}

}  // namespace crescent::explainer
