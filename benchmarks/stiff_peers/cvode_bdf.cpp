// SPDX-License-Identifier: MIT
// CVODE's BDF with dense factors or KLU's. The Jacobian is the product of the reactions' stoichiometry and the
// derivatives of their rates, each entry at a fixed place of the matrix.
#include "cvode_bdf.hpp"

#include <algorithm>
#include <stdexcept>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#if defined(STIFF_PEERS_KLU)
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>
#endif

#include "problems/pollution.hpp"

namespace stiff_peers {
namespace {

constexpr int n = problems::pollution::n_state, n_reaction = 25;

/// A reaction's constant and the one or two substances that its rate is proportional to.
struct reaction {
    double k;
    int first, second;  // -1: none
};
constexpr reaction reactions[n_reaction] = {
    {0, 0, -1},       {26.6, 1, 3},     {12300, 4, 1},       {0.00086, 6, -1}, {0.00082, 6, -1},
    {15000, 6, 5},    {0.00013, 8, -1}, {24000, 8, 5},       {16500, 10, 1},   {9000, 10, 0},
    {0.022, 12, -1},  {12000, 9, 1},    {1.88, 13, -1},      {16300, 0, 5},    {4800000, 2, -1},
    {0.00035, 3, -1}, {0.0175, 3, -1},  {100000000, 15, -1}, {444e9, 15, -1},  {1240, 16, 5},
    {2.1, 18, -1},    {5.78, 18, -1},   {0.0474, 0, 3},      {1780, 18, 0},    {3.12, 19, -1}};

/// A substance that a reaction, numbered from 1, makes (or takes, if the number is negative) so many times.
struct yield {
    int substance, reaction, times;
};
constexpr yield yields[] = {
    {0, -1, 1},   {0, -10, 1},  {0, -14, 1},  {0, -23, 1}, {0, -24, 1},  {0, 2, 1},    {0, 3, 1},    {0, 9, 1},
    {0, 11, 1},   {0, 12, 1},   {0, 22, 1},   {0, 25, 1},  {1, -2, 1},   {1, -3, 1},   {1, -9, 1},   {1, -12, 1},
    {1, 1, 1},    {1, 21, 1},   {2, -15, 1},  {2, 1, 1},   {2, 17, 1},   {2, 19, 1},   {2, 22, 1},   {3, -2, 1},
    {3, -16, 1},  {3, -17, 1},  {3, -23, 1},  {3, 15, 1},  {4, -3, 1},   {4, 4, 2},    {4, 6, 1},    {4, 7, 1},
    {4, 13, 1},   {4, 20, 1},   {5, -6, 1},   {5, -8, 1},  {5, -14, 1},  {5, -20, 1},  {5, 3, 1},    {5, 18, 2},
    {6, -4, 1},   {6, -5, 1},   {6, -6, 1},   {6, 13, 1},  {7, 4, 1},    {7, 5, 1},    {7, 6, 1},    {7, 7, 1},
    {8, -7, 1},   {8, -8, 1},   {9, -12, 1},  {9, 7, 1},   {9, 9, 1},    {10, -9, 1},  {10, -10, 1}, {10, 8, 1},
    {10, 11, 1},  {11, 9, 1},   {12, -11, 1}, {12, 10, 1}, {13, -13, 1}, {13, 12, 1},  {14, 14, 1},  {15, -18, 1},
    {15, -19, 1}, {15, 16, 1},  {16, -20, 1}, {17, 20, 1}, {18, -21, 1}, {18, -22, 1}, {18, -24, 1}, {18, 23, 1},
    {18, 25, 1},  {19, -25, 1}, {19, 24, 1}};

void check(int flag) {
    if (flag < 0) throw std::runtime_error("CVODE failed");
}

class solver {
public:
    solver(factors which, double relative, double absolute) : which_(which) {
        plan();
#if SUNDIALS_VERSION_MAJOR >= 7
        check(SUNContext_Create(SUN_COMM_NULL, &context_));
#else
        check(SUNContext_Create(nullptr, &context_));
#endif
        y_ = N_VNew_Serial(n, context_);
        if (which == factors::dense) {
            matrix_ = SUNDenseMatrix(n, n, context_);
            linear_ = SUNLinSol_Dense(y_, matrix_, context_);
        } else {
#if defined(STIFF_PEERS_KLU)
            matrix_ = SUNSparseMatrix(n, n, entries_, CSC_MAT, context_);
            linear_ = SUNLinSol_KLU(y_, matrix_, context_);
#endif
        }
        memory_ = CVodeCreate(CV_BDF, context_);
        if (y_ == nullptr || matrix_ == nullptr || linear_ == nullptr || memory_ == nullptr)
            throw std::runtime_error("CVODE: out of memory");
        std::fill_n(NV_DATA_S(y_), n, 0.0);
        check(CVodeInit(memory_, &slopes, 0, y_));
        check(CVodeSStolerances(memory_, relative, absolute));
        check(CVodeSetUserData(memory_, this));
        check(CVodeSetLinearSolver(memory_, linear_, matrix_));
        check(CVodeSetJacFn(memory_, which == factors::dense ? &dense_jacobian : &sparse_jacobian));
        check(CVodeSetMaxNumSteps(memory_, 1000000));
    }
    solver(const solver&) = delete;
    solver& operator=(const solver&) = delete;
    ~solver() {
        CVodeFree(&memory_);
        SUNLinSolFree(linear_);
        SUNMatDestroy(matrix_);
        N_VDestroy(y_);
        SUNContext_Free(&context_);
    }

