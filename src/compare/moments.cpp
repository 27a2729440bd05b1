// Writes moments. Single renders are not stored. The tests receive values with the mean and the variance of the renders
// instead: tests of means depend on nothing else. Which renders share random numbers is unknown.
#include "compare/moments.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "compare/moments_reading.h"
#include "compare/renders.h"
#include "compare/results.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent {

namespace {

/// A number is not finite where no pixel of a region or tile is: 0 is written, and nothing reads it. Throws OutputError
/// if one is too large for a float, such as the square of 1e20.
void put(Imf::Header& header, const std::string& name, const std::vector<double>& values) {
    Imf::FloatVector out;
    for (const double x : values) {
        const auto value = static_cast<float>(std::isfinite(x) ? x : 0);
        if (!std::isfinite(value))
            throw OutputError(fmt::format("{:.3g} is too large for a baseline of moments: store renders instead", x));
        out.push_back(value);
    }
    header.insert(name, Imf::FloatVectorAttribute(out));
}

struct Plane {
    std::string name;
    Imf::PixelType type;
    std::vector<float> values;
};

/// Returns the planes of one arm, rows bottom-up.
std::vector<Plane> planes_of(const ArmStats& arm, double scale) {
    const MeanFilm& film = arm.film;
    const bool grey = film.planes.size() == 1;
    std::vector<Plane> out;
    const auto add = [&](std::string name, Imf::PixelType type, auto value) {
        Plane& plane = out.emplace_back(Plane{std::move(name), type, std::vector<float>(film.y().size())});
        for (std::size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = static_cast<float>(value(i));
    };
    const auto variance = [&](std::size_t i, std::size_t q) {
        const double v = film.count > 1 ? film.variance(i, q) : 0;
        return std::isfinite(v) ? v : 0;
    };
    for (std::size_t q = grey ? 0 : 1; q < film.planes.size(); ++q)
        add(quantity_names[q], Imf::FLOAT, [&](std::size_t i) { return film.of(q).mean[i]; });
    add("variance.Y", Imf::FLOAT, [&](std::size_t i) { return variance(i, 0); });
    for (std::size_t q = 1; q < film.planes.size(); ++q)
        add(fmt::format("deviation.{}", quantity_names[q]), Imf::HALF,
            [&](std::size_t i) { return std::sqrt(variance(i, q)) / scale; });
    if (!arm.not_finite.empty())
        add("failed.N", Imf::FLOAT, [&](std::size_t i) { return static_cast<double>(arm.not_finite[i]); });
    return out;
}

/// Returns a power of two that scales the largest standard deviation of a channel to at most 2^14, within the range of
/// half.
double deviation_scale(const MeanFilm& film) {
    double largest = 0;
    for (std::size_t q = 1; q < film.planes.size() && film.count > 1; ++q)
        for (const double m2 : film.planes[q].m2)
            if (std::isfinite(m2)) largest = std::max(largest, m2 / static_cast<double>(film.count - 1));
    constexpr int bits = 14;
    return largest > 0 ? std::ldexp(1.0, std::ilogb(std::sqrt(largest)) + 1 - bits) : 1;
}

double deviation_of(const std::vector<double>& values) {
    const MeanInterval m = mean_interval(values, confidence);
    return m.n > 1 ? m.se * std::sqrt(static_cast<double>(m.n)) : 0;
}

void put_readings(Imf::Header& header, const RenderStats& stats, const ArmStats& arm) {
    for (std::size_t r = 0; r < stats.regions.size(); ++r) {
        std::vector<double> spread;
        for (const auto& render : arm.regions) spread.push_back(render[r].spread);
        put(header, moments_attribute("spread", r, 0), spread);
        put(header, moments_attribute("power", r, 0), arm.power[r]);
        if (!arm.failed_groups.empty()) {
            std::vector<double> groups;
            for (const auto& render : arm.failed_groups) groups.push_back(render[r]);
            put(header, moments_attribute("groups", r, 0), groups);
        }
        for (std::size_t q = 0; q < arm.quantities.size(); ++q) {
            std::vector<double> means;
            for (const auto& render : arm.quantities[q].regions) means.push_back(render[r]);
            put(header, moments_attribute("means", r, q), means);
            const std::vector<float>& largest = arm.quantities[q].largest[r];
            put(header, moments_attribute("largest", r, q), {largest.begin(), largest.end()});
        }
    }
    for (std::size_t q = 0; q < arm.quantities.size(); ++q) {
        const QuantityReadings& readings = arm.quantities[q];
        std::vector<double> deviations, largest;
        for (std::size_t t = 0; t < stats.tiles.count(); ++t) {
            std::vector<double> means;
            double largest_value = 0;
            for (const auto& render : readings.tiles) {
                means.push_back(render[t].mean);
                largest_value = std::max(largest_value, render[t].largest);
            }
            deviations.push_back(deviation_of(means));
            largest.push_back(largest_value);
        }
        put(header, moments_attribute("tiles", 0, q), deviations);
        put(header, moments_attribute("tiles", 1, q), largest);
        put(header, moments_attribute("events", 0, q), {readings.rise, readings.fall});
    }
}

std::string header_text(const RenderStats& stats, const ArmStats& arm, bool constant) {
    Json out = {{"format", moments_format}, {"renders", arm.files.size()}, {"constant", constant},
        {"quantities", arm.quantities.size()}, {"rounding", arm.film.rounding}, {"tile", stats.tiles.size},
        {"regions", Json::array()}};
    if (const Quantisation& steps = arm.film.steps; steps.levels > 0) {
        out["levels"] = static_cast<std::uint64_t>(steps.levels);
        out["srgb"] = steps.srgb;
    }
    for (const PixelSet& set : stats.regions) {
        const Box box = set.box.value_or(stats.frame());
        out["regions"].push_back({{"name", set.name}, {"box", {box.x0, box.y0, box.x1, box.y1}}});
    }
    return out.dump();
}

Imath::V2f point(const std::array<double, 2>& p) { return {static_cast<float>(p[0]), static_cast<float>(p[1])}; }

}  // namespace

bool has_moments(const std::string& path) {
    const OpenFile file(path);
    constexpr std::size_t head = 1 << 16;  // the attribute is among the first in the header
    std::string first(head, '\0');
    first.resize(file.read_some(0, first));
    return first.starts_with("\x76\x2f\x31\x01") && first.find(moments_text) != std::string::npos;
}

void write_moments(const std::string& path, const RenderStats& stats, std::size_t a, bool constant) {
    const ArmStats& arm = stats.arms[a];
    if (arm.files.size() > moments_renders_most)
        throw OutputError(fmt::format("cannot write {}: expected moments of at most {} renders, found {}", path,
            moments_renders_most, arm.files.size()));
    const double scale = deviation_scale(arm.film);
    std::vector<Plane> planes = planes_of(arm, scale);
    try {
        Imf::Header header(stats.width, stats.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        header.insert(moments_scale, Imf::FloatVectorAttribute({static_cast<float>(scale)}));
        header.insert(moments_text, Imf::StringAttribute(header_text(stats, arm, constant)));
        const Chromaticities& c = stats.primaries;
        Imf::addChromaticities(header, {point(c.red), point(c.green), point(c.blue), point(c.white)});
        put_readings(header, stats, arm);
        std::vector<std::vector<half>> halves;
        Imf::FrameBuffer buffer;
        for (const Plane& plane : planes) header.channels().insert(plane.name, Imf::Channel(plane.type));
        halves.reserve(planes.size());
        const auto width = static_cast<std::ptrdiff_t>(stats.width), rows = static_cast<std::ptrdiff_t>(stats.height);
        for (Plane& plane : planes) {  // rows run bottom-up: from the last one, with a negative stride
            const std::ptrdiff_t bytes = plane.type == Imf::HALF ? 2 : 4;
            char* first = reinterpret_cast<char*>(plane.values.data());
            if (plane.type == Imf::HALF) {
                std::vector<half>& to = halves.emplace_back(plane.values.begin(), plane.values.end());
                first = reinterpret_cast<char*>(to.data());
            }
            buffer.insert(plane.name,
                Imf::Slice(plane.type, first + bytes * width * (rows - 1), static_cast<std::size_t>(bytes),
                    static_cast<std::size_t>(-bytes * width)));
        }
        Imf::OutputFile file(path.c_str(), header, 1);
        file.setFrameBuffer(buffer);
        file.writePixels(stats.height);
    } catch (const std::exception& e) { throw OutputError(fmt::format("cannot write {}: {}", path, e.what())); }
}

}  // namespace crescent
