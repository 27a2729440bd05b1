// Shot 6: Failure A. The cosine arm at rising sample counts: fireflies remain in the highlight, and the error falls
// along a line.
#include "ladder_shot.h"
#include "shots.h"

namespace crescent::explainer {

Shot ladder_cosine(const Data& data) {
    const Cast& c = data.cast;
    const Ladder& l = ladder_of(data, c.cosine);
    const RunKey low = data.key(c.cosine, l.n.front()), high = data.key(c.cosine, l.n.back());
    const std::string source = "ladder of " + c.cosine;
    const double ray_ratio = double(high.n) / double(low.n), error_ratio = l.rmse.front() / l.rmse.back();
    LadderShotText text;
    text.arm = c.cosine;
    text.opening = Words("Failure A. Aim by the cosine, and watch the highlight as rays are added.");
    text.closing = {Words(number(ray_ratio, 4, source), " times the rays, and the error falls ",
                        figure(error_ratio, 3, source), " times."),
        l.slope < -0.35 && l.slope > -0.65
            ? Words("It falls like one over the root of N. To halve it you need four times the rays.")
            : Words("Its slope here is ", figure(l.slope, 3, source), "; independent samples give minus a half.")};
    Shot shot = ladder_shot(data, text);
    shot.name = "ladder-cosine";
    shot.title = Words("Failure A: cosine, and the highlight sparkles");
    shot.description = Words(
        "The highlight enlarged at four values of N, and the error against N on two logarithmic axes, point "
        "by point.");
    return shot;
}

}  // namespace crescent::explainer
