// The public interface of crescent: front ends and other programs include only this file.
//
//   load, parse       an experiment file or text -> Experiment; InputError names every mistake with its place
//   Scene             an Experiment -> what a pixel sees: surface point, normal, BRDF, lights, what blocks them
//   Samplers          the built-in samplers as a list of types; for_each_sampler visits each
//   estimate_films    Scene + sampler -> films: per pixel the moments of n samples, one film per sample count
//   OpenPixel         one pixel of a scene -> the parts of each of its samples: direction, density, f, L, cosine, X
//   check_sampler     a sampler -> ordered verdicts with their evidence; crescent/gtest.h has the matchers
//   find_backend      another back end for films, if the program registered one
//   film_maker        makes an explainer video of a run, if the program registered it
//   plan, prepare, execute, collect, write
//                     the steps of a run, each alone and in memory: an Experiment -> jobs -> films and metrics -> every
//                     number -> a folder; a stop is returned as a value, see run/execute.h
//   join              runs of parts of an experiment's seeds -> the metrics of all of them
//   open_run          a metrics.json and the plates beside it -> the run, for its page
//   measure_in_memory an Experiment -> films, metrics and article checks, nothing written
//   compare           renders of other programs -> metrics, bias tests, plates and report under one folder
//   run               an Experiment -> films, metrics, plates and report under one folder
//
// Lengths in m, radiance in W/(sr m^2) of linear Rec.709, angles in degrees if a name says so. InputError is a mistake
// in the input, OutputError a missing part or a failed write, Interrupted a requested stop, Bug a defect of crescent.
#pragma once

#include "base/counted.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/input.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/process.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "check/against.h"
#include "check/check.h"
#include "check/numbers/expression.h"
#include "check/numbers/number_check.h"
#include "check/report/describe.h"
#include "check/report/html.h"
#include "check/report/print.h"
#include "check/report/result_json.h"
#include "check/report/screen.h"
#include "check/report/summary.h"
#include "check/sources/cases.h"
#include "check/sources/external.h"
#include "check/sources/neighbours.h"
#include "check/sources/pipe.h"
#include "check/sources/plugin.h"
#include "check/sources/point_file.h"
#include "check/sources/random_numbers.h"
#include "check/sources/sample_file.h"
#include "check/sources/shader.h"
#include "check/user.h"
#include "check/verdict.h"
#include "check/waivers.h"
#include "compare/compare.h"
#include "compare/outputs.h"
#include "compare/page.h"
#include "compare/renders.h"
#include "compare/suite/accept.h"
#include "compare/suite/decide.h"
#include "compare/suite/measure.h"
#include "compare/suite/render_plan.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_file.h"
#include "compare/suite/suite_outputs.h"
#include "compare/suite/until.h"
#include "experiment/assertion.h"
#include "experiment/combinations.h"
#include "experiment/experiment.h"
#include "experiment/identity.h"
#include "experiment/input_files.h"
#include "experiment/json_schema.h"
#include "experiment/model_experiment.h"
#include "experiment/overrides.h"
#include "experiment/schema.h"
#include "experiment/schema_table.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "math/statistics.h"
#include "metrics/article_checks.h"
#include "metrics/assertions.h"
#include "metrics/flip.h"
#include "metrics/metrics.h"
#include "metrics/monte_carlo_reference.h"
#include "output/charts.h"
#include "output/junit.h"
#include "output/report_formats.h"
#include "output/stored_json.h"
#include "output/tone_map.h"
#include "render/estimator.h"
#include "render/exr.h"
#include "render/film.h"
#include "render/kernel.h"
#include "render/pixel.h"
#include "render/reference/reference.h"
#include "report/plates/canvas.h"
#include "report/plates/charts.h"
#include "report/plates/plates.h"
#include "report/plates/raster.h"
#include "report/plates/sheet.h"
#include "report/report.h"
#include "run/arm_cases.h"
#include "run/backend.h"
#include "run/collect.h"
#include "run/execute.h"
#include "run/external_samplers.h"
#include "run/join.h"
#include "run/run.h"
#include "run/stored_run.h"
#include "run/version.h"
#include "run/write.h"
#include "samplers/all.h"
#include "samplers/batch_sampler.h"
#include "scene/scene.h"
#include "scene/shadow.h"
#include "scene/texture.h"
