// A file of records that grows during long work, so that a stopped run can be resumed. Each record has its length and
// its XXH3, so that a record cut off by a kill is not read. If a journal cannot be written, the work continues: the
// journal logs it and keeps nothing more.
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

    /// `key` names the work: records of other work are ignored. Nothing is read or written yet.
    Journal(std::string path, std::string key, ProgressMonitor& monitor);
    ~Journal();
    Journal(Journal&& other) noexcept;
    Journal& operator=(Journal&&) = delete;

    /// Passes on each complete record, in order; none if another process has the file open.
    void read(const std::function<void(Bytes)>& take);
    /// Appends one record made of these parts; the first call creates the file.
    void append(const std::vector<Bytes>& parts);
    /// Removes the file; a later append() creates it again.
    void remove();

private:
    bool open(int flags);
    bool write(const std::vector<Bytes>& parts);
    std::string path_, key_;
    ProgressMonitor& monitor_;
    int file_ = -1;
    bool disabled_ = false;  // another process has the file, or it cannot be written
};

}  // namespace crescent::inline base
