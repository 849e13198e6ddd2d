// SPDX-License-Identifier: MIT
// Lorenz' equations, set by the model itself.
#pragma once

#include <myriad/model.hpp>

#include "problems/lorenz.hpp"

namespace large_study {

// snippet: generate
struct lorenz : problems::fused_lorenz {
    MYRIAD_FUNCTION static void generate(auto& instance) {
        instance.y[x] = instance.random.uniform(-10, 10);
        instance.y[y] = instance.random.uniform(-10, 10);
        instance.y[z] = instance.random.uniform(15, 35);
    }
};
// end of snippet

}  // namespace large_study
