// Each step is one system call or can be repeated. "moving" names the folder that will become OUT by its inode: if new/
// is that folder, it is not in its place yet; else it is the former OUT. So the next start can complete the work from
// any step.
#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>

#include "base/errors.h"

namespace crescent {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view lock_text = "a run of crescent that is writing, or was killed while it wrote\n";
constexpr std::string_view list_head =
    "# Written by crescent. The next run into this folder replaces these files and leaves all others alone.\n";
constexpr std::string_view list_prefix = ".crescent-";

[[noreturn]] void fail(const std::string& what, const std::string& path, const std::string& why) {
    throw OutputError(fmt::format("{} {}: {}", what, path, why));
}

void about_to_change() {
    if (publishing_faults().before_change) publishing_faults().before_change();
}
bool move_to(const fs::path& from, const fs::path& to) {
    about_to_change();
    return ::rename(from.c_str(), to.c_str()) == 0;
}
bool remove_entry(const fs::path& path) {
    about_to_change();
    return ::remove(path.c_str()) == 0;
}
void remove_tree(const fs::path& path) {
    about_to_change();
    std::error_code ignored;
    fs::remove_all(path, ignored);
}
bool exchange(const fs::path& a, const fs::path& b) {
    about_to_change();
    if (publishing_faults().no_exchange) return errno = EINVAL, false;
#ifdef RENAME_EXCHANGE
    return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
    return errno = ENOSYS, false;
#endif
}
bool make_folders(const fs::path& path) {
    about_to_change();
    std::error_code error;
    fs::create_directories(path, error);
    return !error;
}

bool is_there(const fs::path& path) {
    struct stat s{};
    return lstat(path.c_str(), &s) == 0;
}
bool is_folder(const fs::path& path) {
    struct stat s{};
    return lstat(path.c_str(), &s) == 0 && S_ISDIR(s.st_mode);
}
ino_t inode(const fs::path& path) {
    struct stat s{};
    return lstat(path.c_str(), &s) == 0 ? s.st_ino : 0;
}
bool same_file(const fs::path& a, const fs::path& b) {
    struct stat s{}, t{};
    return lstat(a.c_str(), &s) == 0 && lstat(b.c_str(), &t) == 0 && s.st_ino == t.st_ino && s.st_dev == t.st_dev;
}
/// Returns whether something is mounted there, so that it can neither be renamed nor removed.
bool is_mounted(const fs::path& path) {
#ifdef STATX_ATTR_MOUNT_ROOT
    struct statx s{};
    return statx(AT_FDCWD, path.c_str(), AT_SYMLINK_NOFOLLOW, 0, &s) == 0 &&
        (s.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
#else
    return path.empty();
#endif
}

/// File systems that cannot sync a folder return EINVAL, which is ignored.
bool sync(const fs::path& path) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) return false;
    const bool is_good = fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP;
    const int why = errno;
    close(file);
    errno = why;
    return is_good;
}

std::string text_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return is_there(path) ? std::string{std::istreambuf_iterator<char>(in), {}} : "";
}
bool put(const fs::path& path, std::string_view bytes) {
    std::ofstream out(path, std::ios::binary);
    errno = 0;
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    return bool(out);
}

/// Names in this order, including the entries of folders.
std::vector<std::string> entries(const fs::path& folder) {
    std::vector<std::string> out;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) out.push_back(entry.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}
bool any_below(const std::vector<std::string>& names, const fs::path& folder) {
    return std::any_of(
        names.begin(), names.end(), [&](const auto& name) { return name.starts_with(folder.string() + "/"); });
}

bool stays_inside(const std::string& name) {
    const std::string framed = "/" + name + "/";
    return !name.empty() && framed.find("//") == std::string::npos && framed.find("/./") == std::string::npos &&
        framed.find("/../") == std::string::npos;
}

/// Returns the names in a list of outputs, without those that could lead out of the folder.
std::vector<std::string> names_in(const fs::path& list) {
    std::vector<std::string> names;
    const std::string text = text_of(list);
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string name = text.substr(begin, end - begin);
        if (stays_inside(name) && name.front() != '#') names.push_back(std::move(name));
        begin = end + 1;
    }
    return names;
}

