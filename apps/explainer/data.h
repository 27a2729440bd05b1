// Everything the video shows, measured in this run; no number is hard-coded.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cast.h"
#include "words.h"

namespace crescent::explainer {

struct Measures;  // measures/measures.h

struct Data {
    Experiment experiment;        // with the arms that the video adds
    std::string experiment_hash;  // of the experiment as it was given
    Cast cast;
    Metrics metrics;
    Evidence evidence;
    Provenance provenance;
    ShapeMap shapes;
    std::vector<std::pair<RunKey, Film>> films;
    std::vector<ReferenceFilm> references;  // the ones the metrics use, one per exponent
    std::vector<Film> opening;              // the cosine arm at 1, 2, 4, ... samples
    std::shared_ptr<const Measures> measures;

    RunKey key(const std::string& arm, std::uint64_t n = 0, double s = 0) const;  // 0: the cast's
    const Film* film(const RunKey& key) const;                                    // nullptr: not run
    const ReferenceFilm& reference(double s = 0) const;
    const RunMetrics* metric(const RunKey& key) const;
    const RegionMetrics* region(const RunKey& key, const std::string& region) const;
    const Box& box(const std::string& region) const;

    // Numbers with their sources.
    Number rmse(const RunKey& key, const std::string& region, int digits = 3) const;
    Number n_of(const RunKey& key) const;
    Number s_of(const RunKey& key) const;
    Number arm(const std::string& arm) const;  // its name for readers
    plates::Colour ink(const std::string& arm) const;
};

/// Returns `box` of a film as a tone-mapped photograph, one byte triple per pixel of the film.
plates::Block photograph_of(const Data& data, const plates::View& view, const Box& box);
/// Returns a box of w x h around the middle of `box`, moved into the image.
Box around(const Data& data, const Box& box, int w, int h);

/// Runs the experiment in memory, with the arms and sample counts that the video adds. InputError if it lacks what the
/// video needs.
Data collect(const Experiment& experiment, const RunOptions& options, ProgressMonitor& monitor);

}  // namespace crescent::explainer
