#include "plates/plates.h"

#include <array>

#include "plates/sheet.h"

namespace crescent::plates {

namespace {

struct Row {
    PlateKind kind;
    void (*draw)(Sheet&);
};
constexpr std::array<Row, 10> kinds{{
    {PlateKind::hero, draw_still},
    {PlateKind::gallery, draw_still},
    {PlateKind::columns, draw_strip},
    {PlateKind::ladder, draw_strip},
    {PlateKind::exponent, draw_strip},
    {PlateKind::surround, draw_strip},
    {PlateKind::reference, draw_reference},
    {PlateKind::heat, draw_heat},
    {PlateKind::rose, draw_rose},
    {PlateKind::meters, draw_meters},
}};
static_assert(kinds.size() == std::size_t(PlateKind::meters) + 1, "a row for each kind of plate");

}  // namespace

void draw(Sheet& sheet) {
    for (const Row& row : kinds) {
        if (row.kind == sheet.plan.kind) {
            row.draw(sheet);
            finish(sheet);
            return;
        }
    }
    ensure(false, "every kind of plate has a function that draws it");
}

std::string draw_plate_svg(const PlatePlan& plan, const PlateInputs& in) {
    if (plan.kind != PlateKind::meters) return {};
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
