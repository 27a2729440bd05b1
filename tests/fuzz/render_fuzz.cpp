// Any bytes as a render in OpenEXR, PNG, PFM or NPY: it is read, or rejected with an InputError that has a message.
// Other formats are decoded in a process of their own, see images/image_host.h.
#include <cstdint>
#include <string>

#include "compare/renders.h"
#include "memory_file.h"

namespace {

using namespace crescent;

bool is_read_here(const std::string& bytes) {
    for (const char* first : {"\x76\x2f\x31\x01", "\x89PNG", "PF", "Pf", "\x93NUMPY"})
        if (bytes.starts_with(first)) return true;
    return false;
}

void check_sizes(const Render& render) {
    const std::size_t pixels = static_cast<std::size_t>(render.width) * static_cast<std::size_t>(render.height);
    for (const std::vector<float>* plane : {&render.r, &render.g, &render.b})
        ensure(plane->size() == pixels, "a channel has a number for each pixel");
    for (const std::vector<float>* plane : {&render.alpha, &render.variance})
        ensure(plane->empty() || plane->size() == pixels, "an optional channel has one for each pixel, or none");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    if (!is_read_here(bytes)) return -1;
    const MemoryFile file(bytes);
    read_or_refuse([&] { check_sizes(read_render(file.path())); });
    ReadingOptions all;
    all.channels = TestedChannels::rgba;
    read_or_refuse([&] { check_sizes(read_render(file.path(), "", all)); });
    all.channel = "Z";
    read_or_refuse([&] { check_sizes(read_render(file.path(), "", all)); });
    return 0;
}
