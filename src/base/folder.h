// A folder held by its descriptor. What is named in it is reached from there, step by step, and no step follows a link:
// a planted link is not followed. Every change is one system call.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline base {

class Folder {
public:
    enum class Kind { none, file, link, folder, other };

    Folder() = default;
    /// The folder at `path`, links followed: it is the user's own. Throws OutputError.
    explicit Folder(const std::string& path);
    ~Folder();
    Folder(Folder&& other) noexcept;
    Folder& operator=(Folder&& other) noexcept;

    explicit operator bool() const { return file_ >= 0; }
    int descriptor() const { return file_; }

    /// "plates/hero.png" -> the folder plates; made where `make` is set. False where it is not there (errno says why).
    Folder parent_of(const std::string& name, bool make) const;
    Folder sub(const std::string& name, bool make = false) const;

    // `leaf` is one name without a slash.
    Kind kind(const std::string& leaf) const;
    std::string link_text(const std::string& leaf) const;
    std::vector<std::string> leaves() const;
    std::string read(const std::string& leaf) const;  // "" where it is no file

    // Changes; false and errno where they fail.
    bool make_folder(const std::string& leaf) const;
    bool make_link(const std::string& text, const std::string& leaf) const;
    bool write(const std::string& leaf, std::string_view bytes) const;  // a new file, on the disk when it returns
    bool share(const std::string& leaf, const Folder& to, const std::string& as) const;  // one file under two names
    bool move(const std::string& leaf, const Folder& to, const std::string& as) const;
    bool remove(const std::string& leaf) const;
    bool remove_folder(const std::string& leaf) const;
    bool sync() const;                         // the folder itself
    bool sync(const std::string& leaf) const;  // a file in it

private:
    explicit Folder(int file) : file_(file) {}
    int file_ = -1;
};

/// Called before each change, where a test has set it.
extern void (*before_change)();

/// The last part of a name: "plates/hero.png" -> "hero.png".
std::string leaf_of(const std::string& name);

}  // namespace crescent::inline base
