// rmse_frame: the same over the whole frame, which lumps the regions together: a footnote, never a headline.
#pragma once

#include "render/film_metrics/rmse.h"

namespace crescent::inline render {

struct RmseFrameMetric : RmseMetric {
    static constexpr MetricInfo info = {
        .means = "root mean square error of Y over the whole frame", .label = "whole-frame RMSE", .in_tables = false};
};

}  // namespace crescent::inline render
