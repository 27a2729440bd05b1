// A copy is taken from the list of free ones and given back after its answer; its start is outside the lock.
#include "check/sources/copies.h"

#include <fmt/format.h>

#include "check/sources/check_case.h"

namespace crescent {

Copies::Copies(Start start, std::size_t limit)
    : start_(std::move(start)), limit_(limit), copies_{start_()}, free_copies_{copies_.front()} {}

SamplerDeclaration Copies::declaration() const {
    const std::lock_guard<std::mutex> guard(lock_);
    SamplerDeclaration out = copies_.front()->declaration();
    out.serial = false;
    return out;
}

QueryUsage Copies::spending() const {
    const std::lock_guard<std::mutex> guard(lock_);
    QueryUsage out = copies_.front()->spending();
    out.answers = 0;
    for (const Copy& copy : copies_) out.answers += copy->spending().answers;
    out.answers -= start_answers_;
    return out;
}

void Copies::evaluate(const SamplerQuery& query, const SamplerAnswers& out) const {
    const Copy copy = take();
    try {
        copy->evaluate(query, out);
    } catch (const SamplerTimeout&) {
        give_up(std::current_exception());
        throw;
    } catch (const SamplerError& fault) {
        give_up(std::make_exception_ptr(SamplerExited(fmt::format("the program was given up: {}", fault.what()))));
        throw;
    } catch (...) {
        give_back(copy);
        throw;
    }
    give_back(copy);
}

Copies::Copy Copies::take() const {
    std::unique_lock<std::mutex> guard(lock_);
    for (;;) {
        changed_.wait(guard, [&] { return fault_ || !free_copies_.empty() || copies_.size() + starting_ < limit_; });
        if (fault_) std::rethrow_exception(fault_);
        if (!free_copies_.empty()) {
            Copy copy = std::move(free_copies_.back());
            free_copies_.pop_back();
            return copy;
        }
        ++starting_;
        guard.unlock();
        const Copy copy = start_copy();
        guard.lock();
        --starting_;
        if (copy) {
            copies_.push_back(copy);
            start_answers_ += copy->spending().answers;
            return copy;
        }
        limit_ = copies_.size();
    }
}

/// A further one; null if it cannot start.
Copies::Copy Copies::start_copy() const {
    try {
        return start_();
    } catch (const std::exception&) { return nullptr; }
}

void Copies::give_back(Copy copy) const {
    const std::lock_guard<std::mutex> guard(lock_);
    free_copies_.push_back(std::move(copy));
    changed_.notify_one();
}

void Copies::give_up(std::exception_ptr fault) const {
    const std::lock_guard<std::mutex> guard(lock_);
    if (!fault_) fault_ = std::move(fault);
    changed_.notify_all();
}

}  // namespace crescent
