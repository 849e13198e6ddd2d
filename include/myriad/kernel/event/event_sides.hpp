// SPDX-License-Identifier: MIT
// The side of zero on which each event function was last seen: all that an ordinary step needs to know of events.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/scalar/arithmetic.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// How a phase left an event function, for the next phase.
enum class kept_side : std::uint8_t {
    unknown = 0,  // where the function is when the next phase begins
    within = 1,   // zero up to rounding, reached from this side
    beyond = 2,   // its sign: if the next phase begins on the surface, a hook or the host moved the state there
    on_jump = 3,  // it fired right before a jump: the next phase must find out on which side it begins
    fired = 4,    // it fired: the next phase takes the side that the function is heading for
};

/// What a phase keeps of an event function for the next, in the four bytes of `kernel_arguments::side`. Zero is
/// nothing.
class kept_event {
public:
    MYRIAD_FUNCTION explicit kept_event(std::int32_t code) : code_(code) {}
    /// `lingered` is the number of actions in a row after which the function has not left the surface.
    MYRIAD_FUNCTION kept_event(bool above, kept_side kind, std::int32_t lingered)
        : code_((above ? 1 : 0) + 2 * static_cast<int>(kind) + 16 * (lingered < most ? lingered : most)) {}

    /// The same with how far from zero the event was located: the exponent of a value g of its function.
    template <class R>
    MYRIAD_FUNCTION kept_event at_value(R g) const {
        const auto exponent = arithmetic<R>::to_bits(abs(g)) >> mantissa_bits<R>;
        return kept_event(code_ + (static_cast<std::int32_t>(exponent) << exponent_place));
    }
    /// A bound on that: the next greater power of two.
    template <class R>
    MYRIAD_FUNCTION R value_bound() const {
        using bits = typename arithmetic<R>::bits;
        return arithmetic<R>::from_bits(static_cast<bits>((code_ >> exponent_place) + 1) << mantissa_bits<R>);
    }

    MYRIAD_FUNCTION std::int32_t code() const { return code_; }
    MYRIAD_FUNCTION bool above() const { return code_ % 2 != 0; }
    MYRIAD_FUNCTION kept_side kind() const { return static_cast<kept_side>(code_ / 2 % 8); }
    MYRIAD_FUNCTION std::int32_t lingered() const { return code_ / 16 % (most + 1); }
    /// Whether a function that is not on its surface now is on the side that it shows, and nothing else is known.
    MYRIAD_FUNCTION bool is_plain() const { return kind() == kept_side::unknown || kind() == kept_side::beyond; }

private:
    static constexpr std::int32_t most = 65535;  // which options::accumulation_limit does not exceed
    static constexpr int exponent_place = 20;    // of eleven bits at most
    template <class R>
    static constexpr int mantissa_bits = sizeof(R) == sizeof(double) ? 52 : 23;
    std::int32_t code_;
};

/// What every step of a pack compares its event functions with. What few steps need is in event_memory.
template <class Model, class S>
struct event_sides {
    using mask = mask_of<S>;
    using masks = mask_set<mask, n_event<Model>>;
    enum lane_flag {
        in_question,  // every trial has to go to the locator: event_memory says why
        locating,     // the next trial is redone, to end at an event
        undefined,    // a function is NaN at the committed state
        kept_plain,   // the last phase of the instance has kept all functions as beyond zero, or a hook has moved them
        lane_flags
    };
    masks above;  // last seen on the positive side
    masks left;   // the function has left the surface since the event last fired
    mask_set<mask, lane_flags> flags;

    MYRIAD_FUNCTION void clear() {
        above.clear();
        left.clear();
        flags.clear();
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
