// Apart from the other needs, so that a program which draws no plates is linked without what draws them.
#include "report/plates/canvas.h"
#include "report/plates/sheet.h"
#include "run/resources.h"

namespace crescent::inline runs {

void check_font(const Experiment& experiment) {
    if (!experiment.plates.empty()) const plates::Canvas font(16, 16, plates::ground);
}

}  // namespace crescent::inline runs
