// The CPU passes a job on to estimate_films(). The list of kinds is a static of its function, so that it exists for
// registrations before main.
#include "run/backend.h"

#include "render/estimator.h"

namespace crescent {

namespace {

class Cpu : public Backend {
public:
    explicit Cpu(std::string isa) : isa_(std::move(isa)) {}
    std::string name() const override { return "CPU"; }
    std::vector<Film> films(const TiledScene& view, const Job& job, ProgressMonitor& monitor) override {
        return estimate_films(view, {job.sampler, job.outside.get()}, job.n, job.seed, isa_, monitor);
    }

private:
    std::string isa_;
};

}  // namespace

std::shared_ptr<Backend> cpu_backend(std::string isa) { return std::make_shared<Cpu>(std::move(isa)); }

std::vector<std::shared_ptr<const BackendKind>>& backend_kinds() {
    static std::vector<std::shared_ptr<const BackendKind>> kinds;
    return kinds;
}

std::shared_ptr<const BackendKind> find_backend(const std::string& name) {
    for (const auto& kind : backend_kinds())
        if (kind->name() == name) return kind;
    return nullptr;
}

}  // namespace crescent

// ---- The hook is a static of its function, so that an initialiser of another file may use it first.

namespace crescent {

ExplainerHook& film_maker() {
    static ExplainerHook maker;
    return maker;
}

}  // namespace crescent
