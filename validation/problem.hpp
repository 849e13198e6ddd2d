// SPDX-License-Identifier: MIT
// A validation problem with the known and computed results about it, without the types of its model: so that every
// measure is written once, for all problems, methods and precisions.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <myriad/device.hpp>
#include <myriad/kernel/core/status.hpp>
#include <myriad/options.hpp>

namespace validation {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
inline constexpr double eps_double = std::numeric_limits<double>::epsilon();
inline constexpr double eps_float = std::numeric_limits<float>::epsilon();

/// The start of an instance, its parameters, and the end of its integration.
struct instance {
    std::vector<double> state, parameter;
    double t_end = 0;  // from 0
};

/// The solution of one instance: by CVODE, in closed form, or in quadruple precision. NaN: unknown.
struct solution {
    std::vector<double> end, accessory;
    std::vector<int> count;                    // integer accessories
    std::vector<std::vector<double>> samples;  // by time, then by sampled state
    long evaluations = 0;
    double seconds = 0;
};

/// The factor by which an error of one step may have grown: the largest |d output / d y_j(t)| max(1, |y_j(t)|), summed
/// over j and over all t examined.
struct conditioning {
    double end = 0, path = 0, invariant = 0;
    std::vector<double> accessory;
};

/// Results of one run of an ensemble, in double whatever the precision of the run.
struct outcome {
    std::vector<solution> instances;
    std::vector<myriad::status> status;
    std::vector<double> accepted, rejected, evaluations, next_step;
    double seconds = 0;
    double sum(const std::vector<double>& work) const {
        double total = 0;
        for (const double w : work) total += w;
        return total;
    }
};

struct problem;

/// A method in one precision, compiled for a problem's model.
struct method_entry {
    std::string name, precision;
    double eps = eps_double;
    int order = 0, embedded_order = 0;  // 0: fixed steps
    bool implicit = false;
    int interpolant_order = 0;  // of the method's own interpolant; 0: the cubic Hermite polynomial
    std::function<outcome(const problem&, const myriad::options&, const myriad::device&)> run;

    bool adaptive() const { return embedded_order > 0; }
    /// Methods of high order reach rounding within a few halvings of a step, and take steps in which a function may
    /// cross twice.
    bool takes_long_steps() const { return order >= 7; }
    /// The error of the Hermite polynomial's samples is independent of the tolerance. The interpolant of order seven of
    /// dormand_prince_8 is less accurate than its steps where stability limits them: as in other DOP853 codes, up to a
    /// hundred times the tolerance.
    bool samples_keep_tolerance() const { return interpolant_order > 0 && interpolant_order < 7; }
};

/// Parameters of a CVODE run.
struct accuracy {
    double tolerance = 1e-13;
    std::int64_t samples = 0;  // evenly over the domain, ends included
};

struct problem {
    std::string name, what;  // what: the equations, and how the instances differ
    std::vector<instance> instances;
    std::vector<double> shared;
    std::vector<myriad::event_options> events = {};
    std::vector<int> event_times = {};  // accessories that are times of events; others are values
    int events_per_instance = 0;        // at most, for the bounds
    std::vector<int> sampled = {};      // states for dense output; empty: none
    std::int64_t samples = 212;         // over a prime number of intervals, so that they fall inside steps
    /// Longest of the fixed steps for the measured orders, then halved. 0: not measured (not smooth, or stability
    /// bounds the step).
    double longest_step = 0;
    /// Fixed steps of methods without error estimate, in the other measures.
    double fixed_step = 0.01;
    /// Whether the error follows the tolerance; not where stability bounds the step.
    bool error_follows_tolerance = true;
    double error_of_a_step = 1;  // bound on an accepted step's error, in tolerances
    bool stiff = false;

    std::vector<method_entry> methods;
    std::function<solution(const instance&, const accuracy&)> by_cvode;
    /// Closed form or quadruple precision, or nothing; unknown components are NaN.
    std::function<solution(const instance&, std::int64_t samples)> exactly = {};
    /// The error of `exactly` for these equations; above 0, CVODE remains the reference and is compared with it.
    double closed_form_error = 0;
    /// The first instance's state after one step of that length, by method, from published coefficients.
    std::map<std::string, std::vector<double>> one_step = {};
    double one_step_length = 0;
    std::function<conditioning(const instance&)> conditions;
    /// All instances by Boost.odeint's controlled Cash-Karp stepper, or nothing.
    std::function<outcome(const problem&, double tolerance)> by_odeint = {};
    /// Constants of motion, or nothing.
    std::function<std::vector<double>(const instance&, const std::vector<double>&)> invariants = {};

    /// The problem's instances repeated, for timing.
    problem repeated(int times) const {
        problem p = *this;
        for (int k = 1; k < times; ++k) p.instances.insert(p.instances.end(), instances.begin(), instances.end());
        return p;
    }
    double event_tolerance() const { return events.empty() ? 0 : events.front().tolerance; }
};

}  // namespace validation
