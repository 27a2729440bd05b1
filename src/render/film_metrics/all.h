// The list of metrics, computed from a film for every region or for the frame. To add one, add a file in this folder
// and a line here. The list determines what a run measures and stores, metrics.json and metrics.csv, the quantities
// that an assertion can name, the spread over seeds, `crescent list metrics`, the report and the tests.
//
// metric(name, type)
#pragma once

#include "render/film_metrics/bad.h"
#include "render/film_metrics/bias_sq.h"
#include "render/film_metrics/f_evaluations.h"
#include "render/film_metrics/fireflies.h"
#include "render/film_metrics/horizon_frac.h"
#include "render/film_metrics/largest.h"
#include "render/film_metrics/rays.h"
#include "render/film_metrics/rel_mse.h"
#include "render/film_metrics/rmse.h"
#include "render/film_metrics/rmse_frame.h"
#include "render/film_metrics/smape.h"
#include "render/film_metrics/var.h"
#include "render/film_metrics/y_mean.h"

// clang-format off: one a line
#define CRESCENT_REGION_METRICS(metric) \
    metric(rmse, RmseMetric)            \
    metric(var, VarMetric)              \
    metric(rel_mse, RelMseMetric)       \
    metric(smape, SmapeMetric)          \
    metric(bias_sq, BiasSqMetric)

#define CRESCENT_FRAME_METRICS(metric)       \
    metric(fireflies, FirefliesMetric)       \
    metric(horizon_frac, HorizonFracMetric)  \
    metric(y_mean, YMeanMetric)              \
    metric(rmse_frame, RmseFrameMetric)      \
    metric(largest, LargestMetric)           \
    metric(bad, BadMetric)                   \
    metric(rays, RaysMetric)                 \
    metric(f_evaluations, FEvaluationsMetric)
// clang-format on
