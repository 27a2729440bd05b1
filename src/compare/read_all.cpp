// Every render twice: means first, then what each says of each region, mask and tile.
#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <memory>

#include "compare/common_view.h"
#include "compare/first_pass.h"
#include "compare/quantities.h"
#include "compare/schema.h"
#include "compare/second_pass.h"

namespace crescent::inline comparing {

namespace {

void add_set(Readings& all, PixelSet set, const SourceLocation& at) {
    if (set.pixels.empty()) throw InputError(at, set.name + ": expected a pixel above 0, found none");
    const auto bad = [&](std::uint32_t i) { return all.bad[i]; };
    std::copy_if(set.pixels.begin(), set.pixels.end(), std::back_inserter(set.left_out), bad);
    std::erase_if(set.pixels, bad);
    all.regions.push_back(std::move(set));
}

PixelSet boxed(const std::string& name, const Box& box, int width) {
    PixelSet set{name, box, {}, {}};
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i) set.pixels.push_back(static_cast<std::uint32_t>(j * width + i));
    return set;
}

PixelSet masked(CommonView& view, const MaskPlan& plan) {
    const Render mask = view.read_mask(plan.file);
    PixelSet set{plan.name, {}, {}, {}};
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask.y(i) > 0) set.pixels.push_back(static_cast<std::uint32_t>(i));
    return set;
}

void regions(const ComparePlan& plan, Readings& all, CommonView& view) {
    for (const Region& r : plan.regions) {
        if (r.box.x1 >= all.width || r.box.y1 >= all.height)
            throw InputError(r.at,
                fmt::format("regions.{}.box: expected a box on the image, x from 0 to {} and y from 0 to {}, found "
                            "[{}, {}, {}, {}]",
                    r.name, all.width - 1, all.height - 1, r.box.x0, r.box.y0, r.box.x1, r.box.y1));
        add_set(all, boxed(r.name, r.box, all.width), r.at);
    }
    for (const MaskPlan& m : plan.masks) add_set(all, masked(view, m), m.at);
    add_set(all, boxed(whole_frame, all.frame(), all.width), {plan.file, 0, 0});
}

/// Y alone where every render is grey.
std::size_t quantities_of(const Readings& all) {
    const auto in_colour = [](const ArmReadings& arm) { return arm.film.planes.size() > 1; };
    const bool any = std::any_of(all.arms.begin(), all.arms.end(), in_colour);
    return any || (all.reference && in_colour(*all.reference)) ? colour_quantities : 1;
}

}  // namespace

void each_render(const RenderSource& source, const std::vector<std::string>& paths, const std::string& layer,
    ProgressMonitor& monitor, const std::function<void(const Render&)>& use) {
    const auto start = [&](std::size_t k) {
        return std::async(std::launch::async, [&source, &layer, path = paths[k]] { return source.read(path, layer); });
    };
    std::future<Render> next = start(0);
    for (std::size_t k = 0; k < paths.size(); ++k) {
        const Render render = next.get();
        monitor.check();
        if (k + 1 < paths.size()) next = start(k + 1);
        use(render);
        monitor.advance(1);
    }
}

Render in_rec709(const Readings& all, Render render) {
    if (!same_primaries(all.primaries, {})) convert(render, conversion(all.primaries, {}));
    render.primaries = {}, render.weights = luminance_weights_of({});
    return render;
}

Render in_rec709(const Readings& all, const MeanFilm& film) {
    Render out("", all.width, all.height, Render::empty);
    out.r = film.radiance(0), out.g = film.radiance(1), out.b = film.radiance(2);
    return in_rec709(all, std::move(out));
}

namespace {

/// The files of every arm, then those of the reference.
struct Files {
    std::vector<std::vector<std::string>> arms;
    std::vector<std::string> reference;
    std::size_t total = 0;
};

Files files_of(const ComparePlan& plan, const RenderSource& source) {
    Files out;
    for (const RenderArm& arm : plan.arms) out.arms.push_back(source.expand(arm.files, arm.at));
    if (!plan.reference.empty()) out.reference = source.expand(plan.reference, {plan.file, 0, 0});
    for (const auto& files : out.arms) out.total += files.size();
    out.total += out.reference.size();
    return out;
}

void share_windows(CommonView& view, const ComparePlan& plan, const Files& files, ProgressMonitor& monitor) {
    monitor.begin("data windows", static_cast<double>(files.total));
    const auto each = [&](const std::vector<std::string>& paths, const std::string& layer) {
        for (const std::string& path : paths) monitor.check(), view.share(path, layer), monitor.advance(1);
    };
    for (std::size_t a = 0; a < files.arms.size(); ++a) each(files.arms[a], plan.arms[a].layer);
    each(files.reference, plan.reference_layer);
}

}  // namespace

Readings read_all(const ComparePlan& plan, ProgressMonitor& monitor, const RenderSource& source) {
    Readings all;
    const Files files = files_of(plan, source);
    const auto view = std::make_shared<CommonView>(plan, source.read);
    if (plan.crop) share_windows(*view, plan, files, monitor);
    all.source = source;
    all.source.read = [view](const std::string& path, const std::string& layer) { return view->read(path, layer); };
    monitor.begin("first pass: means", static_cast<double>(files.total));
    FirstPass first(all, monitor);
    all.arms.resize(plan.arms.size());
    for (std::size_t a = 0; a < plan.arms.size(); ++a)
        first.arm(all.arms[a], files.arms[a], plan.arms[a].layer, plan.arms[a].name, plan.arms[a].spp);
    if (!files.reference.empty())
        first.arm(all.reference.emplace(), files.reference, plan.reference_layer, "the reference", {});
    first.report_warnings();
    all.primaries = view->primaries();
    all.tiles = Tiles(all.width, all.height);
    all.bad_pixels = static_cast<std::uint64_t>(std::count(all.bad.begin(), all.bad.end(), true));
    all.quantities = quantities_of(all);
    regions(plan, all, *view);
    monitor.begin("second pass: what each render says", static_cast<double>(files.total));
    const MeanFilm* truth = all.reference ? &all.reference->film : nullptr;
    for (std::size_t a = 0; a < plan.arms.size(); ++a)
        second_pass(plan, all, all.source, all.arms[a], plan.arms[a].layer, truth, monitor);
    if (all.reference) second_pass(plan, all, all.source, *all.reference, plan.reference_layer, nullptr, monitor);
    return all;
}

}  // namespace crescent::inline comparing
