// Outputs appear as one or not at all: they are written into a folder beside their place and brought there at the end.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/folder.h"
#include "base/progress_monitor.h"

namespace crescent::inline base {

/// A folder of outputs in the making. Nothing shows under a final name before commit(); if the process ends earlier,
/// earlier outputs stand untouched; wherever it ends inside commit(), all of the old ones stand or all of the new ones.
/// Throws OutputError where something cannot be written, and where another process is writing into the same folder.
class Staging {
public:
    /// Makes `folder` if it is not there, and ends or clears what earlier, killed runs left behind. Work of another
    /// kind may write into the same folder: it has outputs of its own.
    explicit Staging(std::string folder, std::string kind = "outputs");
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    /// Throws where one of these outputs could not be brought to its place: to be told before the work.
    void expect(const std::vector<std::string>& names) const;
    /// Where to write "plates/hero.png" for now.
    std::string path(const std::string& name);
    void write(const std::string& name, std::span<const unsigned char> bytes);
    void write(const std::string& name, const std::string& text);
    /// A folder for what is needed on the way; it goes with the stage.
    std::string scratch() const { return folder_ + "/" + stage_ + "/scratch"; }
    /// Brings every output to its place and removes files of the earlier outputs that are not among them. What the
    /// folder holds besides stays. `monitor` is told what stands when, and which files were kept under another name.
    void commit(ProgressMonitor& monitor);

private:
    void clear_stale();
    void make_stage();

    std::string folder_, kind_, stage_;  // stage_: its name in the folder
    Folder out_;
    int owner_ = -1;  // a locked file in the stage: its holder is alive
    std::vector<std::string> names_, said_;
};

}  // namespace crescent::inline base
