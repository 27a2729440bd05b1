// Converts renders so that they can be compared pixel by pixel: all in one window and in the primaries of the first,
// with the same pixels each time they are read.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "images/open_file.h"
#include "images/primaries.h"

namespace crescent {

class CommonView {
public:
    using Read = std::function<Render(const std::string& path, const std::string& layer)>;
    CommonView(const ComparePlan& plan, Read read) : crop_(plan.crop), align_(plan.align), read_(std::move(read)) {}

    /// Intersects the window of all renders with a render's data window; for --crop, before the first read().
    void share(const std::string& path, const std::string& layer);
    /// Reads a render. The first one sets size, windows and primaries. Throws InputError if another does not fit, and
    /// if a file changed since it was read before.
    Render read(const std::string& path, const std::string& layer);
    /// Reads a mask of the size of the renders, regardless of the origin of its windows.
    Render read_mask(const std::string& path);
    const Chromaticities& primaries() const { return first_.primaries; }

private:
    /// The state of a file at its first reading.
    struct Reading {
        FileState state;
        int width = 0, height = 0;
        std::uint64_t hash = 0;
    };
    PixelWindow window_for(const Render& render) const;
    void check_fits(const Render& render) const;
    void convert_primaries(Render& render) const;
    void check_unchanged(const Render& render, const std::string& layer);

    bool crop_;
    Alignment align_;
    Read read_;
    Render first_;  // without pixels; file "": nothing was read
    PixelWindow shared_;
    std::string shared_of_;
    std::map<std::pair<std::string, std::string>, Reading> first_readings_;  // path, layer
    Mutex lock_;
};

}  // namespace crescent
