// One arm at rising sample counts: four crops of the highlight and a chart that grows point by point. Used by two
// shots.
#pragma once

#include "data.h"
#include "shots.h"

namespace crescent::explainer {

struct LadderShotText {
    std::string arm, dimmed_arm;  // `dimmed_arm`: the arm whose line is already shown, dimmed; "": none
    Words opening;                // said first
    std::vector<Words> closing;   // said when the line is complete
};

/// Returns pictures, chart and times; the caller sets name, title and description.
Shot ladder_shot(const Data& data, const LadderShotText& text);

/// Returns the ladder of an arm in the highlight.
const Ladder& ladder_of(const Data& data, const std::string& arm);
/// Returns "slope -0.50 (-0.53 to -0.47)"; if the interval is not meaningful, the reason.
Words slope_words(const Ladder& ladder);

}  // namespace crescent::explainer
