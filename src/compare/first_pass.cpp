// First pass: every render is read, checked against the others and added to its arm's mean.
#include "compare/first_pass.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "compare/second_pass.h"

namespace crescent::inline comparing {

Tiles::Tiles(int width, int height) {
    const double wanted = std::sqrt(static_cast<double>(width) * height / 512);
    size = std::max(8, static_cast<int>(std::ceil(wanted)));
    across = (width + size - 1) / size, down = (height + size - 1) / size;
}

Box Tiles::box(std::size_t tile, int width, int height) const {
    const int i = static_cast<int>(tile) % across * size, j = static_cast<int>(tile) / across * size;
    return {i, j, std::min(width, i + size) - 1, std::min(height, j + size) - 1};
}

namespace {

/// "seed%04d.exr" as a pattern: any digits stand where %d, %4d or %04d does. The text before and after is kept as it
/// is.
struct Digits {
    std::string before, after;
};
std::optional<Digits> digits_in(const std::string& pattern) {
    const std::size_t percent = pattern.find('%');
    if (percent == std::string::npos) return {};
    const std::size_t end = pattern.find_first_not_of("0123456789", percent + 1);
    if (end == std::string::npos || pattern[end] != 'd') return {};
    return Digits{pattern.substr(0, percent), pattern.substr(end + 1)};
}

std::vector<std::string> globbed(const std::string& pattern) {
    std::error_code ignored;
    if (std::filesystem::exists(pattern, ignored)) return {pattern};  // "render[1].exr" may be a name
    glob_t found{};
    const int failed = ::glob(pattern.c_str(), GLOB_ERR, nullptr, &found);
    std::vector<std::string> paths;
    for (std::size_t i = 0; failed == 0 && i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
    ::globfree(&found);
    return paths;
}

std::vector<std::string> matching(const std::string& pattern) {
    const std::optional<Digits> digits = digits_in(pattern);
    if (!digits) return globbed(pattern);
    std::vector<std::string> paths = globbed(digits->before + "*" + digits->after);
    if ((digits->before + digits->after).find_first_of("*?[") != std::string::npos) return paths;
    std::erase_if(paths, [&](const std::string& path) {  // what stands for the * is digits alone
        const std::size_t from = digits->before.size(), to = path.size() - digits->after.size();
        return to <= from || path.find_first_not_of("0123456789", from) < to;
    });
    return paths;
}

}  // namespace

std::vector<std::string> expand(const std::vector<std::string>& patterns, const SourceLocation& at) {
    std::vector<std::string> out;
    for (const std::string& pattern : patterns) {
        const std::vector<std::string> paths = matching(pattern);
        if (paths.empty()) throw InputError(at, fmt::format("expected files that match '{}', found none", pattern));
        out.insert(out.end(), paths.begin(), paths.end());
    }
    std::sort(out.begin(), out.end());
    for (std::size_t i = 1; i < out.size(); ++i)
        if (out[i] == out[i - 1]) throw InputError(at, fmt::format("the file '{}' is named twice", out[i]));
    return out;
}

namespace {

std::vector<std::uint64_t> numbers_in(const std::string& path) {
    const std::string name = std::filesystem::path(path).replace_extension().string();  // folders may tell seeds
    std::vector<std::uint64_t> out;
    for (std::size_t i = 0; i < name.size();) {
        if (name[i] < '0' || name[i] > '9') {
            ++i;
            continue;
        }
        std::uint64_t value = 0;
        for (; i < name.size() && name[i] >= '0' && name[i] <= '9'; ++i)
            value = value * 10 + static_cast<std::uint64_t>(name[i] - '0');
        out.push_back(value);
    }
    return out;
}

bool all_equal(const Render& render) {
    const auto same = [](const std::vector<float>& p) {
        return std::all_of(p.begin(), p.end(), [&](float v) { return v == p[0]; });
    };
    return same(render.r) && same(render.g) && same(render.b);
}

}  // namespace

void FirstPass::arm(ArmReadings& to, const std::vector<std::string>& files, const std::string& layer,
    const std::string& name, const std::optional<double>& spp) {
    each_render(all_.source, files, layer, monitor_, [&](const Render& render) {
        fit(render);
        look(render, to);
        RenderFile file{render.file, fmt::format("{:016x}", render.hash), render.layer, render.variance_channels,
            render.sample_channel, render.spp, render.seconds, numbers_in(render.file)};
        known(file, name);
        const std::optional<double>& samples = spp ? spp : render.spp;
        if (render.per_sample && !samples)
            warnings_.add(render.file,
                fmt::format("{} is the variance of one sample, and nothing says how many there are: give --spp",
                    render.variance_channels));
        to.film.add(render, !render.per_sample ? 1 : samples ? 1 / *samples : 0);
        to.files.push_back(std::move(file));
    });
}

void FirstPass::fit(const Render& render) {
    if (all_.bad.empty()) {
        all_.width = render.width, all_.height = render.height;
        all_.bad.assign(render.size(), false);
    }
    ensure(render.width == all_.width && render.height == all_.height, "renders of a view have one size");
}

void FirstPass::look(const Render& render, ArmReadings& to) {
    std::uint64_t bad = 0, negative = 0;
    for (std::size_t i = 0; i < render.size(); ++i) {
        const bool finite = std::isfinite(render.r[i]) && std::isfinite(render.g[i]) && std::isfinite(render.b[i]);
        if (!finite) {
            if (to.not_finite.empty()) to.not_finite.assign(render.size(), 0);
            ++bad, all_.bad[i] = true, ++to.not_finite[i];
        }
        negative += finite && (render.r[i] < 0 || render.g[i] < 0 || render.b[i] < 0);
    }
    for (const std::string& note : render.notes) warnings_.add(render.file, note);
    if (bad) warnings_.add(render.file, "not finite: left out of every meter", bad);
    if (negative) warnings_.add(render.file, "with a negative channel", negative);
    if (render.size() > 1 && bad < render.size() && all_equal(render))
        warnings_.add(render.file, "all pixels are equal");
}

void FirstPass::known(const RenderFile& file, const std::string& arm) {
    const auto [before, fresh] = seen_.emplace(file.hash, std::pair{file.path, arm});
    if (fresh) return;
    const auto& [path, other] = before->second;
    if (other == arm)
        throw InputError(
            {file.path, 0, 0}, fmt::format("the same pixels as {}: renders of an arm must be independent", path));
    warnings_.add(fmt::format("{} of {}", file.path, arm), fmt::format("the same pixels as {} of {}", path, other), 0,
        fmt::format("the same pixels as {}", other));
}

}  // namespace crescent::inline comparing
