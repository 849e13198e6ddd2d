// SPDX-License-Identifier: MIT
// The kernels of the simulated GPU for the models that studies are tested with.
#include <memory>

#include "tests/host/solve/simulated_engine.hpp"
#include "tests/study/models.hpp"

namespace myriad::cuda {

template <class Model, class Method, class R, class Counts>
std::unique_ptr<engine<R>> make_engine(const engine_options&) {
    simulated::the_gpu.meet(simulated::call::make_engine);
    return std::make_unique<simulated::engine<Model, Method, R>>();
}
#define MYRIAD_SIMULATE(Model, Method, R) \
    template std::unique_ptr<engine<R>> make_engine<Model, Method, R>(const engine_options&);
MYRIAD_SIMULATE(studied::duffing, dense<tsitouras_5>, double)
MYRIAD_SIMULATE(studied::lorenz, runge_kutta_4, float)
MYRIAD_SIMULATE(studied::wave, cash_karp, double)

}  // namespace myriad::cuda
