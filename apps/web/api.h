// The C interface between crescent's core, compiled to WebAssembly, and the page. Each instance has one experiment: the
// one opened last.
//
// A call that returns text takes its request as JSON in request_buffer(size) and leaves its response, JSON or text, at
// response_data(), response_size(). A call that returns numbers leaves planes of 4 bytes per pixel at the address it
// returns; they are valid until the next call. Boxes are [x0, x1) x [y0, y1) in pixels from the bottom-left.
//
// Debian's libraries for WebAssembly have no exceptions: a throw calls `api.failed` of the page with its kind and its
// message, and never returns. The page drops such an instance and creates another one.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "crescent/portable.h"

#define CRESCENT_EXPORT(name) extern "C" __attribute__((export_name(#name))) auto crescent_##name

namespace crescent::web {

using nlohmann::ordered_json;

/// The request in request_buffer(), and the response.
ordered_json request();
void respond(std::string text);
void respond(const ordered_json& answer);

/// Bytes for the page, kept until the next call.
template <class T> std::vector<T>& scratch() {
    static std::vector<T> buffer;
    return buffer;
}

/// A sample count that is being computed, tile by tile.
struct Slot {
    RunKey key;
    Film film;
};

/// The open experiment.
struct Bench {
    Experiment experiment;
    Scene scene;
    ShapeMap shapes;                     // of the boxes that were computed here
    std::optional<ShapeMap> all_shapes;  // of the whole image; none before it is needed
    std::vector<Slot> slots;
    /// Hits of primary rays, by box, for the following samplers and sample counts; and those of the last box that did
    /// not fit.
    std::map<std::array<int, 4>, std::vector<ShadingPoints>> shading_points;
    std::size_t points_kept = 0;
    std::array<int, 4> points_last{};
    std::vector<ShadingPoints> last;
    ReferenceFilm reference;
    std::unique_ptr<PixelQuadrature> quadrature;
    ExternalSamplers external_samplers;  // the sampler of the page, and combinations

    explicit Bench(Experiment from);
    std::size_t width() const { return static_cast<std::size_t>(experiment.image.width); }
    std::size_t pixels() const { return width() * static_cast<std::size_t>(experiment.image.height); }
};
/// Throws Bug if no experiment is open.
Bench& bench();
Slot& slot(int index);

/// JSON has no NaN and infinities: they are written by name, as in metrics.json.
ordered_json json_number(double x);
/// An arm as the kernels take it.
SamplerRef sampler_of(const ArmPlan& arm);
/// Returns the arm `name` of the experiment; throws InputError if there is none.
const ArmPlan& arm_of(const std::string& name);

}  // namespace crescent::web
