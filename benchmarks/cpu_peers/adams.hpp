// SPDX-License-Identifier: MIT
// SUNDIALS CVODE as a user writes it for many small non-stiff systems: Adams methods with fixed-point iteration, one
// object per thread, reinitialised for each instance by CVodeReInit. Not the validation's class, whose function objects
// and dense matrix would be timed too. For SUNDIALS 6 and 7.
#pragma once

#include <cstdint>
#include <stdexcept>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace cpu_peers {

/// The solver for systems of n equations. `System` has `int slopes(double t, const double* y, double* dy) const`, which
/// returns 0, or 1 if there are no slopes, and, for `roots` > 0 functions that stop it where they fall through zero,
/// `void values(const double* y, double* g) const`.
template <int n, class System, int roots = 0>
class adams {
public:
    System system;

    explicit adams(double tolerance) {
#if SUNDIALS_VERSION_MAJOR >= 7
        check(SUNContext_Create(SUN_COMM_NULL, &context_));
        check(SUNContext_ClearErrHandlers(context_));
#else
        check(SUNContext_Create(nullptr, &context_));
#endif
        y_ = N_VNew_Serial(n, context_);
        iteration_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
        memory_ = CVodeCreate(CV_ADAMS, context_);
        if (y_ == nullptr || iteration_ == nullptr || memory_ == nullptr)
            throw std::runtime_error("CVODE: out of memory");
        for (int c = 0; c < n; ++c) y()[c] = 0;
        check(CVodeInit(memory_, &call_slopes, 0, y_));
        check(CVodeSStolerances(memory_, tolerance, tolerance));
        check(CVodeSetUserData(memory_, this));
        check(CVodeSetNonlinearSolver(memory_, iteration_));
        check(CVodeSetMaxNumSteps(memory_, 1000000));
#if SUNDIALS_VERSION_MAJOR < 7
        check(CVodeSetErrFile(memory_, nullptr));
#endif
        if constexpr (roots > 0) {
            int falling[roots];
            for (int& direction : falling) direction = -1;
            check(CVodeRootInit(memory_, roots, &call_values));
            check(CVodeSetRootDirection(memory_, falling));
            check(CVodeSetNoInactiveRootWarn(memory_));
        }
    }
    adams(const adams&) = delete;
    adams& operator=(const adams&) = delete;
    ~adams() {
        CVodeFree(&memory_);
        SUNNonlinSolFree(iteration_);
        N_VDestroy(y_);
        SUNContext_Free(&context_);
    }

    double* y() { return NV_DATA_S(y_); }
    double t() const { return t_; }

    /// Starts, or restarts after a jump, at t and the state in `y()`.
    void start(double t) {
        t_ = t;
        check(CVodeReInit(memory_, t, y_));
    }
    /// Integrates to t_end, to a root or, with CV_ONE_STEP, by one step. Returns CVODE's flag, which is not negative.
    int advance(double t_end, int task) {
        check(CVodeSetStopTime(memory_, t_end));
        const int flag = CVode(memory_, t_end, y_, &t_, task);
        check(flag);
        return flag;
    }
    /// Steps since the last start.
    std::int64_t steps() const {
        long count = 0;
        check(CVodeGetNumSteps(memory_, &count));
        return count;
    }
    /// The roots found, after `advance` returned CV_ROOT_RETURN.
    void found(int* which) const { check(CVodeGetRootInfo(memory_, which)); }

private:
    static void check(int flag) {
        if (flag < 0) throw std::runtime_error("CVODE failed");
    }
    static int call_slopes(sunrealtype t, N_Vector y, N_Vector dy, void* self) {
        return static_cast<adams*>(self)->system.slopes(t, NV_DATA_S(y), NV_DATA_S(dy));
    }
    static int call_values(sunrealtype, N_Vector y, sunrealtype* g, void* self) {
        if constexpr (roots > 0) static_cast<adams*>(self)->system.values(NV_DATA_S(y), g);
        return 0;
    }

    double t_ = 0;
    SUNContext context_ = nullptr;
    N_Vector y_ = nullptr;
    SUNNonlinearSolver iteration_ = nullptr;
    void* memory_ = nullptr;
};

}  // namespace cpu_peers
