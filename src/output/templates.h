// Pages from templates: *.html files next to the code, which the build puts into the program (cmake/templates.cmake),
// in the language of mustache. {{x}} is escaped and {{{x}}} is not; {{#x}}...{{/x}} is repeated for each element of a
// list, and left out if x is false, "" or an empty list; {{^x}}...{{/x}} is the reverse; {{> x.html}} includes another
// template. For each list x there is has_x, and an element finds the names of what surrounds it. {{count.x}} is 1, then
// 2, 3, ...
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "output/format.h"

namespace crescent {

/// A template and its file name.
struct Template {
    std::string_view name, text;
};
using Templates = std::span<const Template>;

/// The templates of each folder that has some; defined by the build.
Templates output_templates();
Templates check_templates();
Templates report_templates();
Templates compare_templates();

/// Fills in the template `name` of `templates`, which may include others of them and those of output/. Numbers are
/// written as shortest() does. Throws Bug if a value is named that the model lacks, or a template that does not exist.
std::string render_page(Templates templates, std::string_view name, const Json& model);

}  // namespace crescent
