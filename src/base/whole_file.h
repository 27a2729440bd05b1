// Writes one file so that readers find it complete or not at all. It is written without a name next to its place, so
// that a kill leaves nothing, if the file system supports this; else under a unique name (mkstemp: no other file is
// opened, followed or removed). Then it is synced and renamed. Pipes and devices are written directly.
#pragma once

#include <string>

namespace crescent::inline base {

/// Throws OutputError if write_whole() could not write the file.
void can_write(const std::string& path);
/// Writes `text` to a file next to `path` and renames it. Throws OutputError.
void write_whole(const std::string& path, const std::string& text);

}  // namespace crescent::inline base
