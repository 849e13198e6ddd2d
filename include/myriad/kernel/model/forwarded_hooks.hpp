// SPDX-License-Identifier: MIT
// A model made of another one, as a system of units or a model with its tangents, has the functions of that one.
#pragma once

#include "myriad/kernel/model/hooks.hpp"

namespace myriad::detail {

// One layer for each optional function, which is there only if Model has it, as a function counts by its name alone.
// Each inherits the layer below and calls the function of that name of To.
namespace forwarded {

template <class Model, class To>
struct model : Model {};

#define MYRIAD_FORWARDED(layer, below, ...) \
    template <class Model, class To>        \
    struct layer : below<Model, To> {};     \
    template <class Model, class To>        \
    requires(__VA_ARGS__) struct layer<Model, To> : below<Model, To>

MYRIAD_FORWARDED(with_events, model, has_events<Model>){
    template <class R>
    MYRIAD_FUNCTION static auto events(auto t, const auto& y, const auto& p){return To::template events<R>(t, y, p);
}
};
MYRIAD_FORWARDED(with_observe, with_events, has_observe<Model>){
    template <class R>
    MYRIAD_FUNCTION static auto observe(auto t, const auto& y, const auto& p){return To::template observe<R>(t, y, p);
}
}
;
MYRIAD_FORWARDED(with_diffusion, with_observe, has_diffusion<Model>){
    template <class R> MYRIAD_FUNCTION static auto diffusion(auto t, const auto& y,
                                                             const auto& p){return To::template diffusion<R>(t, y, p);
}
}
;
MYRIAD_FORWARDED(with_initialise, with_diffusion,
                 has_initialise<Model>){MYRIAD_FUNCTION static void initialise(auto& lane){To::initialise(lane);
}
}
;
MYRIAD_FORWARDED(with_scalar_after_step, with_initialise, has_after_step<Model> && !To::after_step_is_generic){
    MYRIAD_FUNCTION static action after_step(auto& lane){return To::after_step(lane);
}
}
;
MYRIAD_FORWARDED(with_after_step, with_scalar_after_step, To::after_step_is_generic){
    template <class R> MYRIAD_FUNCTION static mask_of<R> after_step(auto& lane){return To::template after_step<R>(lane);
}
}
;
MYRIAD_FORWARDED(with_after_event, with_after_step, has_after_event<Model> || To::acts_at_all_events){
    MYRIAD_FUNCTION static action after_event(int event, auto& lane){return To::after_event(event, lane);
}
}
;
MYRIAD_FORWARDED(with_after_trigger, with_after_event, has_triggers<Model>) {
    static constexpr bool triggers_know_their_function = true;
    MYRIAD_FUNCTION static action after_trigger_by(int function, int trigger, auto& lane) {
        return To::after_trigger_by(function, trigger, lane);
    }
};
MYRIAD_FORWARDED(with_after_stop, with_after_trigger,
                 has_after_stop<Model>){MYRIAD_FUNCTION static action after_stop(int stop, int number, auto& lane){
    return To::after_stop(stop, number, lane);
}
}
;
MYRIAD_FORWARDED(with_finalise, with_after_stop,
                 has_finalise<Model>){MYRIAD_FUNCTION static void finalise(auto& lane){To::finalise(lane);
}
}
;
#undef MYRIAD_FORWARDED

}  // namespace forwarded

/// Model with each of its functions replaced by that of `To`, which says whether its `after_step` has a scalar type,
/// and whether `after_event` acts also at events of models without one.
template <class Model, class To>
using forwarded_hooks = forwarded::with_finalise<Model, To>;

}  // namespace myriad::detail
