// A sampler outside this process or in another language, which is asked for all rows of a query at once: a program, a
// plugin, callables of Python, the page's editor. Each kind of query has one function. Local frame, n = +z; pdf in
// 1/sr; f without the cosine, in 1/sr.
#pragma once

#include <span>

#include "samplers/sampler_adapter.h"

namespace crescent {

/// Writes each value to every channel of its row.
void copy_to_channels(std::span<const double> values, std::span<Vec3d> out);

/// A sampler with one technique and a function for each kind of query that it answers. A query without rows calls none
/// of them; the target and the reference value of f are f.
class BatchSampler : public SamplerAdapter {
public:
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override;

protected:
    /// A draw for each row of query.u.
    virtual void draw_rows(const SamplerQuery& query, std::span<Draw> out) const = 0;
    /// The density of each pair.
    virtual void pdf_rows(const SamplerQuery& query, std::span<double> out) const = 0;
    /// f of each pair; for three channels their luminance.
    virtual void f_rows(const SamplerQuery& query, std::span<double> out) const = 0;
    /// f of each pair by channel: f_rows() in every channel, unless there are three.
    virtual void f_rows_by_channel(const SamplerQuery& query, std::span<Vec3d> out) const;
    /// The weight of each of K samplers, [row][K], where the declaration says that it weighs.
    virtual void weight_rows(const SamplerQuery& query, std::span<double> out) const;
};

}  // namespace crescent
