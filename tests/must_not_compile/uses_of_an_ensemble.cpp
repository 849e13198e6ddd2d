// case: state_asked_for_by_another_enumerator
// expect: this enumerator is not a state
// case: parameter_asked_for_by_another_enumerator
// expect: this enumerator is not a parameter
// case: accessory_asked_for_by_another_enumerator
// expect: this enumerator is not a accessory
// case: integer_accessory_asked_for_by_another_enumerator
// expect: this enumerator is not a integer.accessory
// case: shared_asked_for_by_another_enumerator
// expect: this enumerator is not a shared
// case: shared_integer_asked_for_by_another_enumerator
// expect: this enumerator is not a shared.integer
// case: samples_asked_for_by_another_enumerator
// expect: this enumerator is not a state
// case: record_asked_for_by_another_enumerator
// expect: this enumerator is not a state
// case: shared_inherited_beside_an_enumeration_declared_anew
// expect: this enumerator is not a shared of the model; where the model declares anew .* give those of the inherited one as numbers
// case: state_of_an_ensemble_that_is_gone
// expect: use of deleted function|call to deleted member function|attempt to use a deleted function
// case: samples_of_an_ensemble_that_is_gone
// expect: use of deleted function|call to deleted member function|attempt to use a deleted function
// case: record_of_a_report_that_is_gone
// expect: use of deleted function|call to deleted member function|attempt to use a deleted function
// case: copied_ensemble
// expect: deleted
// case: ensemble_of_integers
// expect: an ensemble.s real type is double or float
// SPDX-License-Identifier: MIT
// What host code may not do with an ensemble.
#include "myriad/myriad.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
    enum accessory { peak, n_accessory };
    enum integer_accessory { count, n_integer_accessory };
    enum shared { force, n_shared };
    enum shared_integer { mode, n_shared_integer };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
};
using ensemble = myriad::ensemble<decay>;

// An enumerator of another kind is a mistake, even if its number fits.
#ifdef CASE_state_asked_for_by_another_enumerator
auto look(ensemble& sweep) { return sweep.state(decay::k); }
#endif
#ifdef CASE_parameter_asked_for_by_another_enumerator
auto look(ensemble& sweep) { return sweep.parameter(decay::x); }
#endif
#ifdef CASE_accessory_asked_for_by_another_enumerator
auto look(ensemble& sweep) { return sweep.accessory(decay::count); }
#endif
#ifdef CASE_integer_accessory_asked_for_by_another_enumerator
auto look(ensemble& sweep) { return sweep.integer_accessory(decay::peak); }
#endif
#ifdef CASE_shared_asked_for_by_another_enumerator
auto look(ensemble& sweep) { return sweep.shared(decay::k); }
#endif
#ifdef CASE_shared_integer_asked_for_by_another_enumerator
auto look(ensemble& sweep) { return sweep.shared_integer(decay::force); }
#endif
#ifdef CASE_samples_asked_for_by_another_enumerator
auto look(const ensemble& sweep) { return sweep.samples().state(decay::k); }
#endif
#ifdef CASE_record_asked_for_by_another_enumerator
auto look(const myriad::report<decay, double>& report) { return report.records.state(decay::k); }
#endif

// A model's inherited enumerations cannot be detected; the declared ones are its own.
#ifdef CASE_shared_inherited_beside_an_enumeration_declared_anew
struct limited : decay {
    enum shared { limit = decay::n_shared, n_shared };
};
auto look(myriad::ensemble<limited>& sweep) { return sweep.shared(limited::force); }
#endif

// A map of numbers must not outlive their owner.
ensemble made() { return ensemble(10); }
#ifdef CASE_state_of_an_ensemble_that_is_gone
double largest() {
    const auto x = made().state(decay::x);
    return x.maxCoeff();
}
#endif
#ifdef CASE_samples_of_an_ensemble_that_is_gone
double largest() {
    const auto x = made().samples().state(decay::x);
    return x.maxCoeff();
}
#endif
#ifdef CASE_record_of_a_report_that_is_gone
double largest(ensemble& sweep) {
    const auto x = myriad::solve<myriad::cash_karp>(myriad::device::cpu(), sweep).records.state(decay::x);
    return x.maxCoeff();
}
#endif

// An ensemble is moved, not copied by accident, and its reals are double or float.
#ifdef CASE_copied_ensemble
ensemble twice(const ensemble& sweep) { return sweep; }
#endif
#ifdef CASE_ensemble_of_integers
myriad::ensemble<decay, int> sweep(10);
#endif
