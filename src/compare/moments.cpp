// Single renders are not stored. The tests receive values with the mean and the variance of the renders instead: tests
// of means depend on nothing else. Which renders share random numbers is unknown.

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "compare/renders.h"
#include "compare/results.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent::inline comparison {

namespace {

constexpr const char* format_name = "crescent moments 1";
constexpr const char* text_attribute = "baseline.moments";
constexpr const char* scale_attribute = "baseline.scale";

/// Returns the name of the header attribute with numbers of one kind.
std::string attribute_name(const char* kind, std::size_t region, std::size_t quantity) {
    return fmt::format("crescent.{}.{}.{}", kind, region, quantity);
}

void put(Imf::Header& header, const std::string& name, const std::vector<double>& values) {
    Imf::FloatVector out;
    for (const double x : values) out.push_back(static_cast<float>(x));
    header.insert(name, Imf::FloatVectorAttribute(out));
}

/// Returns the numbers of an attribute. Throws InputError unless there are `count` of them (0: any number).
std::vector<double> take(
    const std::string& path, const Imf::Header& header, const std::string& name, std::size_t count) {
    const auto* found = header.findTypedAttribute<Imf::FloatVectorAttribute>(name);
    if (!found || (count > 0 && found->value().size() != count))
        throw InputError({path, 0, 0},
            fmt::format(
                "attribute '{}': expected {} numbers, found {}", name, count, found ? found->value().size() : 0));
    return {found->value().begin(), found->value().end()};
}

/// Calls use(file) with the file opened by OpenEXR's C++ library, whose errors become InputErrors.
template <class Use> void with_file(const std::string& path, const Use& use) {
    try {
        Imf::InputFile file(path.c_str(), 1);
        use(file);
    } catch (const InputError&) { throw; } catch (const std::exception& e) {
        throw InputError({path, 0, 0}, std::string("expected an OpenEXR file with moments: ") + e.what());
    }
}

Json header_json(const std::string& path, const Imf::Header& header) {
    const auto* text = header.findTypedAttribute<Imf::StringAttribute>(text_attribute);
    const Json out = text ? Json::parse(text->value(), nullptr, false) : Json();
    if (!out.is_object() || out.value("format", "") != format_name ||
        !out.value("renders", Json()).is_number_unsigned())
        throw InputError({path, 0, 0}, fmt::format("attribute '{}': expected '{}'", text_attribute, format_name));
    return out;
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
    double most = 0;
    for (std::size_t q = 1; q < film.planes.size() && film.count > 1; ++q)
        for (const double m2 : film.planes[q].m2)
            if (std::isfinite(m2)) most = std::max(most, m2 / static_cast<double>(film.count - 1));
    constexpr int bits = 14;
    return most > 0 ? std::ldexp(1.0, std::ilogb(std::sqrt(most)) + 1 - bits) : 1;
}

double deviation_of(const std::vector<double>& values) {
    const MeanInterval m = mean_interval(values, confidence);
    return m.n > 1 ? m.se * std::sqrt(static_cast<double>(m.n)) : 0;
}

void put_readings(Imf::Header& header, const RenderStats& all, const ArmStats& arm) {
    for (std::size_t r = 0; r < all.regions.size(); ++r) {
        std::vector<double> spread;
        for (const auto& render : arm.regions) spread.push_back(render[r].spread);
        put(header, attribute_name("spread", r, 0), spread);
        put(header, attribute_name("power", r, 0), arm.power[r]);
        if (!arm.failed_groups.empty()) {
            std::vector<double> groups;
            for (const auto& render : arm.failed_groups) groups.push_back(render[r]);
            put(header, attribute_name("groups", r, 0), groups);
        }
        for (std::size_t q = 0; q < arm.quantities.size(); ++q) {
            std::vector<double> means;
            for (const auto& render : arm.quantities[q].regions) means.push_back(render[r]);
            put(header, attribute_name("means", r, q), means);
            const std::vector<float>& largest = arm.quantities[q].largest[r];
            put(header, attribute_name("largest", r, q), {largest.begin(), largest.end()});
        }
    }
    for (std::size_t q = 0; q < arm.quantities.size(); ++q) {
        const QuantityReadings& readings = arm.quantities[q];
        std::vector<double> deviations, largest;
        for (std::size_t t = 0; t < all.tiles.count(); ++t) {
            std::vector<double> means;
            double most = 0;
            for (const auto& render : readings.tiles)
                means.push_back(render[t].mean), most = std::max(most, render[t].largest);
            deviations.push_back(deviation_of(means)), largest.push_back(most);
        }
        put(header, attribute_name("tiles", 0, q), deviations);
        put(header, attribute_name("tiles", 1, q), largest);
        put(header, attribute_name("events", 0, q), {readings.rise, readings.fall});
    }
}

std::string header_text(const RenderStats& all, const ArmStats& arm, bool constant) {
    Json out = {{"format", format_name}, {"renders", arm.files.size()}, {"constant", constant},
        {"quantities", arm.quantities.size()}, {"rounding", arm.film.rounding}, {"tile", all.tiles.size},
        {"regions", Json::array()}};
    for (const PixelSet& set : all.regions) {
        const Box box = set.box.value_or(all.frame());
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
    return first.starts_with("\x76\x2f\x31\x01") && first.find(text_attribute) != std::string::npos;
}

void write_moments(const std::string& path, const RenderStats& all, std::size_t a, bool constant) {
    const ArmStats& arm = all.arms[a];
    const double scale = deviation_scale(arm.film);
    std::vector<Plane> planes = planes_of(arm, scale);
    try {
        Imf::Header header(all.width, all.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        header.insert(scale_attribute, Imf::FloatVectorAttribute({static_cast<float>(scale)}));
        header.insert(text_attribute, Imf::StringAttribute(header_text(all, arm, constant)));
        const Chromaticities& c = all.primaries;
        Imf::addChromaticities(header, {point(c.red), point(c.green), point(c.blue), point(c.white)});
        put_readings(header, all, arm);
        std::vector<std::vector<half>> halves;
        Imf::FrameBuffer buffer;
        for (const Plane& plane : planes) header.channels().insert(plane.name, Imf::Channel(plane.type));
        halves.reserve(planes.size());
        const auto width = static_cast<std::ptrdiff_t>(all.width), rows = static_cast<std::ptrdiff_t>(all.height);
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
        file.writePixels(all.height);
    } catch (const std::exception& e) { throw OutputError(fmt::format("cannot write {}: {}", path, e.what())); }
}

MomentsHeader read_moments_header(const std::string& path) {
    MomentsHeader out;
    with_file(path, [&](Imf::InputFile& file) {
        const Json text = header_json(path, file.header());
        out.renders = text["renders"].get<std::size_t>(), out.constant = text.value("constant", false);
    });
    if (out.renders < 1) throw InputError({path, 0, 0}, "expected the moments of one render or more, found none");
    return out;
}

void read_moments_film(const std::string& path, const Rgb& weights, RenderStats& all, ArmStats& to) {
    const std::size_t pixels = static_cast<std::size_t>(all.width) * static_cast<std::size_t>(all.height);
    with_file(path, [&](Imf::InputFile& file) {
        const Json text = header_json(path, file.header());
        const auto renders = text["renders"].get<std::size_t>();
        const bool grey = file.header().channels().findChannel("Y") != nullptr;
        const double scale = take(path, file.header(), scale_attribute, 1)[0];
        const auto read = [&](const std::string& name) {
            if (!file.header().channels().findChannel(name))
                throw InputError({path, 0, 0}, fmt::format("expected a channel '{}', found none", name));
            std::vector<float> out(pixels);
            const auto row = static_cast<std::ptrdiff_t>(all.width) * 4;
            const Imath::Box2i window = file.header().dataWindow();
            char* first = reinterpret_cast<char*>(out.data()) + row * (all.height - 1);
            Imf::FrameBuffer buffer;
            buffer.insert(name,
                Imf::Slice(
                    Imf::FLOAT, first - 4 * window.min.x + row * window.min.y, 4, static_cast<std::size_t>(-row)));
            file.setFrameBuffer(buffer);
            file.readPixels(window.min.y, window.max.y);
            return out;
        };
        MeanFilm& film = to.film;
        film.count = renders, film.rounding = text.value("rounding", 0x1p-24);
        const double below = static_cast<double>(renders - 1);
        film.planes.assign(grey ? 1 : colour_quantities, {});
        for (std::size_t q = 0; q < film.planes.size(); ++q) {
            if (q == 0 && !grey) continue;
            const std::vector<float> mean = read(quantity_names[q]);
            film.planes[q].mean.assign(mean.begin(), mean.end());
            if (q == 0) continue;
            for (const float d : read(fmt::format("deviation.{}", quantity_names[q])))
                film.planes[q].m2.push_back(below * scale * scale * static_cast<double>(d) * static_cast<double>(d));
        }
        if (!grey) {
            film.planes[0].mean.resize(pixels);
            for (std::size_t i = 0; i < pixels; ++i)  // rounded as Render::y() is
                film.planes[0].mean[i] = static_cast<double>(static_cast<float>(weights[0] * film.planes[1].mean[i] +
                    weights[1] * film.planes[2].mean[i] + weights[2] * film.planes[3].mean[i]));
        }
        for (const float v : read("variance.Y")) film.planes[0].m2.push_back(below * static_cast<double>(v));
        if (file.header().channels().findChannel("failed.N")) {
            to.not_finite.assign(pixels, 0);
            const std::vector<float> failed = read("failed.N");
            for (std::size_t i = 0; i < pixels; ++i)
                if (failed[i] > 0) to.not_finite[i] = static_cast<std::uint32_t>(failed[i]), all.bad[i] = true;
        }
        for (std::size_t k = 0; k < renders; ++k) {
            RenderFile& render = to.files.emplace_back();
            render.path = path, render.hash = fmt::format("moments {}", k);
        }
    });
}

namespace {

/// Returns the index of a region of `all` among those of the file.
std::size_t region_in(
    const std::string& path, const Json& text, const RenderStats& all, const PixelSet& set, const ComparePlan& plan) {
    const Box box = set.box.value_or(all.frame());
    const Json wanted = {box.x0, box.y0, box.x1, box.y1};
    for (std::size_t r = 0; r < text["regions"].size(); ++r)
        if (text["regions"][r].value("name", "") == set.name && text["regions"][r].value("box", Json()) == wanted)
            return r;
    const auto stated =
        std::find_if(plan.regions.begin(), plan.regions.end(), [&](const Region& r) { return r.name == set.name; });
    throw InputError(stated == plan.regions.end() ? SourceLocation{path, 0, 0} : stated->at,
        fmt::format("the moments in {} have no region '{}' of this box: expected one that was stated when the baseline "
                    "was accepted; accept the view again",
            path, set.name));
}

/// Returns the k-th of `count` values with this mean and this standard deviation.
double spread_out(double mean, double deviation, std::size_t k, std::size_t count) {
    const double n = static_cast<double>(count), at = static_cast<double>(k) - (n - 1) / 2;
    return count > 1 ? mean + deviation * at / std::sqrt(n * (n + 1) / 12) : mean;
}

TileReading tile_mean(const RenderStats& all, const MeanPlane& plane, std::size_t tile, double renders) {
    const Box box = all.tiles.box(tile, all.width, all.height);
    TileReading out;
    double pixels = 0;
    for (int y = box.y0; y <= box.y1; ++y)
        for (int x = box.x0; x <= box.x1; ++x) {
            const auto i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(all.width) + static_cast<std::size_t>(x);
            if (all.bad[i]) continue;
            out.mean += plane.mean[i], out.spread += plane.m2[i] / renders, pixels += 1;
        }
    out.mean /= pixels, out.spread /= pixels;
    return out;
}

}  // namespace

void read_moments_regions(const std::string& path, const ComparePlan& plan, const RenderStats& all, ArmStats& to) {
    const std::size_t renders = to.files.size(), stored = to.film.planes.size();
    with_file(path, [&](Imf::InputFile& file) {
        const Imf::Header& header = file.header();
        const Json text = header_json(path, header);
        to.regions.assign(renders, std::vector<RegionStats>(all.regions.size()));
        to.quantities.assign(all.quantities, {});
        to.power.assign(all.regions.size(), {});
        if (!to.not_finite.empty()) to.failed_groups.assign(renders, std::vector<std::uint32_t>(all.regions.size()));
        for (QuantityReadings& q : to.quantities)
            q.regions.assign(renders, std::vector<double>(all.regions.size())),
                q.tiles.assign(renders, std::vector<TileReading>(all.tiles.count()));
        for (std::size_t r = 0; r < all.regions.size(); ++r) {
            const std::size_t at = region_in(path, text, all, all.regions[r], plan);
            const std::vector<double> spread = take(path, header, attribute_name("spread", at, 0), renders);
            to.power[r] = take(path, header, attribute_name("power", at, 0), 0);
            for (std::size_t q = 0; q < all.quantities; ++q) {
                const std::size_t from = q < stored ? q : 0;
                const std::vector<double> means = take(path, header, attribute_name("means", at, from), renders),
                                          largest = take(path, header, attribute_name("largest", at, from), 0);
                for (std::size_t k = 0; k < renders; ++k) to.quantities[q].regions[k][r] = means[k];
                to.quantities[q].largest.emplace_back(largest.begin(), largest.end());
                for (std::size_t k = 0; q == 0 && k < renders; ++k)
                    to.regions[k][r].y = means[k], to.regions[k][r].spread = spread[k];
            }
            to.largest.push_back(to.quantities[0].largest[r]);
            if (to.not_finite.empty()) continue;
            const std::vector<double> groups = take(path, header, attribute_name("groups", at, 0), renders);
            for (std::size_t k = 0; k < renders; ++k) to.failed_groups[k][r] = static_cast<std::uint32_t>(groups[k]);
        }
        for (std::size_t q = 0; q < all.quantities; ++q) {
            const std::size_t from = q < stored ? q : 0, tiles = all.tiles.count();
            const std::vector<double> deviations = take(path, header, attribute_name("tiles", 0, from), tiles),
                                      largest = take(path, header, attribute_name("tiles", 1, from), tiles),
                                      events = take(path, header, attribute_name("events", 0, from), 2);
            QuantityReadings& readings = to.quantities[q];
            readings.rise = events[0], readings.fall = events[1];
            for (std::size_t t = 0; t < tiles; ++t) {
                const TileReading mean = tile_mean(all, to.film.of(q), t, static_cast<double>(renders));
                for (std::size_t k = 0; k < renders; ++k)
                    readings.tiles[k][t] = {
                        spread_out(mean.mean, deviations[t], k, renders), mean.spread, k == 0 ? largest[t] : 0};
            }
        }
    });
}

}  // namespace crescent::inline comparison
