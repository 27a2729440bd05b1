// The order of a comparison: read twice, judge, draw, write.
#include "compare/compare.h"

#include <fmt/format.h>

#include "base/files.h"
#include "compare/judge.h"
#include "compare/plates.h"
#include "plates/canvas.h"

namespace crescent::inline comparing {

CompareResult compare(const ComparePlan& plan, const CompareOptions& options, const Provenance& provenance,
    ProgressMonitor& monitor, std::string& summary) {
    const plates::Canvas probe(1, 1, {});  // a missing font is found before the work, and a folder that is in use
    Staging staging(options.out);
    const Readings all = read_all(plan, monitor);
    const CompareResult result = judge(plan, all, monitor);
    std::map<std::string, std::vector<unsigned char>> pictures;
    for (const auto& [name, picture] : compare_plates(plan, all, result))
        pictures[name] = encode_png(picture,
            {{"Software", "crescent " + provenance.version}, {"Title", name}, {"Command", provenance.command}});
    monitor.check();
    for (const auto& [name, png] : pictures) staging.write("plates/" + name + ".png", png);
    if (!result.ladders.empty()) staging.write("plates/ladders.svg", ladders_svg(result, plan.theme));
    staging.write("metrics.json", compare_json(plan, all, result, provenance));
    staging.write("metrics.csv", compare_csv(result));
    staging.write("junit.xml", compare_junit(plan, result));
    staging.write("report.html", compare_html(plan, all, result, provenance, pictures));
    staging.commit(monitor);
    summary = compare_summary(plan, all, result, options.out);
    return result;
}

}  // namespace crescent::inline comparing
