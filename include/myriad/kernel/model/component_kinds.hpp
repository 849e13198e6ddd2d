// SPDX-License-Identifier: MIT
// The kinds of components that a model may have, each written once: counts, names in messages, arrays, records, studies
// and the Python package follow from these lists.
#pragma once

#include <cstdint>

// A row has the kind, which is the name of its enumeration in a model, the plural in options and in Python, what
// messages call a component, and the type of a value. Rows are grouped by what happens to the values: states and
// accessories change in a call and can be recorded, parameters change only if the model declares it, and shared values
// are the same for all instances.
#define MYRIAD_STATE_KINDS(row) row(state, states, "state", R)
#define MYRIAD_PARAMETER_KINDS(row) row(parameter, parameters, "parameter", R)
#define MYRIAD_ACCESSORY_KINDS(row)             \
    row(accessory, accessories, "accessory", R) \
        row(integer_accessory, integer_accessories, "integer accessory", std::int32_t)
#define MYRIAD_SHARED_KINDS(row) \
    row(shared, shared, "shared parameter", R) row(shared_integer, shared_integers, "shared integer", std::int32_t)

/// Those that records may have.
#define MYRIAD_RECORDED_KINDS(row) MYRIAD_STATE_KINDS(row) MYRIAD_ACCESSORY_KINDS(row)
/// Those of which each instance has values of its own.
#define MYRIAD_INSTANCE_KINDS(row) MYRIAD_STATE_KINDS(row) MYRIAD_PARAMETER_KINDS(row) MYRIAD_ACCESSORY_KINDS(row)
/// Those with values that users set.
#define MYRIAD_VALUE_KINDS(row) \
    MYRIAD_STATE_KINDS(row) MYRIAD_PARAMETER_KINDS(row) MYRIAD_SHARED_KINDS(row) MYRIAD_ACCESSORY_KINDS(row)
/// Those that users name.
#define MYRIAD_COMPONENT_KINDS(row) MYRIAD_VALUE_KINDS(row) row(event, events, "event", void)
/// All that a model enumerates.
#define MYRIAD_ENUMERATED_KINDS(row)                                                  \
    MYRIAD_COMPONENT_KINDS(row)                                                       \
    row(observed, observed, "observed quantity", void) row(stop, stops, "stop", void) \
        row(trigger, triggers, "trigger", void) row(delayed, delayed_values, "delayed value", void)
