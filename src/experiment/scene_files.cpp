// A page has no files: scenes that need one are refused there.
#include "experiment/scene_files.h"

#include <fmt/format.h>

#include "base/errors.h"
#ifndef CRESCENT_NO_FILESYSTEM
#include "render/sky_file.h"
#endif

namespace crescent::inline experiment {

#ifdef CRESCENT_NO_FILESYSTEM
void load_sky(SkyLight& sky) { throw InputError({sky.file, 0, 0}, "a page cannot read the image of a sky"); }
#else
void load_sky(SkyLight& sky) {
    std::shared_ptr<const SkyImage> image = read_sky(sky.file);
    if (const std::string why = why_no_sky(*image, sky.scale); !why.empty()) throw InputError({sky.file, 0, 0}, why);
    const std::string content = content_hash(*image);
    if (sky.content && sky.content != content)
        throw InputError(
            {sky.file, 0, 0}, fmt::format("expected an image with the content {}, found {}", *sky.content, content));
    sky.content = content, sky.image = std::move(image);
}
#endif

}  // namespace crescent::inline experiment
