// Reads moments as if a stranger had written them: sizes before memory, types before use, finite numbers. The tests
// receive values with the mean and the variance of the renders: tests of means depend on nothing else. Which renders
// share random numbers is unknown.
#include "compare/moments_reading.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <span>

#include "base/errors.h"
#include "compare/moments.h"
#include "compare/noise.h"
#include "compare/renders.h"
#include "images/exr_file.h"
#include "output/format.h"

namespace crescent {

namespace {

constexpr std::size_t longest_text = std::size_t{1} << 20, regions_most = 4096;
constexpr int deepest = 8;  // the text has four levels

class TextReader {
public:
    TextReader(const std::string& file, const Json& root) : file_(file), root_(root) {}

    [[noreturn]] void fail(const std::string& message) const {
        throw InputError({file_, 0, 0}, fmt::format("attribute '{}': {}", moments_text, message));
    }
    const Json& member(const Json& table, const char* key) const {
        const auto entry = table.is_object() ? table.find(key) : table.end();
        if (!table.is_object() || entry == table.end()) fail(fmt::format("expected a key '{}'", key));
        return *entry;
    }
    std::size_t whole_number(const char* key, std::size_t smallest, std::size_t largest) const {
        const Json& value = member(root_, key);
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() < smallest ||
            value.get<std::uint64_t>() > largest)
            fail(fmt::format("{}: expected a whole number from {} to {}", key, smallest, largest));
        return value.get<std::size_t>();
    }
    MomentsRegion region(const Json& value, int width, int height) const {
        MomentsRegion out;
        const Json &name = member(value, "name"), &box = member(value, "box");
        if (!name.is_string()) fail("regions: expected a name");
        out.name = name.get<std::string>();
        const bool is_box = box.is_array() && box.size() == 4 && std::all_of(box.begin(), box.end(), [](const Json& x) {
            return x.is_number_integer() && x.get<std::int64_t>() >= 0 && x.get<std::int64_t>() < most_pixels_a_side;
        });
        if (!is_box) fail("regions: expected a box of four numbers");
        out.box = {box[0].get<int>(), box[1].get<int>(), box[2].get<int>(), box[3].get<int>()};
        if (out.box.x0 > out.box.x1 || out.box.y0 > out.box.y1 || out.box.x1 >= width || out.box.y1 >= height)
            fail(fmt::format("regions: expected boxes in {} x {} pixels", width, height));
        return out;
    }

private:
    const std::string& file_;
    const Json& root_;
};

}  // namespace

std::string moments_attribute(const char* kind, std::size_t region, std::size_t quantity) {
    return fmt::format("crescent.{}.{}.{}", kind, region, quantity);
}

MomentsText parse_moments_text(const std::string& text, const std::string& file, int width, int height) {
    const auto check_depth = [](int depth, Json::parse_event_t, const Json&) {
        if (depth > deepest) throw std::length_error("expected fewer levels");
        return true;
    };
    Json root;
    try {
        if (text.size() <= longest_text) root = Json::parse(text, check_depth, false);
    } catch (const std::length_error&) { root = Json::value_t::discarded; }
    const TextReader reader(file, root);
    if (!root.is_object() || reader.member(root, "format") != moments_format)
        reader.fail(fmt::format("expected '{}'", moments_format));
    MomentsText out;
    out.renders = reader.whole_number("renders", 1, moments_renders_most);
    out.quantities = reader.whole_number("quantities", 1, colour_quantities);
    if (out.quantities != 1 && out.quantities != colour_quantities)
        reader.fail(fmt::format("quantities: expected 1 or {}", colour_quantities));
    const Json &constant = reader.member(root, "constant"), &rounding = reader.member(root, "rounding"),
               &regions = reader.member(root, "regions");
    if (!constant.is_boolean()) reader.fail("constant: expected true or false");
    out.constant = constant.get<bool>();
    if (!rounding.is_number()) reader.fail("rounding: expected a number");
    out.rounding = rounding.get<double>();
    if (!(out.rounding >= 0 && out.rounding <= 1)) reader.fail("rounding: expected a number from 0 to 1");
    if (root.contains("levels")) {  // of files of whole numbers
        out.steps.levels = static_cast<double>(reader.whole_number("levels", 2, 65536));
        const Json& srgb = reader.member(root, "srgb");
        if (!srgb.is_boolean()) reader.fail("srgb: expected true or false");
        out.steps.srgb = srgb.get<bool>();
    }
    if (!regions.is_array() || regions.empty() || regions.size() > regions_most)
        reader.fail(fmt::format("regions: expected a list of 1 to {}", regions_most));
    for (const Json& region : regions) out.regions.push_back(reader.region(region, width, height));
    return out;
}

