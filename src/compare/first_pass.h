// What the first pass keeps while it reads: the size that all must have, and which pixels it has seen in which file.
#pragma once

#include "compare/file_warnings.h"
#include "compare/renders.h"

namespace crescent::inline comparing {

class FirstPass {
public:
    FirstPass(Readings& all, ProgressMonitor& monitor) : all_(all), monitor_(monitor) {}
    /// Reads every file of an arm into `to`; `spp`: samples a pixel, where the plan says them. Throws InputError at the
    /// first that does not fit.
    void arm(ArmReadings& to, const std::vector<std::string>& files, const std::string& layer, const std::string& name,
        const std::optional<double>& spp);
    /// Of all files so far, into the readings.
    void report_warnings() { all_.warnings = warnings_.lines(); }

private:
    void fit(const Render& render);
    void look(const Render& render, ArmReadings& to);
    void known(const RenderFile& file, const std::string& arm);

    Readings& all_;
    ProgressMonitor& monitor_;
    FileWarnings warnings_;
    std::map<std::string, std::pair<std::string, std::string>> seen_;  // hash -> path, arm
};

}  // namespace crescent::inline comparing
