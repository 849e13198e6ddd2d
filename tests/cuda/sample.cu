// SPDX-License-Identifier: MIT
// A kernel through a template and the same by hand: shows how limits are written, and that the check works.
//
//
// limit: axpy stack 0 spill 0 registers_within 1.10 of axpy_by_hand
// limit: scale<float> stack 0 spill 0 registers 32

struct axpy_body {
    double factor;
    template <class R>
    __host__ __device__ __forceinline__ R operator()(R x, R y) const {
        return factor * x + y;
    }
};

__global__ void axpy(int n, axpy_body body, const double* __restrict__ x, double* __restrict__ y) {
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (i < n) y[i] = body(x[i], y[i]);
}

__global__ void axpy_by_hand(int n, double factor, const double* __restrict__ x, double* __restrict__ y) {
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (i < n) y[i] = factor * x[i] + y[i];
}

template <class R>
__global__ void scale(int n, R factor, R* x) {
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (i < n) x[i] *= factor;
}
template __global__ void scale<float>(int, float, float*);
template __global__ void scale<double>(int, double, double*);
