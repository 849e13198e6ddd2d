// case: summary_into_an_accessory_that_is_not_there
// expect: a summary goes into an accessory that the model does not have
// case: summary_of_a_quantity_that_is_not_observed
// expect: a summary names a quantity that is not observed
// case: summary_with_accessory_and_quantity_exchanged
// expect: a summary names a quantity that is not observed
// case: time_of_a_maximum_without_the_maximum
// expect: the time of an extremum needs the extremum itself
// case: two_summaries_into_one_accessory
// expect: two summaries go into the same accessory
// case: observe_with_a_result_of_the_wrong_size
// expect: observe has a wrong signature: it must be
// case: observe_with_a_wrong_signature
// expect: observe has a wrong signature: it must be
// case: observe_without_summaries
// expect: a model that observes has all three of
// case: summaries_without_observe
// expect: a model that observes has all three of
// SPDX-License-Identifier: MIT
// Quantities that cannot be observed or summarised.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
    enum accessory { largest, at, n_accessory };
    enum observed { height, n_observed };

    using over = myriad::over_phase;
#if defined CASE_summary_into_an_accessory_that_is_not_there
    static constexpr myriad::summary summaries[] = {{height, over::maximum, n_accessory}};
#elif defined CASE_summary_of_a_quantity_that_is_not_observed
    static constexpr myriad::summary summaries[] = {{n_observed, over::maximum, largest}};
#elif defined CASE_summary_with_accessory_and_quantity_exchanged
    static constexpr myriad::summary summaries[] = {{largest, over::maximum, height}};
#elif defined CASE_time_of_a_maximum_without_the_maximum  // its accessory stores the largest value so far
    static constexpr myriad::summary summaries[] = {{height, over::time_of_maximum, at}};
#elif defined CASE_two_summaries_into_one_accessory       // one would overwrite the other
    static constexpr myriad::summary summaries[] = {{height, over::maximum, largest}, {height, over::minimum, largest}};
#elif !defined CASE_observe_without_summaries             // the observed quantities would go nowhere
    static constexpr myriad::summary summaries[] = {{height, over::maximum, largest}};
#endif

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
#if defined CASE_observe_with_a_result_of_the_wrong_size
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, 2>{y[x], y[x]};
    }
#elif defined CASE_observe_with_a_wrong_signature
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y) {
        return myriad::vec<R, n_observed>{y[x]};
    }
#elif !defined CASE_summaries_without_observe
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{y[x]};
    }
#endif
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
