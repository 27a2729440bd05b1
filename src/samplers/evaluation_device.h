// The device that evaluates an external sampler.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace crescent {

/// As the program declares it in its handshake; "": not declared.
struct EvaluationDevice {
    std::string name, driver;
    std::string precision{};  // of its arithmetic: "single" or "double"
    bool declared() const { return !name.empty() || !driver.empty(); }
    /// "llvmpipe, Mesa 25.0.7 (Vulkan), single precision"
    std::string text() const {
        std::string out = name;
        for (const std::string& part : {driver, precision.empty() ? "" : precision + " precision"})
            if (!part.empty()) out += (out.empty() ? "" : ", ") + part;
        return out;
    }
};

/// Each sampler that names its device, once.
using DevicesByArm = std::vector<std::pair<std::string, EvaluationDevice>>;

}  // namespace crescent
