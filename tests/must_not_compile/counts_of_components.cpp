// case: misspelt_count_of_states
// expect: an enumeration .state. without its count: make n_state its last enumerator
// case: misspelt_count_of_parameters
// expect: an enumeration .parameter. without its count: make n_parameter its last enumerator
// case: misspelt_count_of_shared_values
// expect: an enumeration .shared. without its count: make n_shared its last enumerator
// case: misspelt_count_of_shared_integers
// expect: an enumeration .shared_integer. without its count: make n_shared_integer its last enumerator
// case: misspelt_count_of_accessories
// expect: an enumeration .accessory. without its count: make n_accessory its last enumerator
// case: misspelt_count_of_integer_accessories
// expect: an enumeration .integer_accessory. without its count: make n_integer_accessory its last enumerator
// case: misspelt_count_of_events
// expect: an enumeration .event. without its count: make n_event its last enumerator
// case: enumeration_class_of_parameters
// expect: an enumeration .parameter. without its count.*without .class.
// case: private_enumerations
// expect: the model.s n_state is private: a model is a struct
// case: misspelt_count_of_an_unnamed_enumeration_of_parameters
// expect: the model has no parameter: end its enumeration with the enumerator n_parameter
// case: misspelt_count_of_an_unnamed_enumeration_of_shared_values
// expect: the model has no shared: end its enumeration with the enumerator n_shared
// case: misspelt_count_of_an_unnamed_enumeration_of_accessories
// expect: the model has no components of this kind: end their enumeration with the enumerator that counts them
// SPDX-License-Identifier: MIT
// A misspelt or hidden count of components would count as none.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

#ifdef CASE_private_enumerations
class model {  // members of a class are private by default
#else
struct model {
#endif
#ifdef CASE_misspelt_count_of_states
    enum state { x, n_states };
#else
    enum state { x, n_state };
#endif
#ifdef CASE_misspelt_count_of_parameters
    enum parameter { c, n_parameters };
#endif
#ifdef CASE_misspelt_count_of_shared_values
    enum shared { c, n_share };
#endif
#ifdef CASE_misspelt_count_of_shared_integers
    enum shared_integer { c, n_shared_integers };
#endif
#ifdef CASE_misspelt_count_of_accessories
    enum accessory { c, n_accessories };
#endif
#ifdef CASE_misspelt_count_of_integer_accessories
    enum integer_accessory { c, n_integer_accessories };
#endif
#ifdef CASE_misspelt_count_of_events
    enum event { c, n_events };
#endif
#ifdef CASE_enumeration_class_of_parameters  // its enumerators are not members of the model
    enum class parameter { k, n_parameter };
#endif

// Without the name of the enumeration, the index shows it.
#ifdef CASE_misspelt_count_of_an_unnamed_enumeration_of_parameters
    enum { k, n_parameters };
#define SLOPE(y, p) p[k]
#elif defined CASE_misspelt_count_of_an_unnamed_enumeration_of_shared_values
    enum { k, n_share };
#define SLOPE(y, p) p.shared[k]
#else
#define SLOPE(y, p) y[0]
#endif
#ifdef CASE_misspelt_count_of_an_unnamed_enumeration_of_accessories
    enum { c, n_accessories };
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.accessory[c] = lane.y[x]; }
#endif

public:
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto& p) {
        static_cast<void>(p);
        return myriad::vec<R, 1>{-(SLOPE(y, p) * y[0])};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
