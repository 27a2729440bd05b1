// The stage is a folder in OUT with 64 random bits in its name. A lock on OUT and one on the stage's owner file keep
// runs apart; a stage whose lock nobody holds is settled, then removed. commit() leaves the moving to Publication.
#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "base/errors.h"
#include "base/publish.h"

namespace crescent::inline base {

namespace fs = std::filesystem;

namespace {

constexpr const char* owner_file = "owner";
constexpr std::string_view owner_text = "a run of crescent that is writing, or was killed while it wrote\n";

[[noreturn]] void fail(const std::string& what, const std::string& path, const std::string& why) {
    throw OutputError(fmt::format("{} {}: {}", what, path, why));
}

[[noreturn]] void in_use(const std::string& folder) {
    throw OutputError(fmt::format("{} is in use by another run; wait for it or choose another --out", folder));
}

/// It cannot be guessed, so nothing can be put in its place beforehand.
std::string new_stage_name() {
    std::uint64_t bits = 0;
    if (getentropy(&bits, sizeof bits) != 0) fail("cannot read", "the system's random numbers", std::strerror(errno));
    return fmt::format("{}{:016x}", stage_prefix, bits);
}

bool is_stage_name(const std::string& name) {
    return name.size() == stage_prefix.size() + 16 && name.starts_with(stage_prefix) &&
        name.find_first_not_of("0123456789abcdef", stage_prefix.size()) == std::string::npos;
}

enum class Life { alive, gone, not_ours };

/// A stage is ours to clear where its owner file says so, is this user's, and no living process holds it.
Life life_of(const Folder& out, const std::string& stage) {
    const Folder here = out.sub(stage);
    struct stat about{};
    if (!here || here.read(owner_file) != owner_text || fstat(here.descriptor(), &about) != 0 ||
        about.st_uid != geteuid())
        return Life::not_ours;
    const int owner = openat(here.descriptor(), owner_file, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    if (owner < 0) return Life::not_ours;
    const bool held = flock(owner, LOCK_EX | LOCK_NB) != 0;
    close(owner);
    return held ? Life::alive : Life::gone;
}

}  // namespace

Staging::Staging(std::string folder, std::string kind) : folder_(std::move(folder)), kind_(std::move(kind)) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error || !fs::is_directory(folder_))
        fail("cannot make the folder", folder_, error ? error.message() : "something else has that name");
    out_ = Folder(folder_);
    if (flock(out_.descriptor(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) in_use(folder_);
    clear_stale();
    make_stage();
}

void Staging::clear_stale() {
    for (const std::string& name : out_.leaves()) {
        if (!is_stage_name(name)) continue;
        const Life life = life_of(out_, name);
        if (life == Life::alive) in_use(folder_);
        if (life == Life::not_ours) continue;
        Publication publication(out_, folder_, name);
        if (!publication.settle()) fail("cannot end what a killed run began in", folder_, std::strerror(errno));
        said_.insert(said_.end(), publication.said().begin(), publication.said().end());
        std::error_code ignored;
        fs::remove_all(fs::path(folder_) / name, ignored);
    }
}

void Staging::make_stage() {
    do stage_ = new_stage_name();
    while (!out_.make_folder(stage_) && errno == EEXIST);
    const Folder stage = out_.sub(stage_);
    if (!stage) fail("cannot write in", folder_, std::strerror(errno));
    const auto need = [&](bool done) {
        if (done) return;
        const int why = errno;
        std::error_code ignored;
        fs::remove_all(fs::path(folder_) / stage_, ignored);
        fail("cannot write in", folder_, std::strerror(why));
    };
    owner_ = openat(stage.descriptor(), owner_file, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    need(owner_ >= 0);
    (void)flock(owner_, LOCK_EX | LOCK_NB);  // a file system without locks has the folder's alone
    need(::write(owner_, owner_text.data(), owner_text.size()) == static_cast<ssize_t>(owner_text.size()));
    need(stage.make_folder("new") && stage.make_folder("scratch"));
    need(stage.make_link("new", "link") && stage.remove("link"));  // outputs need links to appear as one
}

Staging::~Staging() {
    if (owner_ >= 0) close(owner_);
    if (out_.kind(".crescent-current") == Folder::Kind::link && out_.link_text(".crescent-current").starts_with(stage_))
        return;  // the next run settles it
    std::error_code ignored;
    fs::remove_all(fs::path(folder_) / stage_, ignored);
}

void Staging::expect(const std::vector<std::string>& names) const {
    const Publication publication(out_, folder_, stage_);
    for (const std::string& name : names) publication.check_place(name, false);
}

std::string Staging::path(const std::string& name) {
    const fs::path at = fs::path(folder_) / stage_ / "new" / name;
    if (!out_.sub(stage_ + "/new").parent_of(name, true))
        fail("cannot make the folder", at.parent_path(), std::strerror(errno));
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
    return at;
}

void Staging::write(const std::string& name, std::span<const unsigned char> bytes) {
    const std::string at = path(name);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!out_.sub(stage_ + "/new").parent_of(name, false).write(leaf_of(name), text))
        fail("cannot write", at, std::strerror(errno));
}
void Staging::write(const std::string& name, const std::string& text) {
    write(name, std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

void Staging::commit(ProgressMonitor& monitor) {
    Publication publication(out_, folder_, stage_);
    publication.publish(std::move(names_), kind_, monitor.outputs);
    names_.clear();
    said_.insert(said_.end(), publication.said().begin(), publication.said().end());
    for (const std::string& line : said_) monitor.log(line);
    said_.clear();
}

}  // namespace crescent::inline base
