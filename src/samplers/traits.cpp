// Points of a domain as directions of its chart.
#include "samplers/traits.h"

namespace crescent {

Draw draw_of_point(
    const DomainChart& domain, std::span<const double> point, double pdf, const PrimarySample& u, int numbers) {
    if (pdf == 0) return {{0, 0, 1}, 0};
    if (!domain.domain().fault(point).empty()) {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        domain.note_outside(point);
        return {{none, none, none}, pdf};
    }
    std::array<double, PrimarySample::most_numbers> spread{};
    const std::size_t count = domain.spreads();
    for (std::size_t k = 0; k < count; ++k) spread[k] = u[numbers + static_cast<int>(k)];
    const Vec3d w = domain.direction(point, std::span(spread).first(count));
    std::array<double, Domain::most_coordinates> image{};
    return {w, pdf * domain.point(w, std::span(image).first(point.size()))};
}

}  // namespace crescent
