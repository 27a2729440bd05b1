// The step is read off the link .crescent-current alone, and stage/names lists what is concerned, so that settle() can
// go on in any process. Folders are synced before that link is made, replaced and removed.
#include "base/publish.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>

#include "base/errors.h"

namespace crescent::inline base {

namespace {

constexpr const char* current = ".crescent-current";
constexpr std::string_view manifest_head =
    "# Written by crescent. The next run into this folder replaces these files and leaves all others alone.\n";

/// From the folder of `name` to the same name in whichever files are current.
std::string way_to(const std::string& name) {
    std::string up;
    for (const char c : name)
        if (c == '/') up += "../";
    return fmt::format("{}{}/{}", up, current, name);
}

bool stays_inside(const std::string& name) {
    if (name.empty() || name.size() > 1024 || name.front() == '/' || name.back() == '/') return false;
    const std::string framed = "/" + name + "/";
    for (const char* step : {"//", "/./", "/../"})
        if (framed.find(step) != std::string::npos) return false;
    return true;
}

std::string manifest_of(const std::vector<std::string>& names) {
    std::string text(manifest_head);
    for (const std::string& name : names) text += name + "\n";
    return text;
}

bool holds(const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

}  // namespace

std::vector<std::string> names_in(const std::string& manifest) {
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin < manifest.size();) {
        const std::size_t end = std::min(manifest.find('\n', begin), manifest.size());
        std::string name = manifest.substr(begin, end - begin);
        if (stays_inside(name) && name.front() != '#') names.push_back(std::move(name));
        begin = end + 1;
    }
    return names;
}

Publication::Publication(const Folder& out, const std::string& shown_as, const std::string& stage)
    : out_(out), shown_as_(shown_as), stage_(stage) {}

void Publication::fail(const std::string& name, const std::string& why) const {
    throw OutputError(
        fmt::format("cannot write {}/{}: {}; every output there is the one of before", shown_as_, name, why));
}

void Publication::check_place(const std::string& name, bool make) const {
    const Folder at = out_.parent_of(name, make);
    if (!at && errno == ENOENT && !make) return;
    if (!at)
        fail(name, errno == ELOOP || errno == ENOTDIR ? "a part of its path is not a folder" : std::strerror(errno));
    const Folder::Kind there = at.kind(leaf_of(name));
    if (there == Folder::Kind::folder) fail(name, std::strerror(EISDIR));
    if (there != Folder::Kind::none && there != Folder::Kind::file) fail(name, "a link or a device has that name");
}

void Publication::check_places(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
        check_place(name, true);
        const Folder made = out_.sub(stage_ + "/new").parent_of(name, false);
        if (!made || made.kind(leaf_of(name)) != Folder::Kind::file) fail(name, "it was not made");
    }
}

void Publication::sync_new(const std::vector<std::string>& names) const {
    const Folder made = out_.sub(stage_ + "/new");
    for (const std::string& name : names) {
        const Folder at = made.parent_of(name, false);
        if (!at || !at.sync(leaf_of(name)) || !at.sync()) fail(name, std::strerror(errno));
    }
    if (!made.sync()) fail(stage_, std::strerror(errno));
}

std::string manifest_file(const std::string& kind) { return ".crescent-" + kind; }

void Publication::publish(std::vector<std::string> names, const std::string& kind, std::atomic<Outputs>& outputs) {
    const Folder stage = out_.sub(stage_), made = stage.sub("new");
    std::sort(names.begin(), names.end());
    const std::string manifest = manifest_file(kind);
    if (!made.write(manifest, manifest_of(names))) fail(manifest, std::strerror(errno));
    names.insert(names.begin(), manifest);  // the first of stage/names as well
    check_places(names);
    sync_new(names);
    std::vector<std::string> all = names;
    for (std::string& name : names_in(out_.read(manifest)))
        if (const Folder at = out_.parent_of(name, false);
            !holds(all, name) && at && at.kind(leaf_of(name)) == Folder::Kind::file)
            all.push_back(std::move(name));
    if (!stage.write("names", manifest_of(all)) || !stage.make_folder("old") || !stage.sync() || !out_.sync())
        fail(stage_, std::strerror(errno));

    if (!out_.make_link(stage_ + "/old", current)) fail(current, std::strerror(errno));
    outputs = Outputs::moving;
    try {
        for (const std::string& name : all) hide(name);
        if (!sync_folders(all)) fail(stage_, std::strerror(errno));
        if (!stage.make_link(stage_ + "/new", "link")) fail(stage_, std::strerror(errno));
        if (!stage.move("link", out_, current)) fail(current, std::strerror(errno));
    } catch (...) {
        outputs = settle() ? Outputs::untouched : Outputs::moving;
        throw;
    }
    outputs = Outputs::stand;
    if (!out_.sync()) said_.push_back(fmt::format("cannot sync {}: {}", shown_as_, std::strerror(errno)));
    settle();
}

