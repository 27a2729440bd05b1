// rmse_frame: rmse over the whole frame. It mixes the regions, so reports show it only as a footnote.
#pragma once

#include "render/film_metrics/rmse.h"

namespace crescent::inline render {

struct RmseFrameMetric : RmseMetric {
    static constexpr MetricInfo info = {
        .means = "root mean square error of Y over the whole frame", .label = "whole-frame RMSE", .in_tables = false};
};

}  // namespace crescent::inline render
