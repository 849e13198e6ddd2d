// SPDX-License-Identifier: MIT
// The kernels of the impact model.
#include "tests/properties/pack_sizes_body.hpp"

#if !defined(MYRIAD_ONE_BATCH)  // preset strict has larger packs
namespace {

struct rare_bouncer : properties::bouncer {
    static constexpr bool rare_events = true;
};
struct chosen_bouncer : rare_bouncer {
    static constexpr int pack_batches = 4;
};
template <class Model>
constexpr int batches = myriad::detail::default_batches<Model, myriad::cash_karp>();
constexpr bool packs = batches < properties::bouncer >> 0;  // not with sanitizers
static_assert(!packs || batches<properties::bouncer> == 1, "events take a pack of one batch");
static_assert(!packs || batches<rare_bouncer> > 1, "rare events take a larger pack");
static_assert(!packs || batches<chosen_bouncer> == 4, "a model may choose");

}  // namespace
#endif

RUN_WITH_PACKS(properties::bouncer, myriad::cash_karp, double)
#if defined(MYRIAD_NIGHTLY)
RUN_WITH_PACKS(properties::bouncer, myriad::runge_kutta_4, double)
#endif
