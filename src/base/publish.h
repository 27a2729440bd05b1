// How files take the place of earlier ones as one. A file of theirs is always seen whole and always with the others of
// its run, whichever system call is the last one:
//
//   1. The new files stand in OUT/.crescent-stage-ID/new, on the disk. OUT/.crescent-current is made, a link to
//   .../old.
//   2. Each final name in turn becomes a link through OUT/.crescent-current, its file a second name in .../old: what is
//      read under the name is what was read before.
//   3. OUT/.crescent-current is replaced by a link to .../new. This one rename() publishes all.
//   4. Each new file is renamed over its link: what is read under the name is what was read before. A link that leads
//      nowhere, since the new run has no such file, is removed.
//
// Where it ends between two of these steps, settle() goes on from there: to the old files before step 3, to the new
// ones after it. Only files that earlier work of the same kind listed in OUT/.crescent-KIND are replaced or removed;
// another file that stands under one of the names is kept as NAME.~1~.
#pragma once

#include <atomic>
#include <string>
#include <string_view>
#include <vector>

#include "base/folder.h"
#include "base/progress_monitor.h"

namespace crescent::inline base {

inline constexpr std::string_view stage_prefix = ".crescent-stage-";
/// The list of what stands: one for each kind of work that writes into the folder.
std::string manifest_file(const std::string& kind);

class Publication {
public:
    /// `out` must outlive it; `stage` is the stage's name in it.
    Publication(const Folder& out, const std::string& shown_as, const std::string& stage);

    /// Brings stage/new/NAMES under their final names, in place of what the last work of this kind wrote. Throws
    /// OutputError where that cannot be: everything old then.
    void publish(std::vector<std::string> names, const std::string& kind, std::atomic<Outputs>& outputs);
    /// Throws OutputError where a file cannot stand under that final name: where a link, a device or a folder does.
    /// `make` makes the folders on the way.
    void check_place(const std::string& name, bool make) const;
    /// Ends what publish() began, in whichever step it was; nothing where none was begun. False where that failed.
    bool settle();
    /// What was kept under another name, a line each.
    const std::vector<std::string>& said() const { return said_; }

private:
    enum class Step { none, old_files, new_files };

    Step step() const;
    void check_places(const std::vector<std::string>& names) const;
    void sync_new(const std::vector<std::string>& names) const;
    bool sync_folders(const std::vector<std::string>& names) const;
    void hide(const std::string& name);
    bool show(const std::string& name, const Folder& set);
    bool set_aside(const Folder& old, const std::string& path, const std::vector<std::string>& ours);
    bool keep_aside(const Folder& from, const std::string& name);
    [[noreturn]] void fail(const std::string& name, const std::string& why) const;

    const Folder& out_;
    std::string shown_as_, stage_;
    std::vector<std::string> said_;
};

/// The names in a manifest; those that could lead out of the folder are left out.
std::vector<std::string> names_in(const std::string& manifest);

}  // namespace crescent::inline base
