// Shot 7: the same sample counts with the density about the mirror direction.
#include "drawing.h"
#include "ladder_shot.h"
#include "shots.h"

namespace crescent::explainer {

Shot ladder_phong(const Data& data) {
    const Cast& c = data.cast;
    const Ladder& l = ladder_of(data, c.phong);
    const Order at_n = order_of(data, data.key(c.cosine), data.key(c.phong), c.highlight);
    const std::string source = "rmse of both arms";
    LadderShotText text;
    text.arm = c.phong;
    text.dimmed_arm = c.cosine;
    text.opening = Words("The same N, the same random numbers, now aimed along the mirror direction.");
    text.closing = {Words("At N\u00a0=\u00a0", data.n_of(at_n.low), " the error of ", data.arm(at_n.low.arm), " is ",
        figure(at_n.high_value / at_n.low_value, 2, source), " times smaller than that of ", data.arm(at_n.high.arm),
        ".")};
    if (l.heavy) text.closing.push_back(Words("But rare huge samples remain: the line bends where one of them falls."));
    Shot shot = ladder_shot(data, text);
    shot.name = "ladder-phong";
    shot.title = Words("The same N, aimed along the mirror direction");
    shot.description =
        Words("The same crops and the same chart for the Phong arm; the line of the cosine arm stays, dim.");
    return shot;
}

}  // namespace crescent::explainer
