// SPDX-License-Identifier: MIT
// The kernel body as CUDA kernels, next to hand-written kernels with the same duties: a time domain per instance, a
// status, counters, a step limit, and no state that is not finite.
//
//
// limit: integrate_ensemble<lorenz, runge_kutta_4> stack 0 spill 0 registers_within 1.10 of lorenz_by_hand
// limit: integrate_ensemble<duffing_plain, cash_karp> stack 0 spill 0 registers_within 1.10 of duffing_by_hand
// limit: integrate_ensemble<duffing, cash_karp> registers 96 stack 832 spill 0

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "examples/duffing/duffing.hpp"
#include "problems/duffing.hpp"
#include "problems/lorenz.hpp"

using problems::lorenz;

/// Duffing with a polynomial forcing instead of the cosine, whose slow path needs a stack frame in any kernel.
struct duffing_plain : problems::duffing {
    enum parameter { k, n_parameter };
    enum shared { B, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return slope<R>(y, p[k], p.shared[B] * (t * t));
    }
};

template <class Model>
using arguments = myriad::detail::kernel_arguments<Model, double>;
constexpr auto constant = myriad::shared_placement::constant_bank;
template <class Model>
using launched = myriad::detail::launch_arguments<Model, double, constant>;

#define INSTANTIATE(Model, Method)                                                                        \
    template __global__ void myriad::detail::integrate_ensemble<Model, myriad::Method, double, constant>( \
        const __grid_constant__ launched<Model>);
INSTANTIATE(lorenz, runge_kutta_4)
INSTANTIATE(duffing_plain, cash_karp)
INSTANTIATE(duffing, cash_karp)
INSTANTIATE(duffing, tsitouras_5)

namespace {

__device__ bool is_number(double x) { return (__double2hiint(x) & 0x7ff00000) != 0x7ff00000; }

__device__ void f(double x, double y, double z, double rho, double& dx, double& dy, double& dz) {
    dx = 10 * (y - x);
    dy = rho * x - y - x * z;
    dz = x * y - (8.0 / 3) * z;
}

__device__ void g(double t, double x, double v, double k, double B, double& dx, double& dv) {
    dx = v;
    dv = x - x * x * x - k * v + B * (t * t);
}

}  // namespace

__global__ void lorenz_by_hand(const __grid_constant__ arguments<lorenz> a) {
    const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i >= a.size) return;
    double x = a.state[i], y = a.state[a.size + i], z = a.state[2 * a.size + i];
    const double rho = a.parameter[i], begin = a.t_begin[i], end = a.t_end[i];
    const double h0 = copysign(a.step, end - begin);
    const int steps = static_cast<int>(ceil(fabs(end - begin) / a.step - 1e-6));
    myriad::status how = myriad::status::success;
    int n = 0;
    for (; n < steps; ++n) {
        if (n >= a.max_steps) {
            how = myriad::status::max_steps;
            break;
        }
        const double h = n == steps - 1 ? end - fma(static_cast<double>(n), h0, begin) : h0;
        double dx, dy, dz, sx, sy, sz;
        f(x, y, z, rho, dx, dy, dz);
        sx = dx, sy = dy, sz = dz;
        f(fma(0.5 * h, dx, x), fma(0.5 * h, dy, y), fma(0.5 * h, dz, z), rho, dx, dy, dz);
        sx = fma(2.0, dx, sx), sy = fma(2.0, dy, sy), sz = fma(2.0, dz, sz);
        f(fma(0.5 * h, dx, x), fma(0.5 * h, dy, y), fma(0.5 * h, dz, z), rho, dx, dy, dz);
        sx = fma(2.0, dx, sx), sy = fma(2.0, dy, sy), sz = fma(2.0, dz, sz);
        f(fma(h, dx, x), fma(h, dy, y), fma(h, dz, z), rho, dx, dy, dz);
        const double x1 = fma(h / 6, sx + dx, x), y1 = fma(h / 6, sy + dy, y), z1 = fma(h / 6, sz + dz, z);
        if (!(is_number(x1) && is_number(y1) && is_number(z1))) {
            how = myriad::status::not_finite;
            break;
        }
        x = x1, y = y1, z = z1;
    }
    a.state[i] = x;
    a.state[a.size + i] = y;
    a.state[2 * a.size + i] = z;
    a.t[i] = n == steps ? end : fma(static_cast<double>(n), h0, begin);
    a.status[i] = how;
    if (a.accepted != nullptr) {
        a.accepted[i] += n;
        a.evaluations[i] += 4 * n;
    }
}

