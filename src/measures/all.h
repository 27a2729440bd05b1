// The one list of meters: what is read off a film, of every region or of the frame. A new one is one file beside this
// one and one line here; the list feeds what a run measures and keeps, metrics.json and metrics.csv, the quantities
// that a check can name, the spread over seeds, `crescent list meters`, the report and the laws.
//
// meter(name, type)
#pragma once

#include "measures/bad.h"
#include "measures/fireflies.h"
#include "measures/horizon_frac.h"
#include "measures/largest.h"
#include "measures/rmse.h"
#include "measures/rmse_frame.h"
#include "measures/var.h"
#include "measures/y_mean.h"

// clang-format off: one a line
#define CRESCENT_REGION_METERS(meter) \
    meter(rmse, RmseMeter)            \
    meter(var, VarMeter)

#define CRESCENT_FRAME_METERS(meter)       \
    meter(fireflies, FirefliesMeter)       \
    meter(horizon_frac, HorizonFracMeter)  \
    meter(y_mean, YMeanMeter)              \
    meter(rmse_frame, RmseFrameMeter)      \
    meter(largest, LargestMeter)           \
    meter(bad, BadMeter)
// clang-format on
