#include "instruments.h"

namespace crescent {

std::vector<std::shared_ptr<const InstrumentKind>>& instrument_kinds() {
    static std::vector<std::shared_ptr<const InstrumentKind>> kinds;
    return kinds;
}

std::shared_ptr<const InstrumentKind> find_instrument(const std::string& name) {
    for (const auto& kind : instrument_kinds())
        if (kind->name() == name) return kind;
    return nullptr;
}

}  // namespace crescent