namespace {

/// A file of moments, open.
class MomentsFile {
public:
    explicit MomentsFile(const std::string& path) : file_(path), exr_(file_) {
        if (exr_.parts().size() != 1 || part().deep || part().tiled)
            file_.fail("expected moments: one part of scan lines");
        if (part().data != part().display || part().data.x0 != 0 || part().data.y0 != 0)
            file_.fail("expected moments in a data window and a display window that are equal and begin at (0, 0)");
        text_ = parse_moments_text(attribute(moments_text).text, path, width(), height());
    }

    int width() const { return static_cast<int>(part().data.width()); }
    int height() const { return static_cast<int>(part().data.height()); }
    const MomentsText& text() const { return text_; }
    [[noreturn]] void fail(const std::string& message) const { file_.fail(message); }
    bool has(const std::string& channel) const { return part().channel(channel) != nullptr; }

    /// Returns the finite numbers of an attribute. Throws InputError unless there are `count` of them.
    std::vector<double> numbers(const std::string& name, std::size_t count) const {
        const std::vector<double> out = finite_numbers(name);
        if (out.size() != count)
            fail(fmt::format("attribute '{}': expected {} numbers, found {}", name, count, out.size()));
        return out;
    }
    /// Returns the finite numbers of an attribute, none of them negative.
    std::vector<double> sizes(const std::string& name, std::size_t count) const {
        return not_negative(name, numbers(name, count));
    }
    std::vector<double> any_sizes(const std::string& name) const { return not_negative(name, finite_numbers(name)); }

    /// Returns channels in their order, rows bottom-up.
    std::vector<std::vector<float>> planes(const std::vector<std::string>& names) const {
        for (const std::string& name : names) {
            const ExrChannel* channel = part().channel(name);
            if (!channel || channel->x_sampling != 1 || channel->y_sampling != 1)
                fail(fmt::format("expected a channel '{}' with a value for each pixel", name));
        }
        return exr_.read(part(), names);
    }
    /// Throws InputError with the first pixel of a channel whose value is not allowed.
    template <class Allowed>
    void expect(const char* channel, std::span<const float> values, const Allowed& allowed) const {
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!allowed(i))
                fail(fmt::format("channel '{}': found {} at ({}, {})", channel, values[i],
                    i % static_cast<std::size_t>(width()), i / static_cast<std::size_t>(width())));
    }

private:
    const ExrPart& part() const { return exr_.parts()[0]; }
    const ExrAttribute& attribute(const std::string& name) const {
        const auto& attributes = part().attributes;
        const auto match =
            std::find_if(attributes.begin(), attributes.end(), [&](const ExrAttribute& a) { return a.name == name; });
        if (match == attributes.end()) fail(fmt::format("expected an attribute '{}', found none", name));
        return *match;
    }
    std::vector<double> finite_numbers(const std::string& name) const {
        const std::vector<float>& values = attribute(name).numbers;
        if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); }))
            fail(fmt::format("attribute '{}': expected finite numbers", name));
        return {values.begin(), values.end()};
    }
    std::vector<double> not_negative(const std::string& name, std::vector<double> values) const {
        if (std::any_of(values.begin(), values.end(), [](double x) { return x < 0; }))
            fail(fmt::format("attribute '{}': expected no negative numbers", name));
        return values;
    }

    OpenFile file_;
    ExrFile exr_;
    MomentsText text_;
};

bool is_whole(double x, double limit) { return x >= 0 && x <= limit && x == std::floor(x); }

}  // namespace

MomentsHeader read_moments_header(const std::string& path) {
    const MomentsFile file(path);
    return {file.text().renders, file.text().constant};
}

