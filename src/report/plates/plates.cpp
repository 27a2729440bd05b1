// The plate's kind selects its painter from the list in experiment/experiment.h; caption and footer are set after it.
#include "report/plates/plates.h"

#include "report/plates/sheet.h"

namespace crescent::plates {

namespace {

/// By PlateKind.
#define CRESCENT_PAINTER(name, painter, ...) draw_##painter,
constexpr void (*painters[])(Sheet&) = {CRESCENT_PLATES(CRESCENT_PAINTER)};
#undef CRESCENT_PAINTER

}  // namespace

void draw(Sheet& sheet) {
    painters[static_cast<std::size_t>(sheet.plan.kind)](sheet);
    finish(sheet);
}

std::string draw_plate_svg(const PlatePlan& plan, const PlateInputs& in) {
    if (plate_info(plan.kind).look != PlateLook::drawing) return {};
    Sheet sheet(plan, in, Medium::svg);
    draw(sheet);
    return sheet.canvas.svg();
}

Picture draw_plate(const PlatePlan& plan, const PlateInputs& in) {
    Sheet sheet(plan, in);
    draw(sheet);
    return sheet.canvas.picture();
}

}  // namespace crescent::plates
