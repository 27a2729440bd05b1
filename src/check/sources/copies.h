// Several processes of one program as one sampler, so that several threads are answered at once.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "samplers/sampler_adapter.h"

namespace crescent {

/// Copies of a program whose answers do not depend on what it was asked before. Each answers one query at a time;
/// another one starts when a query finds all of them at work. Where that fails, those that there are go on: memory or a
/// device may not suffice for more. After one failed at a query, all are given up.
class Copies : public SamplerAdapter {
public:
    using Start = std::function<std::shared_ptr<const SamplerAdapter>()>;
    /// Starts the first one. `limit`: of the number of copies; beyond it a query waits.
    Copies(Start start, std::size_t limit);
    SamplerDeclaration declaration() const override;
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override;
    /// The answers of all, those of further ones without what they were asked when they started; the seconds are those
    /// of the first one.
    QueryUsage spending() const override;

private:
    using Copy = std::shared_ptr<const SamplerAdapter>;
    Copy take() const;
    Copy start_copy() const;
    void give_back(Copy copy) const;
    void give_up(std::exception_ptr fault) const;

    Start start_;
    mutable std::mutex lock_;  // guards what follows
    mutable std::condition_variable changed_;
    mutable std::size_t limit_, starting_ = 0;
    mutable std::vector<Copy> copies_, free_copies_;
    mutable std::uint64_t start_answers_ = 0;  // of the further ones
    mutable std::exception_ptr fault_;         // what queries throw from then on
};

}  // namespace crescent
