// SPDX-License-Identifier: MIT
// Gradients of a loss by SUNDIALS CVODES, for SUNDIALS 6 and 7: by its adjoint, CVodeF and CVodeB, which integrates the
// adjoint equations backwards along the interpolated solution, and by its forward sensitivities. adjoint_cvodes.py
// writes problem.hpp, compiles this file and calls `gradients`.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <stdexcept>
#include <string>
#include <vector>

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "problem.hpp"  // stiff, n_state, n_parameter, rhs, jacobian, transposed, along
#include "validation/cvodes.hpp"

namespace {

/// What a call computes: the sum over all times and states of (weight y)^2, and its derivatives by the parameters.
struct task {
    const double* start;
    const double* weight;  // of each state; one over it is its typical size
    const double* times;   // after the begin, which is 0
    int n_times;
    double tolerance;
};

void check(int flag, const char* what) {
    if (flag < 0) throw std::runtime_error(std::string(what) + " failed with " + std::to_string(flag));
}

/// The solvers of a solution or an adjoint solution: Newton's method for BDF, fixed-point iteration for Adams methods.
class solver {
public:
    solver(SUNContext context, N_Vector y)
        : matrix_(SUNDenseMatrix(NV_LENGTH_S(y), NV_LENGTH_S(y), context)),
          linear_(SUNLinSol_Dense(y, matrix_, context)), nonlinear_(SUNNonlinSol_FixedPoint(y, 0, context)) {}
    solver(const solver&) = delete;
    ~solver() {
        SUNLinSolFree(linear_);
        SUNMatDestroy(matrix_);
        SUNNonlinSolFree(nonlinear_);
    }
    void attach(void* memory) {
        if (!stiff) return check(CVodeSetNonlinearSolver(memory, nonlinear_), "CVodeSetNonlinearSolver");
        check(CVodeSetLinearSolver(memory, linear_, matrix_), "CVodeSetLinearSolver");
        check(CVodeSetJacFn(memory,
                            [](double, N_Vector y, N_Vector, SUNMatrix j, void* p, N_Vector, N_Vector, N_Vector) {
                                jacobian(NV_DATA_S(y), static_cast<double*>(p), SM_DATA_D(j));
                                return 0;
                            }),
              "CVodeSetJacFn");
    }
    void attach_backward(void* memory, int which) {
        if (!stiff) return check(CVodeSetNonlinearSolverB(memory, which, nonlinear_), "CVodeSetNonlinearSolverB");
        check(CVodeSetLinearSolverB(memory, which, linear_, matrix_), "CVodeSetLinearSolverB");
        check(CVodeSetJacFnB(
                  memory, which,
                  [](double, N_Vector y, N_Vector, N_Vector, SUNMatrix j, void* p, N_Vector, N_Vector, N_Vector) {
                      double of[n_state * n_state];
                      jacobian(NV_DATA_S(y), static_cast<double*>(p), of);
                      for (int r = 0; r < n_state; ++r)
                          for (int c = 0; c < n_state; ++c) SM_DATA_D(j)[c * n_state + r] = -of[r * n_state + c];
                      return 0;
                  }),
              "CVodeSetJacFnB");
    }

private:
    SUNMatrix matrix_;
    SUNLinearSolver linear_;
    SUNNonlinearSolver nonlinear_;
};

/// The loss and, with a gradient, its derivatives by the parameters.
double by_adjoint(SUNContext context, const task& t, double* parameters, double* gradient) {
    N_Vector y = N_VNew_Serial(n_state, context), scale = N_VNew_Serial(n_state, context);
    N_Vector costate = N_VNew_Serial(n_state, context), scale_of_costate = N_VNew_Serial(n_state, context);
    N_Vector integral = N_VNew_Serial(n_parameter, context), scale_of_integral = N_VNew_Serial(n_parameter, context);
    solver forwards(context, y), backwards(context, y);
    std::copy(t.start, t.start + n_state, NV_DATA_S(y));
    for (int c = 0; c < n_state; ++c) {
        NV_DATA_S(scale)[c] = t.tolerance / t.weight[c];
        NV_DATA_S(scale_of_costate)[c] = t.tolerance * t.weight[c];
    }
    for (int k = 0; k < n_parameter; ++k) NV_DATA_S(scale_of_integral)[k] = t.tolerance / parameters[k];
    const int method = stiff ? CV_BDF : CV_ADAMS;
    void* memory = CVodeCreate(method, context);
    check(CVodeInit(
              memory,
              [](double, N_Vector at, N_Vector slope, void* p) {
                  rhs(NV_DATA_S(at), static_cast<double*>(p), NV_DATA_S(slope));
                  return 0;
              },
              0, y),
          "CVodeInit");
    check(CVodeSVtolerances(memory, t.tolerance, scale), "CVodeSVtolerances");
    check(CVodeSetUserData(memory, parameters), "CVodeSetUserData");
    check(CVodeSetMaxNumSteps(memory, 1000000), "CVodeSetMaxNumSteps");
    forwards.attach(memory);
    if (gradient != nullptr) check(CVodeAdjInit(memory, 1000, CV_HERMITE), "CVodeAdjInit");
    std::vector<std::vector<double>> at;
    double loss = 0;
    for (int i = 0; i < t.n_times; ++i) {
        double reached = 0;
        int checkpoints = 0;
        if (gradient != nullptr)
            check(CVodeF(memory, t.times[i], y, &reached, CV_NORMAL, &checkpoints), "CVodeF");
        else
            check(CVode(memory, t.times[i], y, &reached, CV_NORMAL), "CVode");
        at.emplace_back(NV_DATA_S(y), NV_DATA_S(y) + n_state);
        for (int c = 0; c < n_state; ++c) loss += t.weight[c] * at.back()[c] * t.weight[c] * at.back()[c];
    }
    if (gradient != nullptr) {
        int which = 0;
        N_VConst(0, costate);
        N_VConst(0, integral);
        for (int i = t.n_times - 1; i >= 0; --i) {
            for (int c = 0; c < n_state; ++c)
                NV_DATA_S(costate)[c] += 2 * t.weight[c] * t.weight[c] * at[static_cast<std::size_t>(i)][c];
            if (i == t.n_times - 1) {
                check(CVodeCreateB(memory, method, &which), "CVodeCreateB");
                check(CVodeInitB(
                          memory, which,
                          [](double, N_Vector of, N_Vector v, N_Vector slope, void* p) {
                              transposed(NV_DATA_S(of), static_cast<double*>(p), NV_DATA_S(v), NV_DATA_S(slope),
                                         nullptr);
                              return 0;
                          },
                          t.times[i], costate),
                      "CVodeInitB");
                check(CVodeSVtolerancesB(memory, which, t.tolerance, scale_of_costate), "CVodeSVtolerancesB");
                check(CVodeSetUserDataB(memory, which, parameters), "CVodeSetUserDataB");
                check(CVodeSetMaxNumStepsB(memory, which, 1000000), "CVodeSetMaxNumStepsB");
                backwards.attach_backward(memory, which);
                check(CVodeQuadInitB(
                          memory, which,
                          [](double, N_Vector of, N_Vector v, N_Vector slope, void* p) {
                              transposed(NV_DATA_S(of), static_cast<double*>(p), NV_DATA_S(v), nullptr,
                                         NV_DATA_S(slope));
                              return 0;
                          },
                          integral),
                      "CVodeQuadInitB");
                check(CVodeQuadSVtolerancesB(memory, which, t.tolerance, scale_of_integral), "CVodeQuadSVtolerancesB");
                check(CVodeSetQuadErrConB(memory, which, 1), "CVodeSetQuadErrConB");
            } else {
                check(CVodeReInitB(memory, which, t.times[i], costate), "CVodeReInitB");
                check(CVodeQuadReInitB(memory, which, integral), "CVodeQuadReInitB");
            }
            double reached = 0;
            check(CVodeB(memory, i > 0 ? t.times[i - 1] : 0.0, CV_NORMAL), "CVodeB");
            check(CVodeGetB(memory, which, &reached, costate), "CVodeGetB");
            check(CVodeGetQuadB(memory, which, &reached, integral), "CVodeGetQuadB");
        }
        std::copy(NV_DATA_S(integral), NV_DATA_S(integral) + n_parameter, gradient);
    }
    CVodeFree(&memory);
    for (N_Vector v : {y, scale, costate, scale_of_costate, integral, scale_of_integral}) N_VDestroy(v);
    return loss;
}

/// The gradient by forward sensitivities, the reference.
void by_sensitivities(const task& t, const double* parameters, double* gradient) {
    validation::sensitivity_problem p;
    p.stiff = stiff;
    p.y.assign(t.start, t.start + n_state);
    p.f = [&](double, const double* y, double* slope) { rhs(y, parameters, slope); };
    p.g = [&](int i, double, const double* y, const double* s, double* slope) { along(i, y, parameters, s, slope); };
    std::fill(gradient, gradient + n_parameter, 0.0);
    p.s.assign(n_parameter, std::vector<double>(n_state, 0.0));
    p.scale.assign(parameters, parameters + n_parameter);
    double begin = 0;
    for (int i = 0; i < t.n_times; ++i) {
        validation::integrate_by_cvodes(p, t.times[i] - begin, t.tolerance, t.tolerance * t.tolerance);
        begin = t.times[i];
        for (int k = 0; k < n_parameter; ++k)
            for (int c = 0; c < n_state; ++c)
                gradient[k] += 2 * t.weight[c] * t.weight[c] * p.y[c] * p.s[static_cast<std::size_t>(k)][c];
    }
}

}  // namespace

