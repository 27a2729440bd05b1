// In a file of its own, so that a program which draws no plates is not linked with the drawing code.
#include "report/plates/canvas.h"
#include "report/plates/sheet.h"
#include "run/resources.h"

namespace crescent::inline runs {

void check_font(const Experiment& experiment) {
    if (!experiment.plates.empty()) const plates::Canvas font(16, 16, plates::ground);
}

}  // namespace crescent::inline runs
