// Outputs appear as one: a whole folder is written beside OUT and exchanged with it by one system call.
//
//   OUT                 the outputs, beside files of the user; .crescent-KIND lists which files are ours
//   .OUT.crescent/      beside OUT while a run writes into it:
//     lock              held by that run; child processes do not inherit it
//     new/  scratch/    the outputs in the making, and what is needed on the way
//     moving            from here on the outputs are brought to their places: what the next start completes;
//     one-by-one        by renaming them one by one
//     new/ or old/      what OUT was: ours goes, files of the user are moved along into OUT
//
// The user's files are in both folders when they are exchanged (hard links); whole folders of the user follow a moment
// later. Where the file system has no exchange, two renames do it. Where OUT cannot be renamed at all (a mount point,
// the current folder, another user's), files are renamed into it one by one, the list of them last: there alone a kill
// can leave files of two runs, until the next start. Where nothing can be made beside OUT, the work is in
// OUT/.crescent-work.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"

namespace crescent::inline base {

/// A folder of outputs in the making. Nothing shows under a final name before commit(). Throws OutputError where
/// something cannot be written, and where another process is writing into the same folder.
class Staging {
public:
    /// Resolves `folder` once: a later chdir does not move the outputs. Completes what a killed run began, or clears
    /// what it left. Work of another kind may write into the same folder: it has outputs of its own.
    explicit Staging(const std::string& folder, std::string kind = "outputs");
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    /// Throws where one of these outputs could not be brought to its place, before the work is done.
    void expect(const std::vector<std::string>& names) const;
    /// Where to write "plates/hero.png" for now.
    std::string path(const std::string& name);
    void write(const std::string& name, std::span<const unsigned char> bytes);
    void write(const std::string& name, const std::string& text);
    /// Files of the user in the folder that commit() replaces or removes, as if an earlier run had written them. They
    /// are listed at once; call it last before commit().
    void adopt(const std::vector<std::string>& names);
    /// A folder for what is needed on the way; it goes with the stage.
    std::string scratch() const { return (work_ / "scratch").string(); }
    /// Brings every output to its place and removes files of the earlier outputs that are not among them. What the
    /// folder holds besides stays; a user's file under the name of an output is kept as NAME.~1~, and `monitor` logs
    /// it.
    void commit(ProgressMonitor& monitor);

private:
    using Path = std::filesystem::path;
    using Names = std::vector<std::string>;

    void complete(const Path& work);
    bool take_lock();
    std::string obstacle(const std::string& name) const;
    void link_users_files(const Path& below, const Names& ours) const;
    void finish();
    bool bring_whole() const;
    void bring_one_by_one(const std::string& kind);
    void clear(const Path& old, const Path& below, const Names& ours, const Names& others);
    bool keep_aside(const Path& from, const Path& name);

    std::string shown_, kind_;    // shown_: OUT as it was given
    Path out_, work_;             // absolute, links followed
    std::shared_ptr<void> lock_;  // its end takes an empty work folder away
    bool moving_ = false;         // outputs are being brought to their places
    Names names_, said_;
};

/// For tests: what is called before each change that brings outputs to their places, and what the file system lacks.
struct PublishingFaults {
    void (*before_change)() = nullptr;
    bool no_exchange = false, no_rename_of_folders = false;
};
/// Those of this process: none, where no test set some.
PublishingFaults& publishing_faults();

// ---- All of a file at once.

/// The bytes of a file; "" where it cannot be read.
inline std::string contents_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream all;
    all << file.rdbuf();
    return std::move(all).str();
}

}  // namespace crescent::inline base
