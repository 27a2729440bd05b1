// Outputs appear whole or not at all: they are written into a folder beside their place and moved there at the end.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace crescent {

/// A folder of outputs in the making. Nothing shows under a final name before commit(); if the process stops earlier,
/// earlier outputs stand untouched. Throws OutputError where something cannot be written.
class Staging {
public:
    /// Makes `folder` if it is not there, and clears what earlier, killed runs left behind.
    explicit Staging(std::string folder);
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    /// Where to write "plates/hero.png" for now.
    std::string path(const std::string& name);
    void write(const std::string& name, std::span<const unsigned char> bytes);
    void write(const std::string& name, const std::string& text);
    /// A folder for what is needed on the way; it goes with the stage.
    const std::string& scratch() const { return stage_; }
    /// Moves every output to its place.
    void commit();

private:
    std::string folder_, stage_;
    std::vector<std::string> names_;
};

}  // namespace crescent