/// Losses and gradients of `size` sets of parameters, in rows, and the seconds of processor time that they took;
/// without `gradients` the losses alone. With `forward` the gradients are those of forward sensitivities. Returns 1 if
/// CVODES failed.
extern "C" int gradients(int size, double* parameters, const double* start, const double* weight, const double* times,
                         int n_times, double tolerance, int forward, double* losses, double* gradients,
                         double* seconds) {
    const task t = {start, weight, times, n_times, tolerance};
    SUNContext context = nullptr;
#if SUNDIALS_VERSION_MAJOR >= 7
    if (SUNContext_Create(SUN_COMM_NULL, &context) != 0) return 1;
#else
    if (SUNContext_Create(nullptr, &context) != 0) return 1;
#endif
    const std::clock_t begin = std::clock();
    int failed = 0;
    try {
        for (int i = 0; i < size; ++i) {
            double* own = parameters + static_cast<std::ptrdiff_t>(i) * n_parameter;
            double* to = gradients == nullptr ? nullptr : gradients + static_cast<std::ptrdiff_t>(i) * n_parameter;
            if (forward != 0)
                by_sensitivities(t, own, to);
            else
                losses[i] = by_adjoint(context, t, own, to);
        }
    } catch (const std::exception&) {
        failed = 1;
    }
    *seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    SUNContext_Free(&context);
    return failed;
}
