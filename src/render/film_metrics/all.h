// The one list of meters: what is read off a film, of every region or of the frame. A new one is one file beside this
// one and one line here; the list feeds what a run measures and keeps, metrics.json and metrics.csv, the quantities
// that a check can name, the spread over seeds, `crescent list meters`, the report and the tests.
//
// meter(name, type)
#pragma once

#include "render/film_metrics/bad.h"
#include "render/film_metrics/fireflies.h"
#include "render/film_metrics/horizon_frac.h"
#include "render/film_metrics/largest.h"
#include "render/film_metrics/rmse.h"
#include "render/film_metrics/rmse_frame.h"
#include "render/film_metrics/var.h"
#include "render/film_metrics/y_mean.h"

// clang-format off: one a line
#define CRESCENT_REGION_METRICS(meter) \
    meter(rmse, RmseMeter)            \
    meter(var, VarMeter)

#define CRESCENT_FRAME_METRICS(meter)       \
    meter(fireflies, FirefliesMeter)       \
    meter(horizon_frac, HorizonFracMeter)  \
    meter(y_mean, YMeanMeter)              \
    meter(rmse_frame, RmseFrameMeter)      \
    meter(largest, LargestMeter)           \
    meter(bad, BadMeter)
// clang-format on
