// By meshoptimizer, whose decoders check the bytes; the filters take what the extension's specification allows, which
// is checked here. Indices may be beyond the vertices: they are checked by who takes them.
#include "meshopt.h"

#include <cstdint>

#include <fmt/format.h>

#include "model.h"

#if CRESCENT_MESHOPT
#include <meshoptimizer.h>
#endif

namespace crescent::importer {

#if CRESCENT_MESHOPT

namespace {

/// Throws ModelError unless the sizes are those that the specification allows for the mode and the filter.
void check_sizes(const MeshoptView& view) {
    constexpr std::size_t largest_stride = 256, most_bytes = std::size_t{1} << 34;
    const bool is_vertices = view.mode == "ATTRIBUTES";
    const auto expect = [&](bool holds, const char* what) {
        if (!holds)
            throw ModelError(fmt::format("expected {} for the mode {} and the filter {}, not {} elements of {} bytes",
                what, view.mode, view.filter, view.count, view.stride));
    };
    if (!is_vertices && view.mode != "TRIANGLES" && view.mode != "INDICES")
        throw ModelError(fmt::format("expected a mode ATTRIBUTES, TRIANGLES or INDICES, not '{}'", view.mode));
    if (view.stride > 0 && view.count > most_bytes / view.stride)
        throw ModelError(fmt::format("{} elements of {} bytes are too many", view.count, view.stride));
    if (is_vertices)
        expect(view.stride > 0 && view.stride % 4 == 0 && view.stride <= largest_stride,
            "elements of 4, 8, ... 256 bytes");
    else expect(view.stride == 2 || view.stride == 4, "elements of 2 or 4 bytes");
    if (view.mode == "TRIANGLES") expect(view.count % 3 == 0, "three elements for each triangle");
    if (view.filter == "NONE" || view.filter == "EXPONENTIAL")
        return expect(is_vertices || view.filter == "NONE", "no filter");
    if (view.filter == "OCTAHEDRAL")
        return expect(is_vertices && (view.stride == 4 || view.stride == 8), "elements of 4 or 8 bytes");
    if (view.filter == "QUATERNION") return expect(is_vertices && view.stride == 8, "elements of 8 bytes");
    throw ModelError(
        fmt::format("expected a filter NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL, not '{}'", view.filter));
}

}  // namespace

bool can_read_meshopt() { return true; }

std::string read_meshopt(std::string_view bytes, const MeshoptView& view) {
    check_sizes(view);
    std::string out(view.count * view.stride, '\0');
    const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
    const int error = view.mode == "ATTRIBUTES"
        ? meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, from, bytes.size())
        : view.mode == "TRIANGLES"
        ? meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, from, bytes.size())
        : meshopt_decodeIndexSequence(out.data(), view.count, view.stride, from, bytes.size());
    if (error != 0)
        throw ModelError(fmt::format("the {} bytes are not {} elements of {} bytes in the mode {}", bytes.size(),
            view.count, view.stride, view.mode));
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), view.count, view.stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), view.count, view.stride);
    return out;
}

#else

bool can_read_meshopt() { return false; }

std::string read_meshopt(std::string_view, const MeshoptView&) {
    throw ModelError("this build has no decoder of meshoptimizer");
}

#endif

}  // namespace crescent::importer
