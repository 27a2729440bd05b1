// The user's functions are called for one point at a time, in double precision.
#include "user_points.h"

extern "C" {

/// Provided by the page: writes the coordinates of a point and returns its density, 0 if nothing is drawn.
__attribute__((import_module("api"), import_name("point_drawn"))) double api_point_drawn(
    const double* u, std::size_t numbers, double* x, std::size_t coordinates);
/// Provided by the page: the density at a point, or the integrand.
__attribute__((import_module("api"), import_name("point_value"))) double api_point_value(
    int integrand, const double* x, std::size_t coordinates);
}

namespace crescent::web {

namespace {

/// What the user's functions take.
struct TakenPoints {
    std::string domain;  // "": directions
    int numbers = 2;     // random numbers of a draw
    bool integrand = false;
};
TakenPoints point_setup;

ordered_json picture_of(const LineHistogram& line) {
    return {{"kind", "line"}, {"axis", line.axis}, {"entries", line.entries}, {"edges", line.edges},
        {"observed", line.observed}, {"expected", line.expected}};
}

ordered_json picture_of(const BinHistogram& map) {
    return {{"kind", "map"}, {"rings", map.rings}, {"sectors", map.sectors}, {"observed", map.observed},
        {"expected", map.expected}, {"sd", map.sd}, {"ring_axis", map.ring_axis}, {"sector_axis", map.sector_axis},
        {"ring_labels", map.ring_labels}, {"sector_labels", map.sector_labels}};
}

}  // namespace

std::shared_ptr<const SamplerAdapter> page_point_sampler() {
    if (point_setup.domain.empty()) return nullptr;
    PointSampler sampler{.domain = point_setup.domain,
        .numbers = point_setup.numbers,
        .sample = [](std::span<const double> u,
                      std::span<double> x) { return api_point_drawn(u.data(), u.size(), x.data(), x.size()); },
        .pdf = [](std::span<const double> x) { return api_point_value(0, x.data(), x.size()); }};
    if (point_setup.integrand)
        sampler.f = [](std::span<const double> x) { return api_point_value(1, x.data(), x.size()); };
    return adapter_of(sampler, "your sampler");
}

/// {domain, numbers, integrand}: the user's functions are of points of this domain.
CRESCENT_EXPORT(user_takes_points)()->void {
    const ordered_json query = request();
    const std::string name = query.at("domain").get<std::string>();
    const std::optional<Domain> domain = Domain::read(name);
    const auto refuse = [&](const std::string& reason) {
        throw InputError({"const domain", 0, 0}, fmt::format("'{}' is no domain of the page: {}", name, reason));
    };
    if (!domain) refuse(Domain::refusal(name));
    if (domain->is_direction()) refuse("its directions are those of 'hemisphere'; the program checks other ones");
    point_setup = {name, query.at("numbers").get<int>(), query.at("integrand").get<bool>()};
}

/// {evaluations} -> the draws by bin and what the density expects: {kind: "line", axis, entries, edges,
/// observed, expected}, or {kind: "map", rings, sectors, observed, expected, sd, ring_axis, sector_axis, ring_labels,
/// sector_labels}; {kind: ""} if there are no draws.
CRESCENT_EXPORT(user_points_drawn)()->void {
    const ordered_json query = request();
    ProgressMonitor monitor;
    TestSettings settings = TestSettings::quick();
    settings.pictures = true;
    settings.budget = check::CheckBudget::limited(query.at("evaluations").get<double>());
    const CheckResult result = run_checks(make_user_cases(page_point_sampler(), false), settings, monitor);
    if (!result.lines.empty()) return respond(picture_of(result.lines.front()));
    if (!result.maps.empty()) return respond(picture_of(result.maps.front()));
    respond({{"kind", ""}});
}

}  // namespace crescent::web