namespace {

/// Reads the renders in which each pixel is not finite.
void read_failures(const MomentsFile& file, RenderStats& stats, ArmStats& to) {
    if (!file.has("failed.N")) return;
    const std::vector<float> failure_counts = file.planes({"failed.N"})[0];
    const auto renders = static_cast<double>(file.text().renders);
    file.expect("failed.N", failure_counts,
        [&](std::size_t i) { return is_whole(static_cast<double>(failure_counts[i]), renders); });
    to.not_finite.assign(failure_counts.size(), 0);
    for (std::size_t i = 0; i < failure_counts.size(); ++i) {
        to.not_finite[i] = static_cast<std::uint32_t>(failure_counts[i]);
        if (failure_counts[i] > 0) stats.bad[i] = true;
    }
}

/// Reads the means of a quantity; only a pixel that fails in some render may be not finite.
std::vector<double> read_means(const MomentsFile& file, const char* channel, const ArmStats& to) {
    const std::vector<float> means = file.planes({channel})[0];
    file.expect(channel, means,
        [&](std::size_t i) { return std::isfinite(means[i]) || (!to.not_finite.empty() && to.not_finite[i] > 0); });
    return {means.begin(), means.end()};
}

/// Reads a channel of variances or deviations.
std::vector<float> read_spreads(const MomentsFile& file, const std::string& channel) {
    std::vector<float> out = file.planes({channel})[0];
    file.expect(channel.c_str(), out, [&](std::size_t i) { return std::isfinite(out[i]) && out[i] >= 0; });
    return out;
}

}  // namespace

void read_moments_film(const std::string& path, const Rgb& weights, RenderStats& stats, ArmStats& to) {
    const MomentsFile file(path);
    if (file.width() != stats.width || file.height() != stats.height)
        file.fail(fmt::format("expected moments of {} x {} pixels, found {} x {}", stats.width, stats.height,
            file.width(), file.height()));
    const std::size_t pixels = stats.bad.size();
    const bool grey = file.text().quantities == 1;
    const double scale = file.sizes(moments_scale, 1)[0], degrees = static_cast<double>(file.text().renders - 1);
    read_failures(file, stats, to);
    MeanFilm& film = to.film;
    film.count = file.text().renders;
    film.rounding = file.text().rounding;
    film.steps = file.text().steps;
    film.planes.assign(grey ? 1 : colour_quantities, {});
    for (std::size_t q = grey ? 0 : 1; q < film.planes.size(); ++q) {
        film.planes[q].mean = read_means(file, quantity_names[q], to);
        if (q == 0) continue;
        for (const float d : read_spreads(file, fmt::format("deviation.{}", quantity_names[q])))
            film.planes[q].m2.push_back(degrees * scale * scale * static_cast<double>(d) * static_cast<double>(d));
    }
    if (!grey) {
        film.planes[0].mean.resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i)  // rounded as Render::y() is
            film.planes[0].mean[i] = static_cast<double>(static_cast<float>(weights[0] * film.planes[1].mean[i] +
                weights[1] * film.planes[2].mean[i] + weights[2] * film.planes[3].mean[i]));
    }
    for (const float v : read_spreads(file, "variance.Y"))
        film.planes[0].m2.push_back(degrees * static_cast<double>(v));
    for (std::size_t k = 0; k < film.count; ++k) {
        RenderFile& render = to.files.emplace_back();
        render.path = path;
        render.hash = fmt::format("moments {}", k);
    }
}

namespace {

/// Returns the index of a region of `stats` among those of the file.
std::size_t region_in(const std::string& path, const MomentsText& text, const RenderStats& stats, const PixelSet& set,
    const ComparePlan& plan) {
    const Box box = set.box.value_or(stats.frame());
    for (std::size_t r = 0; r < text.regions.size(); ++r) {
        const Box& stored_box = text.regions[r].box;
        if (text.regions[r].name == set.name && stored_box.x0 == box.x0 && stored_box.y0 == box.y0 &&
            stored_box.x1 == box.x1 && stored_box.y1 == box.y1)
            return r;
    }
    const auto region =
        std::find_if(plan.regions.begin(), plan.regions.end(), [&](const Region& r) { return r.name == set.name; });
    throw InputError(region == plan.regions.end() ? SourceLocation{path, 0, 0} : region->location,
        fmt::format("the moments in {} have no region '{}' of this box: expected one that was stated when the baseline "
                    "was accepted; accept the view again",
            path, set.name));
}

/// Returns the k-th of `count` values with this mean and this standard deviation.
double spread_out(double mean, double deviation, std::size_t k, std::size_t count) {
    const double n = static_cast<double>(count), rank = static_cast<double>(k) - (n - 1) / 2;
    return count > 1 ? mean + deviation * rank / std::sqrt(n * (n + 1) / 12) : mean;
}

TileReading tile_mean(const RenderStats& stats, const MeanPlane& plane, std::size_t tile, double renders) {
    const Box box = stats.tiles.box(tile, stats.width, stats.height);
    TileReading out;
    double pixels = 0;
    for (int y = box.y0; y <= box.y1; ++y)
        for (int x = box.x0; x <= box.x1; ++x) {
            const auto i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(stats.width) + static_cast<std::size_t>(x);
            if (stats.bad[i]) continue;
            out.mean += plane.mean[i];
            out.spread += plane.m2[i] / renders;
            pixels += 1;
        }
    out.mean /= pixels;
    out.spread /= pixels;
    return out;
}

}  // namespace

