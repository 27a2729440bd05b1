// The instruments that can compute films, by the word each has on the command line. The CPU's is built in; a door that
// has another registers it when the program starts, so that who asks for it need not know the door.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "run.h"

namespace crescent {

/// What the command line may say of an instrument; "" and -1: the instrument's own choice.
struct InstrumentChoice {
    std::string context;
    int device = -1;
};

/// A device that an instrument can be opened on.
struct InstrumentDevice {
    int number = 0;     // as InstrumentChoice::device has it
    std::string means;  // in the driver's words
};

class InstrumentKind {
public:
    virtual ~InstrumentKind() = default;
    virtual std::string name() const = 0;                                              // "gl"
    /// Throws OutputError where a part is missing, InputError where the choice is not to be had.
    virtual std::shared_ptr<Instrument> open(const InstrumentChoice& choice) const = 0;
    /// None where its library is missing.
    virtual std::vector<InstrumentDevice> devices() const = 0;
};

/// Those that were registered. Called before main by a door's own initialiser.
std::vector<std::shared_ptr<const InstrumentKind>>& instrument_kinds();
/// Null: this program was built without it.
std::shared_ptr<const InstrumentKind> find_instrument(const std::string& name);

}  // namespace crescent
