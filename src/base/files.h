// Outputs appear all at once: a whole folder is written next to OUT and exchanged with it by one system call.
//
//   OUT                 the outputs, with files of the user; .crescent-KIND lists which files are ours
//   .OUT.crescent/      next to OUT while a run writes into it:
//     lock              held by that run; child processes do not inherit it
//     new/  scratch/    the unfinished outputs, and temporary files
//     moving            from here on the outputs are brought to their places; the next start completes this
//     one-by-one        by renaming them one by one
//     new/ or old/      the former OUT: our outputs are removed, files of the user are moved into OUT
//
// The user's files are in both folders when they are exchanged (hard links); whole folders of the user follow a moment
// later. If the file system has no exchange, two renames are used. If OUT cannot be renamed (a mount point, the current
// folder, another user's), files are renamed into it one by one, the list of them last; only in this case can a kill
// leave files of two runs, until the next start. If nothing can be created next to OUT, the work is in
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

#include "base/errors.h"
#include "base/progress.h"

namespace crescent {

/// Another run writes into the folder.
struct FolderInUse : OutputError {
    using OutputError::OutputError;
};

/// A folder of unfinished outputs. Nothing appears under a final name before commit(). Throws OutputError if something
/// cannot be written, FolderInUse if another process is writing into the same folder.
class Staging {
public:
    /// Resolves `folder` once: a later chdir does not move the outputs. Completes or clears the work of a killed run.
    /// Another kind may write into the same folder, because it has outputs of its own.
    explicit Staging(const std::string& folder, std::string kind = "outputs");
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    /// Throws if one of these outputs cannot be brought to its place, before the work is done.
    void expect(const std::vector<std::string>& names) const;
    /// Returns the temporary path for "plates/hero.png".
    std::string path(const std::string& name);
    void write(const std::string& name, std::span<const unsigned char> bytes);
    void write(const std::string& name, const std::string& text);
    /// Files of the user in the folder that commit() replaces or removes, as if an earlier run had written them. They
    /// are listed at once; call it last before commit(). One that is a link is replaced, and what it points to stays.
    void adopt(const std::vector<std::string>& names);
    /// Returns a folder for temporary files; it is removed with the stage.
    std::string scratch() const { return (work_ / "scratch").string(); }
    /// Brings every output to its place and removes files of the earlier outputs that are not among them. Other files
    /// in the folder stay; a user's file with the name of an output is kept as NAME.~1~, and `monitor` logs it.
    void commit(ProgressMonitor& monitor);

private:
    using Path = std::filesystem::path;
    using Names = std::vector<std::string>;

    void complete(const Path& work);
    bool take_lock();
    std::string obstacle(const std::string& name) const;
    void link_users_files(const Path& subfolder, const Names& ours) const;
    void finish();
    bool publish_whole() const;
    void publish_one_by_one(const std::string& kind);
    void clear(const Path& old, const Path& subfolder, const Names& ours, const Names& others);
    bool keep_aside(const Path& from, const Path& name);

    std::string users_path_, kind_;  // users_path_: the OUT of the caller
    Path out_, work_;                // absolute, links followed
    std::shared_ptr<void> lock_;     // its destruction removes an empty work folder
    bool moving_ = false;            // outputs are being moved to their places
    Names names_, warnings_, adopted_;
};

/// For tests: a function called before each change that moves outputs, and missing features of the file system.
struct PublishingFaults {
    void (*before_change)() = nullptr;
    bool no_exchange = false, no_rename_of_folders = false;
};
/// Returns those of this process: none unless a test set some.
PublishingFaults& publishing_faults();

/// Where a user's file is kept when an output takes its name: FILE.~1~, or the first larger number that no file has.
std::filesystem::path free_backup_name(const std::filesystem::path& file);

// ---- Reads a whole file at once.

/// Returns the bytes of a file; "" if it cannot be read.
inline std::string contents_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream contents;
    contents << file.rdbuf();
    return std::move(contents).str();
}

}  // namespace crescent
