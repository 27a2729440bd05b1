// A file of records that grows while long work goes on, so that a run which was stopped can be resumed. A record
// counts once it is whole: it carries its length and its XXH3, and what a kill tore off is not read back. A journal
// that cannot be written never ends the work: it says so and keeps nothing more.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"

namespace crescent::inline base {

class Journal {
public:
    using Bytes = std::span<const std::byte>;

    /// `key` names the work: the records of other work count as none. Nothing is read or written yet.
    Journal(std::string path, std::string key, ProgressMonitor& monitor);
    ~Journal();
    Journal(Journal&& other) noexcept;
    Journal& operator=(Journal&&) = delete;

    /// Hands over each whole record that is there, in order. None where another process has the file open.
    void read(const std::function<void(Bytes)>& take);
    /// Appends one record made of these parts; the first one makes the file.
    void append(const std::vector<Bytes>& parts);
    /// Takes the file away; a later append() makes it anew.
    void remove();

private:
    bool open(int flags);
    bool write(const std::vector<Bytes>& parts);
    std::string path_, key_;
    ProgressMonitor& monitor_;
    int file_ = -1;
    bool off_ = false;  // another process has the file, or it cannot be written
};

}  // namespace crescent::inline base
