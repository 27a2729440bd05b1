// Renders that are held in memory, for tests that change single pixels.
#pragma once

#include <map>
#include <string>

#include "compare/compare.h"
#include "tests/support/synthetic_renders.h"

namespace crescent {

/// Renders by name; all of arm "a" begin with a, of "b" with b.
class MemoryRenders {
public:
    /// A grey render of normal noise of 10 %, mean 1, `side` pixels per side.
    Render& put(const std::string& name, std::uint32_t seed, int side = 16) {
        Render r(name, side, side);
        for (std::size_t i = 0; i < r.size(); ++i)
            r.r[i] = r.g[i] = r.b[i] = static_cast<float>(
                synthetic_pixel({SyntheticNoise::Kind::normal, 0.1}, seed, static_cast<std::uint32_t>(i), side));
        return renders[name] = r;
    }
    /// A grey render with these values, rows of `width` pixels from the bottom.
    Render& put_grey(const std::string& name, int width, const std::vector<float>& values) {
        Render r(name, width, static_cast<int>(values.size()) / width);
        r.r = r.g = r.b = values;
        return renders[name] = r;
    }
    RenderStats read(std::vector<CompareFlag> flags = {}) const {
        ProgressMonitor monitor;
        return read_all(plan(std::move(flags)), monitor, source());
    }
    CompareResult compare(const std::vector<CompareFlag>& flags = {}) const {
        ProgressMonitor monitor;
        const ComparePlan planned = plan(flags);
        return test_differences(planned, read_all(planned, monitor, source()), monitor);
    }
    ComparePlan plan(std::vector<CompareFlag> flags = {}) const {
        for (const char* arm : {"a", "b"})
            if (renders.lower_bound(arm) != renders.end() && renders.lower_bound(arm)->first.starts_with(arm))
                flags.push_back({{"arms", arm, "files"}, arm, false, arm});
        return plan_of(flags);
    }
    std::map<std::string, Render> renders;

private:
    RenderSource source() const {
        RenderSource out;
        out.expand = [this](const std::vector<std::string>& names, const SourceLocation&) {
            std::vector<std::string> found;
            for (const auto& [name, render] : renders)
                if (name.starts_with(names[0])) found.push_back(name);
            return found;
        };
        out.read = [this](const std::string& name, const std::string&) { return renders.at(name); };
        return out;
    }
};

}  // namespace crescent
