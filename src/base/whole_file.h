// Writes one file so that readers find it complete or not at all. It is written without a name next to its place, so
// that a kill leaves nothing, if the file system supports this; else under a unique name (mkstemp: no other file is
// opened, followed or removed). Then it is synced and renamed. Pipes and devices are written directly.
#pragma once

#include <string>
#include <vector>

namespace crescent {

/// Throws OutputError if write_whole() could not write the file.
void can_write(const std::string& path);
/// A file that a command writes, by the flag that names it; path "": none.
struct OutputFile {
    std::string flag;
    std::string path;
};
/// Does it for each before the work is begun. Throws InputError if one is a file that the command reads, or if two are
/// the same file; pipes and devices may be named twice.
void claim_outputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs);
/// Writes `text` to a file next to `path` and renames it. Throws OutputError.
void write_whole(const std::string& path, const std::string& text);

}  // namespace crescent
