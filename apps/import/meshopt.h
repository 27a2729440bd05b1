// EXT_meshopt_compression: the bytes of a view of glTF's buffers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace crescent::importer {

/// What the extension says about a view: `count` elements of `stride` bytes.
struct MeshoptView {
    std::string mode, filter = "NONE";
    std::size_t count = 0, stride = 0;
};

/// Whether this build has the decoder.
bool can_read_meshopt();

/// Returns the bytes of the view, count * stride. Throws ModelError.
std::string read_meshopt(std::string_view bytes, const MeshoptView& view);

}  // namespace crescent::importer
