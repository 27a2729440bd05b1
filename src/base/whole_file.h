// One file that is seen whole or not at all. It is written without a name next to its place, so that a kill leaves
// nothing, where the file system supports that, else under a name of its own (mkstemp: no file of anybody else is
// opened, followed or removed); it is synced and renamed. Pipes and devices are written to as they are.
#pragma once

#include <string>

namespace crescent::inline base {

/// Throws OutputError where write_whole() would.
void can_write(const std::string& path);
/// Writes `text` to a file next to `path` and renames it. Throws OutputError.
void write_whole(const std::string& path, const std::string& text);

}  // namespace crescent::inline base
