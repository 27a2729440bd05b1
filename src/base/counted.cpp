// English has the singular for 1 alone.
#include "base/counted.h"

#include <algorithm>

namespace crescent {

std::string counted(std::size_t count, std::string_view thing) {
    std::string out = std::to_string(count) + " ";
    while (!thing.empty()) {
        const std::size_t bracket = std::min(thing.find('['), thing.size());
        out += thing.substr(0, bracket);
        thing.remove_prefix(bracket);
        const std::size_t close = thing.find(']');
        if (close == thing.npos) return out += thing;
        const std::string_view forms = thing.substr(1, close - 1);
        thing.remove_prefix(close + 1);
        const std::size_t bar = forms.find('|');
        if (bar != forms.npos) out += count == 1 ? forms.substr(0, bar) : forms.substr(bar + 1);
        else if (count != 1) out += forms;
    }
    return out;
}

}  // namespace crescent