std::string list_of(const std::string& kind) { return std::string(list_prefix) + kind; }

/// Returns what other kinds of work listed in a folder.
std::vector<std::string> others_lists(const fs::path& out, const std::string& list) {
    std::vector<std::string> names;
    for (const std::string& leaf : entries(out))
        if (leaf.starts_with(list_prefix) && leaf != list && !is_folder(out / leaf))
            std::ranges::move(names_in(out / leaf), std::back_inserter(names));
    return names;
}

struct Moving {
    ino_t folder = 0;
    std::string kind;
};
/// Names no folder if nothing is moving.
Moving read_moving(const fs::path& work) {
    std::ifstream in(work / "moving");
    Moving out;
    std::string end;
    if (!(in >> out.folder >> out.kind >> end) || end != "end") return {};
    return out;
}

std::mutex lock_mutex;
std::set<fs::path>& locked_here() {
    static std::set<fs::path> folders;
    return folders;
}

/// Returns whether another folder cannot replace `out`: this process works in it, or `replacement` cannot get its owner
/// and permissions.
bool must_stay(const fs::path& out, const fs::path& replacement) {
    struct stat s{};
    std::error_code none;
    const fs::path working_folder = fs::current_path(none);
    if (std::mismatch(out.begin(), out.end(), working_folder.begin(), working_folder.end()).first == out.end())
        return true;
#ifdef __linux__
    for (const char* rights : {"system.posix_acl_access", "system.posix_acl_default"})
        if (getxattr(out.c_str(), rights, nullptr, 0) >= 0) return true;
#endif
    if (stat(out.c_str(), &s) != 0) return true;
    for (const auto& entry : fs::recursive_directory_iterator(replacement, none))
        if (is_folder(entry) && chown(entry.path().c_str(), s.st_uid, s.st_gid) != 0) return true;
    return chown(replacement.c_str(), s.st_uid, s.st_gid) != 0 || chmod(replacement.c_str(), s.st_mode & 07777) != 0;
}

/// Returns whether a folder can exist next to `out` from which names can be moved into it.
bool can_be_next_to(const fs::path& out) {
    struct stat s{}, parent_stat{};
    const fs::path parent = out.parent_path();
    const bool other_device =
        stat(out.c_str(), &s) == 0 && stat(parent.c_str(), &parent_stat) == 0 && s.st_dev != parent_stat.st_dev;
    return out.has_filename() && out.filename().string().size() < 240 && !is_mounted(out) && !other_device &&
        access(parent.c_str(), W_OK) == 0;
}

/// Returns the absolute path, with links followed as far as the path exists.
fs::path resolved(const fs::path& path) {
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(fs::absolute(path), error);
    return error ? fs::absolute(path) : canonical;
}

}  // namespace

PublishingFaults& publishing_faults() {
    static PublishingFaults faults;
    return faults;
}

Staging::Staging(const std::string& folder, std::string kind) : users_path_(folder), kind_(std::move(kind)) {
    std::error_code error;
    out_ = resolved(folder);
    if (!out_.has_filename()) out_ = out_.parent_path();
    fs::create_directories(out_.parent_path(), error);
    out_ = resolved(out_);
    if (error || (is_there(out_) && !is_folder(out_)))
        fail("cannot make the folder", folder, error ? error.message() : "something else has that name");
    const fs::path inner_folder = out_ / ".crescent-work";
    if (is_folder(inner_folder)) complete(inner_folder);  // of a run for which OUT was a mount point
    lock_.reset();
    complete(can_be_next_to(out_) ? out_.parent_path() / fmt::format(".{}.crescent", out_.filename().string())
                                  : inner_folder);
    if (!make_folders(work_ / "new") || !make_folders(work_ / "scratch"))
        fail("cannot write in", folder, std::strerror(errno));
}

