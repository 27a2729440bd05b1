// Samples of somebody's sampler, from a file, at one w_o: CSV with a header line, or NPY (a plain float array, columns in this order).
//   u1,u2,wix,wiy,wiz,pdf[,f]         f without the cosine, 1/sr
// The density comes from a table over the whole sphere, wix,wiy,wiz,pdf or cos_theta,phi,pdf (phi in radians): a full grid
// in cos theta and phi, cells centred on the entries, p constant in a cell.
#pragma once

#include <memory>
#include <string>

#include "verdicts/recorded.h"

namespace crescent {

/// Throws InputError with file, line and column of every mistake, at most ten. Without a table the verdicts that need p elsewhere
/// than at the draws have nothing to work on, and the judge is told so by has_table().
class SampleFile : public RecordedSubject {
public:
    SampleFile(const std::string& samples, const std::string& table);
    std::string name() const override { return name_; }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override;

private:
    std::string name_;
    std::vector<double> cos_, phi_, values_;  // cell edges of the table, and p by row
    void read_table(const std::string& path);
};

}  // namespace crescent
