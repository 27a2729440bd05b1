// Recorded draws from a file: they are checked without further draws.
#pragma once

#include <string>
#include <vector>

#include "samplers/sampler_adapter.h"

namespace crescent {

class RecordedSampler : public SamplerSource {
public:
    bool can_draw() const override { return false; }
    std::size_t rows() const { return draws_.size(); }
    const Draw& row(std::size_t i) const { return draws_[i]; }
    const PrimarySample& row_numbers(std::size_t i) const { return u_[i]; }
    /// The position of a row in the file, "samples.csv:17".
    virtual std::string place(std::size_t row) const = 0;
    void sample(int, Vec3d, std::span<const PrimarySample>, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = draws_[i % draws_.size()];
    }

protected:
    std::vector<PrimarySample> u_;
    std::vector<Draw> draws_;
};

}  // namespace crescent
