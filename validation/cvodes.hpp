// SPDX-License-Identifier: MIT
// SUNDIALS CVODES as a reference for forward sensitivities: BDF or Adams methods for the solution and its derivatives
// together, with error control of both. For SUNDIALS 6 and 7. Host code only; not in one program with cvode.hpp, as
// the library has CVODE's functions too.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace validation {

/// A solution of dy/dt = f(t, y) and derivatives of it, s[i][c], with ds[i]/dt = g(i, t, y, s[i]).
struct sensitivity_problem {
    std::function<void(double, const double*, double*)> f;
    std::function<void(int, double, const double*, const double*, double*)> g;
    std::vector<double> y;
    std::vector<std::vector<double>> s;
    std::vector<double> scale;  // of the components that s are by, one for each
    bool stiff = false;
};

/// Integrates from 0 to t, in place. Throws std::runtime_error if CVODES fails.
inline void integrate_by_cvodes(sensitivity_problem& p, double t_end, double relative, double absolute) {
    const auto check = [](int flag, const char* what) {
        if (flag < 0) throw std::runtime_error(std::string(what) + " failed with " + std::to_string(flag));
    };
    SUNContext context = nullptr;
#if SUNDIALS_VERSION_MAJOR >= 7
    check(SUNContext_Create(SUN_COMM_NULL, &context), "SUNContext_Create");
#else
    check(SUNContext_Create(nullptr, &context), "SUNContext_Create");
#endif
    const auto n = static_cast<sunindextype>(p.y.size());
    const int directions = static_cast<int>(p.s.size());
    N_Vector y = N_VMake_Serial(n, p.y.data(), context);
    std::vector<N_Vector> s;
    for (auto& column : p.s) s.push_back(N_VMake_Serial(n, column.data(), context));
    SUNMatrix matrix = SUNDenseMatrix(n, n, context);
    SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
    void* memory = CVodeCreate(p.stiff ? CV_BDF : CV_ADAMS, context);
    check(CVodeInit(
              memory,
              [](double t, N_Vector at, N_Vector slope, void* self) {
                  static_cast<sensitivity_problem*>(self)->f(t, NV_DATA_S(at), NV_DATA_S(slope));
                  return 0;
              },
              0, y),
          "CVodeInit");
    check(CVodeSStolerances(memory, relative, absolute), "CVodeSStolerances");
    check(CVodeSetUserData(memory, &p), "CVodeSetUserData");
    check(CVodeSetLinearSolver(memory, solver, matrix), "CVodeSetLinearSolver");
    check(CVodeSetMaxNumSteps(memory, 1000000), "CVodeSetMaxNumSteps");
    check(CVodeSetStopTime(memory, t_end), "CVodeSetStopTime");
    check(CVodeSensInit1(
              memory, directions, CV_STAGGERED,
              [](int, double t, N_Vector at, N_Vector, int i, N_Vector along, N_Vector slope, void* self, N_Vector,
                 N_Vector) {
                  static_cast<sensitivity_problem*>(self)->g(i, t, NV_DATA_S(at), NV_DATA_S(along), NV_DATA_S(slope));
                  return 0;
              },
              s.data()),
          "CVodeSensInit1");
    std::vector<double> absolutes;
    for (const double scale : p.scale) absolutes.push_back(absolute / scale);
    check(CVodeSensSStolerances(memory, relative, absolutes.data()), "CVodeSensSStolerances");
    check(CVodeSetSensErrCon(memory, 1), "CVodeSetSensErrCon");
    double t = 0;
    check(CVode(memory, t_end, y, &t, CV_NORMAL), "CVode");
    check(CVodeGetSens(memory, &t, s.data()), "CVodeGetSens");
    CVodeFree(&memory);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    for (N_Vector column : s) N_VDestroy(column);
    N_VDestroy(y);
    SUNContext_Free(&context);
}

}  // namespace validation