bool Publication::sync_folders(const std::vector<std::string>& names) const {
    std::set<std::string> folders = {""};
    for (const std::string& name : names)
        if (const std::size_t slash = name.rfind('/'); slash != std::string::npos)
            folders.insert(name.substr(0, slash));
    return std::all_of(folders.begin(), folders.end(), [&](const std::string& name) {
        const Folder folder = out_.sub(name);
        return !folder || folder.sync();
    });
}

void Publication::hide(const std::string& name) {
    const Folder at = out_.parent_of(name, true), old = out_.sub(stage_ + "/old").parent_of(name, true),
                 stage = out_.sub(stage_);
    const std::string leaf = leaf_of(name);
    if (!at || !old) fail(name, std::strerror(errno));
    if (at.kind(leaf) == Folder::Kind::none) {
        if (!at.make_link(way_to(name), leaf)) fail(name, std::strerror(errno));
        return;
    }
    // A file that cannot have a second name (another user's, another file system) is copied.
    if (!at.share(leaf, old, leaf) && !old.write(leaf, at.read(leaf))) fail(name, std::strerror(errno));
    if (!stage.make_link(way_to(name), "link")) fail(name, std::strerror(errno));
    if (stage.move("link", at, leaf)) return;
    const int why = errno;
    stage.remove("link");
    fail(name, std::strerror(why));
}

Publication::Step Publication::step() const {
    if (out_.kind(current) != Folder::Kind::link) return Step::none;
    const std::string to = out_.link_text(current);
    if (to == stage_ + "/old") return Step::old_files;
    return to == stage_ + "/new" ? Step::new_files : Step::none;
}

bool Publication::show(const std::string& name, const Folder& set) {
    const Folder at = out_.parent_of(name, false), from = set.parent_of(name, false);
    const std::string leaf = leaf_of(name);
    if (!at || at.kind(leaf) != Folder::Kind::link || at.link_text(leaf) != way_to(name)) return true;
    if (from && from.kind(leaf) == Folder::Kind::file) return from.move(leaf, at, leaf);
    if (!at.remove(leaf)) return false;
    for (std::size_t slash = name.rfind('/'); slash != std::string::npos; slash = name.rfind('/', slash - 1)) {
        const std::string folder = name.substr(0, slash);
        if (!out_.parent_of(folder, false).remove_folder(leaf_of(folder)) || slash == 0)
            break;  // others' files are in it
    }
    return true;
}

bool Publication::settle() {
    const Step now = step();
    if (now == Step::none) return true;
    const Folder stage = out_.sub(stage_), set = stage.sub(now == Step::new_files ? "new" : "old"),
                 old = stage.sub("old");
    bool good = true;
    const std::vector<std::string> names = names_in(stage.read("names"));
    for (const std::string& name : names) good = show(name, set) && good;
    if (good && now == Step::new_files) {
        std::vector<std::string> ours = names_in(names.empty() ? "" : old.read(names.front()));
        if (!names.empty()) ours.push_back(names.front());
        for (const std::string& leaf : out_.leaves())  // what other kinds of work listed
            if (leaf.starts_with(".crescent-") && !names.empty() && leaf != names.front())
                for (std::string& name : names_in(out_.read(leaf))) ours.push_back(std::move(name));
        good = set_aside(old, "", ours);
    }
    return good && sync_folders(names) && out_.remove(current) && out_.sync();
}

/// Files of `old` that no run of ours listed go back beside their names.
bool Publication::set_aside(const Folder& old, const std::string& path, const std::vector<std::string>& ours) {
    bool good = true;
    const Folder here = old.sub(path);
    for (const std::string& leaf : here.leaves()) {
        const std::string name = path.empty() ? leaf : path + "/" + leaf;
        if (here.kind(leaf) == Folder::Kind::folder) good = set_aside(old, name, ours) && good;
        else if (!holds(ours, name)) good = keep_aside(here, name) && good;
    }
    return good;
}

bool Publication::keep_aside(const Folder& from, const std::string& name) {
    const Folder at = out_.parent_of(name, true);
    const std::string leaf = leaf_of(name);
    int k = 1;
    while (at && at.kind(fmt::format("{}.~{}~", leaf, k)) != Folder::Kind::none) ++k;
    const std::string as = fmt::format("{}.~{}~", leaf, k);
    if (!at || !from.move(leaf, at, as)) return false;
    said_.push_back(fmt::format("{}/{} was not written by crescent: it is now {}", shown_as_, name, as));
    return true;
}

}  // namespace crescent::inline base
