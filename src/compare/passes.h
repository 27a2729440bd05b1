// Two passes over the renders: the first finds the size, the finite pixels and the means, the second the differences.
#pragma once

#include "compare/file_warnings.h"
#include "compare/renders.h"

namespace crescent::inline comparison {

// ---- What the first pass keeps while it reads: the size that all must have, and which pixels it has seen in which
// file.

class FirstPass {
public:
    FirstPass(RenderStats& all, ProgressMonitor& monitor) : all_(all), monitor_(monitor) {}
    /// Reads every file of an arm into `to`; `spp`: samples a pixel, where the plan says them. Throws InputError at the
    /// first that does not fit.
    void arm(ArmStats& to, const std::vector<std::string>& files, const std::string& layer, const std::string& name,
        const std::optional<double>& spp);
    /// Of all files so far, into the readings.
    void report_warnings() { all_.warnings = warnings_.lines(); }

private:
    void fit(const Render& render);
    void look(const Render& render, ArmStats& to);
    void known(const RenderFile& file, const std::string& arm);

    RenderStats& all_;
    ProgressMonitor& monitor_;
    FileWarnings warnings_;
    std::map<std::string, std::pair<std::string, std::string>> seen_;  // hash -> path, arm
};

// ---- Renders one after another, and what the second walk through them reads.

/// Reads each file in turn and hands it on, the next one being read meanwhile: two renders in memory at a time.
void each_render(const RenderSource& source, const std::vector<std::string>& paths, const std::string& layer,
    ProgressMonitor& monitor, const std::function<void(const Render&)>& use);

/// What each render of an arm (or the reference) says of each region and tile; its means must be known. Errors are
/// measured where a `reference` is given.
void second_pass(const ComparePlan& plan, const RenderStats& all, const RenderSource& source, ArmStats& arm,
    const std::string& layer, const MeanFilm* reference, ProgressMonitor& monitor);

}  // namespace crescent::inline comparison
