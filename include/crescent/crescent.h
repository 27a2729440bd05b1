// The public face of crescent. Doors and programs of others include this file and nothing else of src/.
//
//   load, parse       an experiment file or text -> Experiment; InputError names every mistake with its place
//   Scene             an Experiment -> what a pixel sees: surface point, normal, BRDF, lights, what blocks them
//   Arms              the samplers on case as a list of types; for_each_sampler walks it
//   estimate_films    Scene + arm -> films: per pixel the moments of n samples, one film a sample count
//   OpenPixel         one pixel of a scene -> each of its samples taken apart: direction, density, f, L, cosine, X
//   judge             a sampler by itself -> ordered verdicts with their evidence; check/gtest.h has the matchers
//   find_backend   what else can compute films, where a door has brought it
//   film_maker        what makes an explainer of a run, where a door has brought it
//   plan, prepare, execute, collect, write
//                     the steps of a run, each alone and in memory: an Experiment -> jobs -> films and metrics -> every
//                     number -> a folder; a stop is an answer, see run/execute.h
//   join              runs of parts of an experiment's seeds -> the metrics of all of them
//   measure_in_memory an Experiment -> films, metrics and evidence, nothing written
//   compare           renders of other programs -> metrics, bias tests, plates and report under one folder
//   run               an Experiment -> films, metrics, plates and report under one folder
//
// Lengths in m, radiance in W/(sr m^2) of linear Rec.709, angles in degrees where a name says so. InputError is the
// reader's mistake, OutputError something missing or not writable, Interrupted a stop that was asked for, Bug ours.
#pragma once

#include "base/errors.h"
#include "base/files.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/process.h"
#include "base/progress.h"
#include "base/text.h"
#include "check/against.h"
#include "check/check.h"
#include "check/report/describe.h"
#include "check/report/print.h"
#include "check/sources/cases.h"
#include "check/sources/pipe.h"
#include "check/sources/plugin.h"
#include "check/sources/python_sampler.h"
#include "check/sources/sample_file.h"
#include "check/user.h"
#include "check/verdict_names.h"
#include "check/waivers.h"
#include "compare/compare.h"
#include "compare/synthetic.h"
#include "experiment/assertion.h"
#include "experiment/experiment.h"
#include "experiment/queries.h"
#include "experiment/sampler_files.h"
#include "experiment/schema.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "math/statistics.h"
#include "math/tail.h"
#include "metrics/article_checks.h"
#include "metrics/assertions.h"
#include "metrics/compute.h"
#include "metrics/metrics.h"
#include "metrics/monte_carlo_reference.h"
#include "output/charts.h"
#include "output/color_map.h"
#include "render/estimator.h"
#include "render/exr.h"
#include "render/film.h"
#include "render/kernel.h"
#include "render/pixel.h"
#include "render/reference/reference.h"
#include "report/plates/canvas.h"
#include "report/plates/plates.h"
#include "report/plates/polar.h"
#include "report/plates/raster.h"
#include "report/plates/sheet.h"
#include "report/report.h"
#include "run/backend.h"
#include "run/join.h"
#include "run/preview.h"
#include "run/run.h"
#include "run/version.h"
#include "samplers/all.h"
#include "scene/scene.h"
#include "scene/shadow.h"