    void integrate(double k1, double* state) {
        k1_ = k1;
        std::copy(state, state + n, NV_DATA_S(y_));
        check(CVodeReInit(memory_, 0, y_));
        check(CVodeSetStopTime(memory_, problems::pollution::t_end));
        double t = 0;
        check(CVode(memory_, problems::pollution::t_end, y_, &t, CV_NORMAL));
        std::copy(NV_DATA_S(y_), NV_DATA_S(y_) + n, state);
    }

private:
    /// Where each term of the Jacobian goes: to an entry of the matrix, by column and then by row.
    void plan() {
        bool present[n][n]{};  // of a column and a row
        for (int i = 0; i < n; ++i) present[i][i] = true;
        for (const yield& one : yields)
            for (const int of : {on(one).first, on(one).second})
                if (of >= 0) present[of][one.substance] = true;
        int number[n][n]{};
        for (int j = 0; j < n; ++j) {
            column_begin_[j] = entries_;
            for (int i = 0; i < n; ++i)
                if (present[j][i]) {
                    row_[entries_] = i;
                    number[j][i] = entries_++;
                }
        }
        column_begin_[n] = entries_;
        int term = 0;
        for (const yield& one : yields)
            for (const int of : {on(one).first, on(one).second})
                if (of >= 0)
                    place_[term++] = which_ == factors::dense ? of * n + one.substance : number[of][one.substance];
    }
    static const reaction& on(const yield& one) { return reactions[std::abs(one.reaction) - 1]; }
    double constant(int r) const { return r == 0 ? k1_ : reactions[r].k; }

    static int slopes(sunrealtype, N_Vector y, N_Vector dy, void* self) {
        struct {
            double k1;
            double operator[](int) const { return k1; }
        } p{static_cast<solver*>(self)->k1_};
        myriad::vec<double, n> values;
        std::copy(NV_DATA_S(y), NV_DATA_S(y) + n, &values[0]);
        const auto f = problems::pollution::rhs<double>(0.0, values, p);
        std::copy(&f[0], &f[0] + n, NV_DATA_S(dy));
        return 0;
    }
    /// Adds the terms to the entries, which are zero.
    void add_terms(const double* y, double* entry) const {
        double by_first[n_reaction], by_second[n_reaction];
        for (int r = 0; r < n_reaction; ++r) {
            const bool two = reactions[r].second >= 0;
            by_first[r] = constant(r) * (two ? y[reactions[r].second] : 1.0);
            by_second[r] = two ? constant(r) * y[reactions[r].first] : 0.0;
        }
        const int* place = place_;
        for (const yield& one : yields) {
            const int r = std::abs(one.reaction) - 1;
            const double times = one.reaction < 0 ? -one.times : one.times;
            entry[*place++] += times * by_first[r];
            if (reactions[r].second >= 0) entry[*place++] += times * by_second[r];
        }
    }
    static int dense_jacobian(sunrealtype, N_Vector y, N_Vector, SUNMatrix j, void* self, N_Vector, N_Vector,
                              N_Vector) {
        double* const entry = SUNDenseMatrix_Data(j);
        std::fill_n(entry, n * n, 0.0);
        static_cast<solver*>(self)->add_terms(NV_DATA_S(y), entry);
        return 0;
    }
    static int sparse_jacobian([[maybe_unused]] sunrealtype t, [[maybe_unused]] N_Vector y, N_Vector,
                               [[maybe_unused]] SUNMatrix j, [[maybe_unused]] void* self, N_Vector, N_Vector,
                               N_Vector) {
#if defined(STIFF_PEERS_KLU)
        const solver& s = *static_cast<solver*>(self);
        std::copy(s.column_begin_, s.column_begin_ + n + 1, SUNSparseMatrix_IndexPointers(j));
        std::copy(s.row_, s.row_ + s.entries_, SUNSparseMatrix_IndexValues(j));
        double* const entry = SUNSparseMatrix_Data(j);
        std::fill_n(entry, s.entries_, 0.0);
        s.add_terms(NV_DATA_S(y), entry);
#endif
        return 0;
    }

    factors which_;
    double k1_ = 0;
    int entries_ = 0, place_[2 * std::size(yields)]{};
    sunindextype column_begin_[n + 1]{}, row_[n * n]{};
    SUNContext context_ = nullptr;
    N_Vector y_ = nullptr;
    SUNMatrix matrix_ = nullptr;
    SUNLinearSolver linear_ = nullptr;
    void* memory_ = nullptr;
};

}  // namespace

bool is_built([[maybe_unused]] factors which) {
#if defined(STIFF_PEERS_KLU)
    return true;
#else
    return which == factors::dense;
#endif
}

void integrate_by_cvode(factors which, double relative, double absolute, const std::vector<double>& k1,
                        std::vector<double>& states) {
    solver one(which, relative, absolute);
    for (std::size_t i = 0; i < k1.size(); ++i) one.integrate(k1[i], &states[i * n]);
}

}  // namespace stiff_peers
