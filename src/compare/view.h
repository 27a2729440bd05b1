// Renders made fit to be compared pixel by pixel: all in one window, in the primaries of the first, and with the same
// pixels whenever they are read again.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "base/parallel.h"
#include "compare/plan.h"
#include "compare/renders.h"

namespace crescent::inline comparison {

class CommonView {
public:
    using Read = std::function<Render(const std::string& path, const std::string& layer)>;
    CommonView(const ComparePlan& plan, Read read) : crop_(plan.crop), align_(plan.align), read_(std::move(read)) {}

    /// With --crop, before the first read(): the window of all is what their data windows share.
    void share(const std::string& path, const std::string& layer);
    /// The first render sets size, windows and primaries. Throws InputError where another does not fit, and where a
    /// file is no longer what it was when it was read before.
    Render read(const std::string& path, const std::string& layer);
    /// A picture of the size of the renders, wherever its own windows are.
    Render read_mask(const std::string& path);
    const Chromaticities& primaries() const { return first_.primaries; }

private:
    /// What a file was at its first reading.
    struct Known {
        FileState state;
        int width = 0, height = 0;
        std::uint64_t hash = 0;
    };
    PixelWindow window_for(const Render& render) const;
    void check_fits(const Render& render) const;
    void convert_primaries(Render& render) const;
    void check_known(const Render& render, const std::string& layer);

    bool crop_;
    Alignment align_;
    Read read_;
    Render first_;  // without its pixels; file "": none yet
    PixelWindow shared_;
    std::string shared_of_;
    std::map<std::pair<std::string, std::string>, Known> known_;  // path, layer
    Mutex lock_;
};

}  // namespace crescent::inline comparison
