// SPDX-License-Identifier: MIT
// Lorenz' equations by a CUDA kernel of their own, as host code sees it, and CUDA's description of the machine.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gpu_ensembles {

/// `size` instances on a GPU, with pinned host memory. Throws `myriad::error` if CUDA fails.
class lorenz_by_hand {
public:
    struct times {
        double kernel_ms, end_to_end_ms;
    };
    struct resources {
        int registers, block_size;
        std::int64_t local_bytes;
    };

    /// `b` is the constant in the third equation.
    lorenz_by_hand(int device, std::int64_t size, double b);
    ~lorenz_by_hand();

    /// Host memory: component c of instance i is at `state()[c * size + i]`.
    double* state();
    double* parameter();
    /// Tries block sizes on the uploaded data and keeps the fastest; this also warms up.
    void choose_block(int steps, double h);
    /// Uploads, takes the classic Runge-Kutta steps and downloads the state.
    times run(int steps, double h);
    resources kernel() const;

private:
    struct memory;
    std::unique_ptr<memory> memory_;
};

/// Lines for the header: GPU, driver, CUDA.
std::vector<std::string> describe_gpu(int device);

}  // namespace gpu_ensembles
