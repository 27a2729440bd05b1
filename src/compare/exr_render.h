// Reads a render from an OpenEXR file.
#pragma once

#include <string>

#include "compare/image_file.h"
#include "compare/renders.h"

namespace crescent {

/// The reader of OpenEXR for read_render().
Render read_exr(const OpenFile& file, const std::string& layer_name, const ReadingOptions& options);

}  // namespace crescent