/// Takes this work folder, completes the work of a killed run there and removes its leftovers.
void Staging::complete(const Path& work) {
    work_ = work;
    if (work_.parent_path() == out_) make_folders(out_);
    for (int tries = 0; (mkdir(work_.c_str(), 0700) != 0 && errno != EEXIST) || !take_lock(); ++tries)
        if (const int why = errno; !is_folder(work_) || tries > 100)
            fail("cannot write in", users_path_, std::strerror(why));
    if (read_moving(work_).folder != 0) finish();
    if (read_moving(work_).folder != 0)
        fail("cannot clear", work_.string(), "it has earlier outputs, or files next to them");
    for (const char* name : {"new", "scratch", "moving", "one-by-one"}) remove_tree(work_ / name);
}

/// Takes a lock of the process, which no child inherits, on a file that still exists afterwards.
bool Staging::take_lock() {
    const fs::path path = work_ / "lock";
    const std::lock_guard one_at_a_time(lock_mutex);
    const FolderInUse in_use(fmt::format("{} is in use by another run; wait for it{}", users_path_,
        kind_ == "outputs" ? " or choose another --out" : ""));
    if (locked_here().contains(work_)) throw in_use;
    const std::vector<std::string> present = entries(work_);
    const bool is_fresh = present.empty() || present == std::vector<std::string>{"lock"};
    struct stat s{};
    if (lstat(work_.c_str(), &s) != 0) return false;
    if (!S_ISDIR(s.st_mode) || s.st_uid != geteuid() || (!is_fresh && text_of(path) != lock_text))
        fail("cannot write in", users_path_,
            fmt::format(
                "{} is not a folder of this user's runs; move it away or choose another --out", work_.string()));
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (file < 0 && errno == ENOENT) return false;
    if (file < 0) fail("cannot write in", users_path_, std::strerror(errno));
    struct flock file_lock{};
    file_lock.l_type = F_WRLCK;
    file_lock.l_whence = SEEK_SET;
    const bool is_locked = fcntl(file, F_SETLK, &file_lock) == 0 || (errno != EACCES && errno != EAGAIN);
    struct stat current{};
    if (!is_locked || fstat(file, &current) != 0 || current.st_ino != inode(path)) {
        close(file);
        if (!is_locked) throw in_use;
        return false;
    }
    locked_here().insert(work_);
    lock_ = std::shared_ptr<void>(nullptr, [file, work = work_](void*) {
        const std::lock_guard one_at_a_time(lock_mutex);
        if (entries(work) == std::vector<std::string>{"lock"} && remove_entry(work / "lock")) ::rmdir(work.c_str());
        close(file);
        locked_here().erase(work);
    });
    if (pwrite(file, lock_text.data(), lock_text.size(), 0) != static_cast<ssize_t>(lock_text.size()))
        fail("cannot write in", users_path_, std::strerror(errno));
    return true;
}

Staging::~Staging() {
    if (moving_) return;  // the next start completes it
    for (const char* name : {"new", "scratch", "one-by-one"}) remove_tree(work_ / name);
}

/// Returns why a file cannot be moved to that name; "" if it can.
std::string Staging::obstacle(const std::string& name) const {
    fs::path folder = out_;
    for (const fs::path& step : fs::path(name).parent_path()) {
        if (!is_there(folder / step)) break;
        folder /= step;
        if (!is_folder(folder)) return "a part of its path is not a folder";
    }
    if (is_there(folder) && access(folder.c_str(), W_OK) != 0) return std::strerror(errno);
    struct stat s{};
    if (lstat((out_ / name).c_str(), &s) != 0) return "";
    if (S_ISDIR(s.st_mode)) return std::strerror(EISDIR);
    if (S_ISLNK(s.st_mode) && contains(adopted_, name)) return "";
    if (!S_ISREG(s.st_mode)) return "a link or a device has that name";
    return is_mounted(out_ / name) ? "something is mounted there" : "";
}

void Staging::expect(const std::vector<std::string>& names) const {
    for (const std::string& name : names)
        if (const std::string why = obstacle(name); !why.empty())
            throw OutputError(
                fmt::format("cannot write {}/{}: {}; the earlier outputs there are unchanged", users_path_, name, why));
}

std::string Staging::path(const std::string& name) {
    const fs::path target = work_ / "new" / name;
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (error) fail("cannot make the folder", target.parent_path(), error.message());
    if (!contains(names_, name)) names_.push_back(name);
    return target;
}

