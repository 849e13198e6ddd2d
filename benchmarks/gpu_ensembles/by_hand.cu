// SPDX-License-Identifier: MIT
// The hand-written kernel: 45 double-precision instructions per step, everything in registers, coalesced transfers, and
// nothing beside the method. The library's kernel is measured against it.
#include <chrono>
#include <fstream>
#include <stdexcept>

#include <myriad/cuda/check.cuh>
#include <myriad/cuda/resources.cuh>
#include <myriad/host/ensemble/component_array.hpp>

#include "by_hand.hpp"

namespace gpu_ensembles {
namespace {

struct vector3 {
    double x, y, z;
};

/// The constants of method and model, which instructions read from the constant bank.
struct constants {
    double h, half, third, sixth, b;
};

/// Six instructions.
__device__ __forceinline__ vector3 slope(const vector3& s, double rho, double b) {
    return {10.0 * (s.y - s.x), fma(s.x, rho - s.z, -s.y), fma(s.x, s.y, -(b * s.z))};
}

/// s + h * k, three instructions.
__device__ __forceinline__ vector3 advance(const vector3& s, double h, const vector3& k) {
    return {fma(h, k.x, s.x), fma(h, k.y, s.y), fma(h, k.z, s.z)};
}

}  // namespace

// Small blocks, so that the last ones leave few multiprocessors idle.
__global__ void __launch_bounds__(256) lorenz_steps(std::int64_t size, int steps, const __grid_constant__ constants c,
                                                    const double* __restrict__ parameter, double* __restrict__ state) {
    const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i >= size) return;
    const double rho = parameter[i];
    vector3 s{state[i], state[size + i], state[2 * size + i]};
#pragma unroll 4
    for (int n = 0; n < steps; ++n) {
        // The sum is accumulated as slopes arrive, so that only the last term waits for the last stage.
        vector3 k = slope(s, rho, c.b);
        vector3 sum = advance(s, c.sixth, k);
        k = slope(advance(s, c.half, k), rho, c.b);
        sum = advance(sum, c.third, k);
        k = slope(advance(s, c.half, k), rho, c.b);
        sum = advance(sum, c.third, k);
        k = slope(advance(s, c.h, k), rho, c.b);
        s = advance(sum, c.sixth, k);
    }
    state[i] = s.x;
    state[size + i] = s.y;
    state[2 * size + i] = s.z;
}

namespace cuda = myriad::cuda;

static void check(cudaError_t status) {
    if (status != cudaSuccess) throw std::runtime_error(cudaGetErrorString(status));
}

struct lorenz_by_hand::memory {
    memory(int device, std::int64_t instances, double constant)
        : here(device), size(instances), b(constant), host(4, instances, 0) {
        host.pin(device);
        on_device.reserve(bytes(), 4 * sizeof(double));
    }
    std::size_t bytes() const { return static_cast<std::size_t>(4 * size) * sizeof(double); }
    cudaStream_t own_stream() { return reinterpret_cast<cudaStream_t>(stream.get()); }
    double* device_state() const { return static_cast<double*>(on_device.data()); }

    void upload() {
        check(cudaMemcpyAsync(on_device.data(), host.data(), bytes(), cudaMemcpyHostToDevice, own_stream()));
    }
    void launch(int steps, double h) {
        const auto threads = static_cast<unsigned>(block);
        const auto blocks = static_cast<unsigned>((size + block - 1) / block);
        check(cudaEventRecord(reinterpret_cast<cudaEvent_t>(begun.get()), own_stream()));
        lorenz_steps<<<blocks, threads, 0, own_stream()>>>(size, steps, {h, 0.5 * h, h / 3, h / 6, b},
                                                           device_state() + 3 * size, device_state());
        check(cudaPeekAtLastError());
        check(cudaEventRecord(reinterpret_cast<cudaEvent_t>(done.get()), own_stream()));
    }
    void wait() { check(cudaStreamSynchronize(own_stream())); }
    double kernel_ms() {
        float milliseconds = 0;
        check(cudaEventElapsedTime(&milliseconds, reinterpret_cast<cudaEvent_t>(begun.get()),
                                   reinterpret_cast<cudaEvent_t>(done.get())));
        return static_cast<double>(milliseconds);
    }

    cuda::current_device here;
    std::int64_t size;
    double b;
    int block = 128;
    myriad::host::component_array<double> host;  // state, then parameter
    cuda::device_memory on_device;
    cuda::stream stream;
    cuda::event begun{cuda::event::kind::timed}, done{cuda::event::kind::timed};
};

lorenz_by_hand::lorenz_by_hand(int device, std::int64_t size, double b)
    : memory_(std::make_unique<memory>(device, size, b)) {}
lorenz_by_hand::~lorenz_by_hand() = default;

double* lorenz_by_hand::state() { return memory_->host.data(); }
double* lorenz_by_hand::parameter() { return memory_->host.data() + 3 * memory_->size; }

void lorenz_by_hand::choose_block(int steps, double h) {
    memory& m = *memory_;
    double best = 0;
    int fastest = m.block;
    for (int turn = 0; turn < 3; ++turn)
        for (const int block : {32, 64, 128, 256}) {
            m.block = block;
            m.upload();
            m.launch(steps, h);
            m.wait();
            if (turn == 0 || (best > 0 && m.kernel_ms() >= best)) continue;
            best = m.kernel_ms();
            fastest = block;
        }
    m.block = fastest;
}

lorenz_by_hand::times lorenz_by_hand::run(int steps, double h) {
    memory& m = *memory_;
    const auto begin = std::chrono::steady_clock::now();
    m.upload();
    m.launch(steps, h);
    check(cudaMemcpyAsync(m.host.data(), m.on_device.data(), static_cast<std::size_t>(3 * m.size) * sizeof(double),
                          cudaMemcpyDeviceToHost, m.own_stream()));
    m.wait();
    const std::chrono::duration<double, std::milli> all = std::chrono::steady_clock::now() - begin;
    return {m.kernel_ms(), all.count()};
}

lorenz_by_hand::resources lorenz_by_hand::kernel() const {
    cudaFuncAttributes attributes{};
    check(cudaFuncGetAttributes(&attributes, reinterpret_cast<const void*>(&lorenz_steps)));
    return {attributes.numRegs, memory_->block, static_cast<std::int64_t>(attributes.localSizeBytes)};
}

std::vector<std::string> describe_gpu(int device) {
    const auto version = [](int number) {
        return std::to_string(number / 1000) + '.' + std::to_string(number % 1000 / 10);
    };
    cudaDeviceProp properties{};
    int driver = 0, runtime = 0, clock = 0;
    check(cudaGetDeviceProperties(&properties, device));
    check(cudaDeviceGetAttribute(&clock, cudaDevAttrClockRate, device));
    check(cudaDriverGetVersion(&driver));
    check(cudaRuntimeGetVersion(&runtime));
    std::string module;
    std::ifstream file("/proc/driver/nvidia/version");
    if (!std::getline(file, module)) module = "unknown";
    return {std::string("GPU: ") + properties.name + ", " + std::to_string(properties.multiProcessorCount) +
                " multiprocessors of at most " + std::to_string(clock / 1000) + " MHz, compute capability " +
                std::to_string(properties.major) + '.' + std::to_string(properties.minor),
            "driver: " + module + " (CUDA " + version(driver) + "), CUDA runtime: " + version(runtime)};
}

}  // namespace gpu_ensembles
