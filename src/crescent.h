// The public face of crescent. Doors and programs of others include this file and nothing else of src/.
//
//   load, parse       an experiment file or text -> Experiment; InputError names every mistake with its place
//   Scene             an Experiment -> what a pixel sees: surface point, normal, BRDF, lights, what blocks them
//   Arms              the samplers on trial as a list of types; for_each_arm walks it
//   estimate_films    Scene + arm -> films: per pixel the moments of n samples, one film a rung
//   OpenPixel         one pixel of a scene -> each of its samples taken apart: direction, density, f, L, cosine, X
//   judge             a sampler by itself -> ordered verdicts with their evidence; check/gtest.h has the matchers
//   find_instrument   what else can compute films, where a door has brought it
//   film_maker        what makes an explainer of a run, where a door has brought it
//   plan, prepare, execute, collect, write
//                     the steps of a run, each alone and in memory: an Experiment -> jobs -> films and meters -> every
//                     number -> a folder; a stop is an answer, see run/execute.h
//   join              runs of parts of an experiment's seeds -> the metrics of all of them
//   measure_in_memory an Experiment -> films, meters and evidence, nothing written
//   compare           renders of other programs -> meters, bias tests, plates and report under one folder
//   run               an Experiment -> films, meters, plates and report under one folder
//
// Lengths in m, radiance in W/(sr m^2) of linear Rec.709, angles in degrees where a name says so. InputError is the
// reader's mistake, OutputError something missing or not writable, Interrupted a stop that was asked for, Bug ours.
#pragma once

#include "arms/all.h"
#include "base/contents.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/hint.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/polled_monitor.h"
#include "base/process.h"
#include "base/progress_monitor.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "check/against.h"
#include "check/check.h"
#include "check/report/describe.h"
#include "check/user.h"
#include "color/turbo.h"
#include "compare/compare.h"
#include "compare/rates.h"
#include "estimator/estimator.h"
#include "estimator/kernel.h"
#include "estimator/pixel.h"
#include "experiment/experiment.h"
#include "experiment/light_tables.h"
#include "experiment/names.h"
#include "experiment/quantity_text.h"
#include "experiment/schema.h"
#include "film_maker.h"
#include "films/exr.h"
#include "films/film.h"
#include "judgements/all.h"
#include "judgements/print.h"
#include "judgements/waivers.h"
#include "math/functions.h"
#include "meters/meters.h"
#include "meters/metrics.h"
#include "meters/quantity.h"
#include "pages/charts.h"
#include "plates/canvas.h"
#include "plates/density.h"
#include "plates/plates.h"
#include "plates/raster.h"
#include "plates/style.h"
#include "plates/words.h"
#include "reference/reference.h"
#include "report/report.h"
#include "run/join.h"
#include "run/preview.h"
#include "run/run.h"
#include "run/version.h"
#include "scene/scene.h"
#include "scene/shadow.h"
#include "simd/random.h"
#include "stats/quantiles.h"
#include "stats/rates.h"
#include "stats/tail.h"
#include "studies/evidence.h"
#include "studies/monte_carlo_reference.h"
#include "subjects/list.h"
#include "subjects/pipe.h"
#include "subjects/plugin.h"
#include "subjects/samples.h"