namespace {

/// Reads the statistics of one region into the r-th of `to`.
void read_region(
    const MomentsFile& file, std::size_t stored_region, std::size_t r, std::size_t stored_planes, ArmStats& to) {
    const std::size_t renders = to.files.size();
    const std::vector<double> spread = file.sizes(moments_attribute("spread", stored_region, 0), renders);
    to.power[r] = file.any_sizes(moments_attribute("power", stored_region, 0));
    if (!to.power[r].empty() && to.power[r].size() != static_cast<std::size_t>(spectrum_bins))
        file.fail(fmt::format("attribute '{}': expected {} numbers or none",
            moments_attribute("power", stored_region, 0), spectrum_bins));
    for (std::size_t q = 0; q < to.quantities.size(); ++q) {
        const std::size_t from = q < stored_planes ? q : 0;
        const std::vector<double> means = file.numbers(moments_attribute("means", stored_region, from), renders),
                                  largest = file.any_sizes(moments_attribute("largest", stored_region, from));
        for (std::size_t k = 0; k < renders; ++k) to.quantities[q].regions[k][r] = means[k];
        to.quantities[q].largest.emplace_back(largest.begin(), largest.end());
        if (!std::is_sorted(largest.rbegin(), largest.rend()))
            file.fail(fmt::format(
                "attribute '{}': expected descending numbers", moments_attribute("largest", stored_region, from)));
        for (std::size_t k = 0; q == 0 && k < renders; ++k) {
            to.regions[k][r].y = means[k];
            to.regions[k][r].spread = spread[k];
        }
    }
    to.largest.push_back(to.quantities[0].largest[r]);
    if (to.not_finite.empty()) return;
    const std::string name = moments_attribute("groups", stored_region, 0);
    const std::vector<double> groups = file.sizes(name, renders);
    const double pixels = static_cast<double>(file.width()) * file.height();
    for (std::size_t k = 0; k < renders; ++k) {
        if (!is_whole(groups[k], pixels)) file.fail(fmt::format("attribute '{}': expected counts of pixels", name));
        to.failed_groups[k][r] = static_cast<std::uint32_t>(groups[k]);
    }
}

void read_tiles(
    const MomentsFile& file, const RenderStats& stats, std::size_t q, std::size_t stored_quantity, ArmStats& to) {
    const std::size_t tiles = stats.tiles.count(), renders = to.files.size();
    const std::vector<double> deviations = file.sizes(moments_attribute("tiles", 0, stored_quantity), tiles),
                              largest = file.sizes(moments_attribute("tiles", 1, stored_quantity), tiles),
                              events = file.sizes(moments_attribute("events", 0, stored_quantity), 2);
    QuantityReadings& readings = to.quantities[q];
    readings.rise = events[0];
    readings.fall = events[1];
    readings.tiles.assign(renders, std::vector<TileReading>(tiles));
    for (std::size_t t = 0; t < tiles; ++t) {
        const TileReading mean = tile_mean(stats, to.film.of(q), t, static_cast<double>(renders));
        for (std::size_t k = 0; k < renders; ++k)
            readings.tiles[k][t] = {
                spread_out(mean.mean, deviations[t], k, renders), mean.spread, k == 0 ? largest[t] : 0};
    }
}

}  // namespace

void read_moments_regions(const std::string& path, const ComparePlan& plan, const RenderStats& stats, ArmStats& to) {
    const std::size_t renders = to.files.size(), stored_planes = to.film.planes.size();
    const MomentsFile file(path);
    if (file.text().renders != renders || file.width() != stats.width || file.height() != stats.height)
        file.fail("the file was changed while it was read");
    to.regions.assign(renders, std::vector<RegionStats>(stats.regions.size()));
    to.quantities.assign(stats.quantities, {});
    to.power.assign(stats.regions.size(), {});
    if (!to.not_finite.empty()) to.failed_groups.assign(renders, std::vector<std::uint32_t>(stats.regions.size()));
    for (QuantityReadings& q : to.quantities) q.regions.assign(renders, std::vector<double>(stats.regions.size()));
    for (std::size_t r = 0; r < stats.regions.size(); ++r)
        read_region(file, region_in(path, file.text(), stats, stats.regions[r], plan), r, stored_planes, to);
    for (std::size_t q = 0; q < stats.quantities; ++q) read_tiles(file, stats, q, q < stored_planes ? q : 0, to);
}

}  // namespace crescent