void Staging::write(const std::string& name, std::span<const unsigned char> bytes) {
    const std::string target = path(name);
    if (!put(target, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
        fail("cannot write", target, std::strerror(errno));
}
void Staging::write(const std::string& name, const std::string& text) {
    write(name, std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

void Staging::adopt(const Names& names) {
    adopted_.insert(adopted_.end(), names.begin(), names.end());
    const fs::path list = out_ / list_of(kind_), new_list = work_ / "scratch" / "list";
    if (!is_there(out_)) return;
    Names list_entries = names_in(list);
    for (const std::string& name : names)
        if (stays_inside(name) && is_there(out_ / name) && !contains(list_entries, name)) list_entries.push_back(name);
    std::string text(list_head);
    for (const std::string& name : list_entries) text += name + "\n";
    if (!put(new_list, text) || !sync(new_list) || !move_to(new_list, list))
        fail("cannot write", list.string(), std::strerror(errno));
}

void Staging::commit(ProgressMonitor& monitor) {
    const fs::path fresh_outputs = work_ / "new", list = list_of(kind_);
    std::sort(names_.begin(), names_.end());
    std::string text(list_head);
    for (const std::string& name : names_) text += name + "\n";
    Names names = names_;
    names.push_back(list);
    if (!put(fresh_outputs / list, text)) fail("cannot write", (fresh_outputs / list).string(), std::strerror(errno));
    expect(names);
    Names ours = names_in(out_ / list);
    ours.push_back(list);
    link_users_files("", ours);
    std::set<fs::path> synced;
    for (const std::string& name : names) {
        if (!fs::is_symlink(fresh_outputs / name)) synced.insert(fresh_outputs / name);
        for (fs::path parent = fs::path(name).parent_path(); !parent.empty(); parent = parent.parent_path())
            synced.insert(fresh_outputs / parent);
    }
    synced.insert(fresh_outputs);
    for (const fs::path& path : synced)
        if (!sync(path)) fail("cannot write", path.string(), std::strerror(errno));
    if (!put(work_ / "moving", fmt::format("{} {} end\n", inode(fresh_outputs), kind_)) || !sync(work_ / "moving") ||
        !sync(work_))
        fail("cannot write in", users_path_, std::strerror(errno));
    monitor.outputs = Outputs::moving;
    moving_ = true;
    try {
        finish();
    } catch (const OutputError&) {
        if (!moving_) monitor.outputs = Outputs::untouched;
        throw;
    }
    moving_ = false;
    monitor.outputs = Outputs::complete;
    names_.clear();
    for (const std::string& line : warnings_) monitor.warn(line);
    warnings_.clear();
}

/// Makes a second name in new/ for each file of the user next to the outputs; what cannot be linked is moved later.
void Staging::link_users_files(const Path& subfolder, const Names& ours) const {
    for (const std::string& leaf : entries(out_ / subfolder)) {
        const fs::path name = subfolder / leaf, to = work_ / "new" / name;
        if (out_ / name == work_) continue;
        if (is_folder(out_ / name)) {
            if (is_folder(to) || any_below(ours, name)) link_users_files(name, ours);
        } else if (!contains(ours, name) && !is_there(to)) {
            make_folders(to.parent_path());
            about_to_change();
            static_cast<void>(!linkat(AT_FDCWD, (out_ / name).c_str(), AT_FDCWD, to.c_str(), 0));
        }
    }
}

/// Continues from "moving"; repeated after a kill. Throws OutputError if it cannot be completed now.
void Staging::finish() {
    const Moving moving = read_moving(work_);
    const fs::path fresh_outputs = work_ / "new", old = work_ / "old";
    if (inode(fresh_outputs) == moving.folder && !publish_whole()) publish_one_by_one(moving.kind);
    sync(out_.parent_path());
    for (const fs::path& folder : {fresh_outputs, old}) {  // after an exchange, and after two renames
        if (!is_there(folder)) continue;
        const std::string list = list_of(moving.kind);
        Names ours = names_in(folder / list);
        ours.push_back(list);
        clear(folder, "", ours, others_lists(out_, list));
        remove_entry(folder / list);
        remove_entry(folder);
    }
    if (!is_there(fresh_outputs) && !is_there(old)) {
        remove_entry(work_ / "one-by-one");
        remove_entry(work_ / "moving");
    } else warnings_.push_back(fmt::format("not all of the earlier outputs could be removed: see {}", work_.string()));
}

/// Makes new/ the folder OUT by one rename or exchange, else by two; returns false if OUT is unchanged.
bool Staging::publish_whole() const {
    const fs::path fresh_outputs = work_ / "new", old = work_ / "old";
    if (work_.parent_path() == out_ || is_there(work_ / "one-by-one")) return false;
    if (!is_there(out_)) return move_to(fresh_outputs, out_);
    if (publishing_faults().no_rename_of_folders || must_stay(out_, fresh_outputs)) return false;
    if (exchange(fresh_outputs, out_)) return true;
    if (!move_to(out_, old)) return false;
    return move_to(fresh_outputs, out_) || (static_cast<void>(move_to(old, out_)), false);
}

void Staging::publish_one_by_one(const std::string& kind) {
    const fs::path fresh_outputs = work_ / "new", list = list_of(kind);
    if (!is_there(fresh_outputs / list)) return remove_tree(fresh_outputs);  // which was moved last
    if (!put(work_ / "one-by-one", "")) fail("cannot write in", users_path_, std::strerror(errno));
    const Names old_names = names_in(out_ / list), new_names = names_in(fresh_outputs / list),
                others = others_lists(out_, list);
    const auto bring = [&](const std::string& name) {
        expect({name});
        const bool is_users_file =
            is_there(out_ / name) && name != list && !contains(old_names, name) && !contains(others, name);
        if (make_folders((out_ / name).parent_path()) && (!is_users_file || keep_aside(out_ / name, name)) &&
            move_to(fresh_outputs / name, out_ / name))
            return;
        const int why = errno;
        if ((new_names.empty() || name == new_names.front()) && remove_entry(work_ / "moving"))
            moving_ = false;  // nothing has changed
        errno = why;
        fail("cannot write", (out_ / name).string(), std::strerror(errno));
    };
    for (const std::string& name : new_names)
        if (is_there(fresh_outputs / name)) bring(name);
    for (const std::string& old_name : old_names)
        if (!contains(new_names, old_name) && is_there(out_ / old_name) && obstacle(old_name).empty() &&
            remove_entry(out_ / old_name))
            for (fs::path parent = fs::path(old_name).parent_path();
                !parent.empty() && ::rmdir((out_ / parent).c_str()) == 0;)
                parent = parent.parent_path();
    bring(list);
    remove_tree(fresh_outputs);  // only second names of the user's files are left
}

/// Removes our outputs from the former OUT and moves the rest into OUT. The list of our outputs is kept until the end.
void Staging::clear(const Path& old, const Path& subfolder, const Names& ours, const Names& others) {
    for (const std::string& leaf : entries(old / subfolder)) {
        const fs::path name = subfolder / leaf, from = old / name, to = out_ / name;
        if (name == ours.back()) continue;
        if (is_folder(from) && (is_folder(to) || any_below(ours, name))) {
            clear(old, name, ours, others);
            remove_entry(from);
        } else if (contains(ours, name) || (!is_folder(from) && same_file(from, to))) remove_entry(from);
        else if (!is_there(to)) static_cast<void>(make_folders(to.parent_path()) && move_to(from, to));
        else if (contains(others, name)) remove_entry(from);
        else keep_aside(from, name);
    }
}

bool Staging::keep_aside(const Path& from, const Path& name) {
    const Path backup = free_backup_name(out_ / name);
    if (!move_to(from, backup)) return false;
    warnings_.push_back(fmt::format(
        "{}/{} was not written by crescent: it is now {}", users_path_, name.string(), backup.filename().string()));
    return true;
}

std::filesystem::path free_backup_name(const std::filesystem::path& file) {
    for (int number = 1;; ++number) {
        fs::path backup = fmt::format("{}.~{}~", file.string(), number);
        if (!is_there(backup)) return backup;
    }
}

}  // namespace crescent
