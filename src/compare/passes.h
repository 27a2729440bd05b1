// Two passes over the renders: the first finds the size, the finite pixels and the means, the second the deviations.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "compare/file_warnings.h"
#include "compare/plan.h"
#include "compare/renders.h"

namespace crescent {

// ---- The first pass: the size that all renders must have, and which pixels are in which file.

class FirstPass {
public:
    FirstPass(RenderStats& stats, ProgressMonitor& monitor) : stats_(stats), monitor_(monitor) {}
    /// Reads every file of an arm into `to`; `spp`: samples per pixel, if the plan states them. Throws InputError at
    /// the first file that does not fit.
    void arm(ArmStats& to, const std::vector<std::string>& files, const std::string& layer, const std::string& name,
        const std::optional<double>& spp);
    /// Reads the means and variances of an arm from its file of moments; it must be the first arm.
    void moments(ArmStats& to, const std::string& path);
    /// Stores the warnings about all files so far in the RenderStats.
    void report_warnings();

private:
    void fit(const Render& render);
    void check_pixels(const Render& render, ArmStats& to);
    void count_clipped(const Render& render);
    void check_copy(const RenderFile& file, const std::string& arm);

    RenderStats& stats_;
    ProgressMonitor& monitor_;
    FileWarnings warnings_;
    std::map<std::string, std::pair<std::string, std::string>> paths_by_hash_;  // hash -> path, arm
};

// ---- Renders one after another, and the second pass over them.

/// Reads the files in turn and calls use(render) for each while the next one is read: two renders in memory at a time.
void each_render(const RenderSource& source, const std::vector<std::string>& paths, const std::string& layer,
    ProgressMonitor& monitor, const std::function<void(const Render&)>& use);

/// Adds the statistics of each render of an arm (or of the reference) in each region and tile; its means must be known.
/// Errors are measured if a `reference` is given.
void second_pass(const ComparePlan& plan, const RenderStats& stats, const RenderSource& source, ArmStats& arm,
    const std::string& layer, const MeanFilm* reference, ProgressMonitor& monitor);

}  // namespace crescent
