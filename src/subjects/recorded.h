// Draws that were made elsewhere, read from a file: judged as they are, since no more can be asked for.
#pragma once

#include <vector>

#include "subjects/subject.h"

namespace crescent::inline subjects {

class RecordedSubject : public JudgedSampler {
public:
    bool draws_at_will() const override { return false; }
    std::size_t rows() const { return draws_.size(); }
    const Draw& row(std::size_t i) const { return draws_[i]; }
    const Numbers& row_numbers(std::size_t i) const { return u_[i]; }
    /// Round 0: every other row, from the first; round 1: the rest, which is independent of it.
    void half(int round, std::vector<Numbers>& u, std::vector<Draw>& draws) const {
        for (std::size_t i = static_cast<std::size_t>(round); i < draws_.size(); i += 2) {
            u.push_back(u_[i]);
            draws.push_back(draws_[i]);
        }
    }
    void sample(int, Vec3d, std::span<const Numbers>, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = draws_[i % draws_.size()];
    }

protected:
    std::vector<Numbers> u_;
    std::vector<Draw> draws_;
};

}  // namespace crescent::inline subjects
