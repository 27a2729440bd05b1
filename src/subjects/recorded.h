// Draws that were made elsewhere, read from a file: judged as they are, since no more can be asked for.
#pragma once

#include <string>
#include <vector>

#include "subjects/subject.h"

namespace crescent::inline subjects {

class RecordedSubject : public JudgedSampler {
public:
    bool draws_at_will() const override { return false; }
    std::size_t rows() const { return draws_.size(); }
    const Draw& row(std::size_t i) const { return draws_[i]; }
    const Numbers& row_numbers(std::size_t i) const { return u_[i]; }
    /// Where a row stands in the file, "samples.csv:17".
    virtual std::string place(std::size_t row) const = 0;
    void sample(int, Vec3d, std::span<const Numbers>, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = draws_[i % draws_.size()];
    }

protected:
    std::vector<Numbers> u_;
    std::vector<Draw> draws_;
};

}  // namespace crescent::inline subjects
