// SPDX-License-Identifier: MIT
// SUNDIALS CVODE as a reference: Adams methods, or BDF for stiff systems, at tight tolerances, with root finding and
// restarts. For SUNDIALS 6 and 7. Host code only.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace validation {

/// CVODE's two families of methods; BDF is for stiff systems.
enum class multistep { adams, bdf };

/// One solution of dy/dt = f(t, y). Throws std::runtime_error if CVODE fails.
class cvode {
public:
    /// Writes f(t, y), or the values of root functions, to its last argument.
    using function = std::function<void(double, const double*, double*)>;

    cvode(std::size_t n, function f, double relative_tolerance, double absolute_tolerance,
          multistep family = multistep::adams)
        : n_(n), f_(std::move(f)), relative_(relative_tolerance), absolute_(absolute_tolerance) {
#if SUNDIALS_VERSION_MAJOR >= 7
        check(SUNContext_Create(SUN_COMM_NULL, &context_), "SUNContext_Create");
        // by default they print every error, which the exception reports again
        check(SUNContext_ClearErrHandlers(context_), "SUNContext_ClearErrHandlers");
#else
        check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
#endif
        y_ = N_VNew_Serial(static_cast<sunindextype>(n), context_);
        matrix_ = SUNDenseMatrix(static_cast<sunindextype>(n), static_cast<sunindextype>(n), context_);
        solver_ = SUNLinSol_Dense(y_, matrix_, context_);
        memory_ = CVodeCreate(family == multistep::adams ? CV_ADAMS : CV_BDF, context_);
        if (y_ == nullptr || matrix_ == nullptr || solver_ == nullptr || memory_ == nullptr)
            throw std::runtime_error("CVODE: out of memory");
    }
    cvode(const cvode&) = delete;
    cvode& operator=(const cvode&) = delete;
    ~cvode() {
        CVodeFree(&memory_);
        SUNLinSolFree(solver_);
        SUNMatDestroy(matrix_);
        N_VDestroy(y_);
        SUNContext_Free(&context_);
    }

    /// Functions whose zeros end `advance`; direction -1 falling, 1 rising, 0 either. To be called before `start`.
    void watch(std::vector<int> directions, function g) {
        directions_ = std::move(directions);
        g_ = std::move(g);
    }

    /// Starts, or restarts after a jump, at (t, y).
    void start(double t, const std::vector<double>& y) {
        t_ = t;
        for (std::size_t c = 0; c < n_; ++c) data()[c] = y.at(c);
        if (started_) {
            evaluations_before_ = evaluations();
            check(CVodeReInit(memory_, t, y_), "CVodeReInit");
            return;
        }
        started_ = true;
        check(CVodeInit(memory_, &cvode::call_f, t, y_), "CVodeInit");
        check(CVodeSStolerances(memory_, relative_, absolute_), "CVodeSStolerances");
        check(CVodeSetUserData(memory_, this), "CVodeSetUserData");
        check(CVodeSetLinearSolver(memory_, solver_, matrix_), "CVodeSetLinearSolver");
        check(CVodeSetMaxNumSteps(memory_, 1000000), "CVodeSetMaxNumSteps");
        // A restart amid fast reactions begins with steps below the resolution of t, as it should.
        check(CVodeSetMaxHnilWarns(memory_, -1), "CVodeSetMaxHnilWarns");
        if (directions_.empty()) return;
        check(CVodeRootInit(memory_, static_cast<int>(directions_.size()), &cvode::call_g), "CVodeRootInit");
        check(CVodeSetRootDirection(memory_, directions_.data()), "CVodeSetRootDirection");
        check(CVodeSetNoInactiveRootWarn(memory_), "CVodeSetNoInactiveRootWarn");
    }

    /// Integrates to t_end, or to the next zero of a watched function. True if it stopped at one.
    bool advance(double t_end) { return advance(t_end, t_end); }

    /// Integrates to t by interpolation, so that no step is shortened for it; no step goes beyond t_end.
    bool advance(double t, double t_end) {
        // approached from the current point
        check(CVodeSetStopTime(memory_, t_end), "CVodeSetStopTime");
        const int flag = CVode(memory_, t, y_, &t_, CV_NORMAL);
        check(flag, "CVode");
        return flag == CV_ROOT_RETURN;
    }

    double t() const { return t_; }
    double y(std::size_t c) const { return NV_DATA_S(y_)[c]; }
    std::vector<double> state() const { return {NV_DATA_S(y_), NV_DATA_S(y_) + n_}; }
    /// The watched functions that are zero, after `advance` returned true.
    std::vector<int> found() const {
        std::vector<int> which(directions_.size());
        check(CVodeGetRootInfo(memory_, which.data()), "CVodeGetRootInfo");
        return which;
    }
    /// Evaluations of f so far, including those for its Jacobian.
    long evaluations() const {
        long in_steps = 0, in_jacobians = 0;
        check(CVodeGetNumRhsEvals(memory_, &in_steps), "CVodeGetNumRhsEvals");
        check(CVodeGetNumLinRhsEvals(memory_, &in_jacobians), "CVodeGetNumLinRhsEvals");
        return evaluations_before_ + in_steps + in_jacobians;
    }

private:
    static void check(int flag, const char* what) {
        if (flag >= 0) return;
        char* const name = CVodeGetReturnFlagName(flag);
        const std::string known = name == nullptr ? "" : name;
        std::free(name);
        throw std::runtime_error(std::string(what) + " failed with " + std::to_string(flag) + " (" + known + ")");
    }
    static int call_f(sunrealtype t, N_Vector y, N_Vector dy, void* self) {
        static_cast<cvode*>(self)->f_(t, NV_DATA_S(y), NV_DATA_S(dy));
        return 0;
    }
    static int call_g(sunrealtype t, N_Vector y, sunrealtype* g, void* self) {
        static_cast<cvode*>(self)->g_(t, NV_DATA_S(y), g);
        return 0;
    }
    double* data() { return NV_DATA_S(y_); }

    std::size_t n_;
    function f_, g_;
    double relative_, absolute_, t_ = 0;
    std::vector<int> directions_;
    bool started_ = false;
    long evaluations_before_ = 0;
    SUNContext context_ = nullptr;
    N_Vector y_ = nullptr;
    SUNMatrix matrix_ = nullptr;
    SUNLinearSolver solver_ = nullptr;
    void* memory_ = nullptr;
};

}  // namespace validation
