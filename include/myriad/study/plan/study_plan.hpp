// SPDX-License-Identifier: MIT
// What a study computes and keeps, worked out from what its user asked for: the variables, where their values come
// from, the layout of the results, and the description that tells studies apart. Host code only.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "myriad/host/backend/arrays.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/axes.hpp"
#include "myriad/study/plan/layout.hpp"
#include "myriad/study/plan/reduction.hpp"

namespace myriad {

/// What is kept of every instance. What `options::record` and `options::samples` choose is kept too: a recorded state x
/// as variable "x" with dimension "phase", the time of the records as "t"; samples as "x_sample" and "t_sample" with
/// dimension "sample", their number as "stored_samples".
struct kept_values {
    /// Components whose last values are kept, as "x_end"; "t" for the time at which the last phase ended, "t_last".
    std::vector<std::string> end = {};
    bool records = true;  ///< whether records are kept; otherwise they are for reductions alone
    bool samples = true;  ///< the same for samples
    bool random = true;   ///< whether random values are kept, as "k" or "v_start"; otherwise only reductions see them
    bool status = true;   ///< how each instance ended, as "status" with CF's flags
    bool work = false;    ///< "phases_done", and if counted steps and evaluations: "accepted_steps", "rejected_steps",
                          ///< "located_steps", "rhs_evaluations"
};

namespace studies::inline MYRIAD_ABI {

/// Where the values of a variable come from.
enum class origin {
    axis,  ///< what was drawn at random for the instance
    record,
    record_time,
    sample,
    sample_time,
    stored_samples,
    end,
    end_time,
    status,
    phases_done,
#define MYRIAD_NAME_COUNTER(name, ...) name,
    MYRIAD_COUNTERS(MYRIAD_NAME_COUNTER)
#undef MYRIAD_NAME_COUNTER
};

/// A variable that is computed for each instance.
struct quantity {
    origin from;
    component what = {};  ///< of axis, record, sample or end
    variable as;
    bool stored = true;  ///< otherwise only a reduction needs it
};

/// What a study was asked for.
struct study_request {
    std::string method;
    element real = element::f64;
    myriad::axes axes;
    myriad::options options;
    kept_values keep;
    std::vector<ensemble_reduction> reductions;
    std::string generator;                     ///< stands for the function that generates instances; empty: none
    std::map<std::string, std::string> notes;  ///< further things that tell studies apart
    std::map<std::string, std::string> units;  ///< by component, and "t"
    std::string title;
    bool generates_itself = false;  ///< the generator is the model's own, which draws random numbers by the seed
};

/// A study ready to be computed.
struct study_plan {
    study_request asked;
    std::vector<quantity> quantities;
    std::vector<reduction_plan> reductions;  ///< of `asked.reductions`, in their order
    studies::layout content;                 ///< without a chunk size

    /// Bytes of all quantities of one instance.
    std::int64_t bytes_per_instance() const;
    /// Which quantities the host needs where a device sets and reduces instances itself: those that are stored, and
    /// those that a user's function reduces.
    std::vector<bool> needed_on_host() const;
    /// Bytes of these.
    std::int64_t bytes_needed_on_host() const;
};

/// Throws `error` if a component is unknown, if one that must be set is not, or if two variables have the same name.
study_plan plan_study(const study_request& asked);

/// The name under which the store keeps a reduction's partial results.
std::string partial_name(const ensemble_reduction& r);

}  // namespace studies::inline MYRIAD_ABI
}  // namespace myriad