__global__ void duffing_by_hand(const __grid_constant__ arguments<duffing_plain> a) {
    const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i >= a.size) return;
    double x = a.state[i], v = a.state[a.size + i];
    const double k = a.parameter[i], B = a.shared.real[0];
    for (int phase = 0; phase < a.phases; ++phase) {
        double t = a.t_begin[i];
        const double end = a.t_end[i];
        double h = copysign(a.step, end - t);
        int accepted = 0, rejected = 0;
        bool last_not_finite = false;
        myriad::status how = myriad::status::success;
        double dx1, dv1;
        bool fresh = true;
        while (t != end) {
            if (accepted + rejected >= a.max_steps) {
                how = myriad::status::max_steps;
                break;
            }
            const bool last = fabs(end - t) <= 1.001 * fabs(h);
            const double trial = last ? end - t : h;
            const double t1 = last ? end : t + trial;
            if (fresh) g(t, x, v, k, B, dx1, dv1);
            double dx2, dv2, dx3, dv3, dx4, dv4, dx5, dv5, dx6, dv6;
            g(t + 0.2 * trial, x + trial * (0.2 * dx1), v + trial * (0.2 * dv1), k, B, dx2, dv2);
            g(t + 0.3 * trial, x + trial * (0.075 * dx1 + 0.225 * dx2), v + trial * (0.075 * dv1 + 0.225 * dv2), k, B,
              dx3, dv3);
            g(t + 0.6 * trial, x + trial * (0.3 * dx1 - 0.9 * dx2 + 1.2 * dx3),
              v + trial * (0.3 * dv1 - 0.9 * dv2 + 1.2 * dv3), k, B, dx4, dv4);
            g(t + trial, x + trial * (-11.0 / 54 * dx1 + 2.5 * dx2 - 70.0 / 27 * dx3 + 35.0 / 27 * dx4),
              v + trial * (-11.0 / 54 * dv1 + 2.5 * dv2 - 70.0 / 27 * dv3 + 35.0 / 27 * dv4), k, B, dx5, dv5);
            g(t + 0.875 * trial,
              x + trial * (1631.0 / 55296 * dx1 + 175.0 / 512 * dx2 + 575.0 / 13824 * dx3 + 44275.0 / 110592 * dx4 +
                           253.0 / 4096 * dx5),
              v + trial * (1631.0 / 55296 * dv1 + 175.0 / 512 * dv2 + 575.0 / 13824 * dv3 + 44275.0 / 110592 * dv4 +
                           253.0 / 4096 * dv5),
              k, B, dx6, dv6);
            const double x1 =
                x + trial * (37.0 / 378 * dx1 + 250.0 / 621 * dx3 + 125.0 / 594 * dx4 + 512.0 / 1771 * dx6);
            const double v1 =
                v + trial * (37.0 / 378 * dv1 + 250.0 / 621 * dv3 + 125.0 / 594 * dv4 + 512.0 / 1771 * dv6);
            const double ex = trial * (-277.0 / 64512 * dx1 + 6925.0 / 370944 * dx3 - 6925.0 / 202752 * dx4 -
                                       277.0 / 14336 * dx5 + 277.0 / 7084 * dx6);
            const double ev = trial * (-277.0 / 64512 * dv1 + 6925.0 / 370944 * dv3 - 6925.0 / 202752 * dv4 -
                                       277.0 / 14336 * dv5 + 277.0 / 7084 * dv6);
            const float qx = static_cast<float>(
                fabs(ex) / fmax(a.absolute_tolerance[0], a.relative_tolerance[0] * fmax(fabs(x), fabs(x1))));
            const float qv = static_cast<float>(
                fabs(ev) / fmax(a.absolute_tolerance[1], a.relative_tolerance[1] * fmax(fabs(v), fabs(v1))));
            const float q = fmaxf(qx, qv);
            const bool ok = qx <= 1 && qv <= 1 && is_number(x1) && is_number(v1);
            float factor = 0.9f * exp2f((ok ? -0.2f : -0.25f) * __log2f(q));
            factor = fminf(fmaxf(factor, static_cast<float>(a.shrink_limit)), static_cast<float>(a.growth_limit));
            if (!ok) {
                const bool good = q > 1 && q <= 3e38f;
                if (!good) factor = static_cast<float>(a.shrink_limit);
                last_not_finite = !good;
                ++rejected;
                if (fabs(trial) <= a.minimum_step) {
                    how = last_not_finite ? myriad::status::not_finite : myriad::status::step_underflow;
                    break;
                }
            }
            if (t1 == t) {
                how = last_not_finite ? myriad::status::not_finite : myriad::status::step_underflow;
                break;
            }
            double size = fmin(fmax(fabs(trial) * factor, a.minimum_step), a.maximum_step);
            if (ok && last) size = fmax(size, fabs(h));
            h = copysign(size, h);
            fresh = ok;
            if (ok) {
                x = x1, v = v1, t = t1;
                ++accepted;
                last_not_finite = false;
            }
        }
        a.t[i] = t;
        a.status[i] = how;
        if (a.accepted != nullptr) {
            a.accepted[i] += accepted;
            a.rejected[i] += rejected;
            a.evaluations[i] += 6 * accepted + 5 * rejected;
        }
        if (myriad::is_failure(how)) {
            a.ended[i] = 1;
            break;
        }
        a.phase[i] += 1;
    }
    a.state[i] = x;
    a.state[a.size + i] = v;
}
