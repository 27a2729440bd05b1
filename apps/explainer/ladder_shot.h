// One arm up its ladder: four crops of the highlight and a chart that grows point by point. Two shots are made of it.
#pragma once

#include "data.h"
#include "shots.h"

namespace crescent::explainer {

struct LadderStory {
    std::string arm, before;   // `before`: the arm whose line stands there already, dim; "": none
    Words opening;             // said first
    std::vector<Words> after;  // said when the line stands
};

/// Pictures, chart and times; name, title and what is seen are the caller's.
Shot ladder_shot(const Data& data, const LadderStory& story);

/// The ladder of an arm in the highlight.
const Ladder& ladder_of(const Data& data, const std::string& arm);
/// "slope -0.50 (-0.53 to -0.47)"; where the interval means nothing, why.
Words slope_words(const Ladder& ladder);

}  // namespace crescent::explainer
