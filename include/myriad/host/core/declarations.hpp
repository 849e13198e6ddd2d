// SPDX-License-Identifier: MIT
// The library's types, declared: what <myriad/fwd.hpp> brings, and the one place of their default arguments.
#pragma once

#include <cstdint>

#include "myriad/kernel/methods/method_list.hpp"

namespace myriad {

template <class Model, class R = double>
class ensemble;
template <class Model, class R>
struct report;
template <class Model, class R>
class phase_records;
template <class Model, class R>
class trajectory_samples;
template <class Model, class Method, class R = double>
class solver;

class device;
class error;
class out_of_memory;
class component_list;
class per_component;
struct components;
struct event_options;
struct options;
struct record_options;
struct sample_options;

enum class action : std::uint8_t;
enum class advice;
enum class counting;
enum class direction;
enum class invalid_instances;
enum class phase_step;
enum class phase_time;
enum class schedule : std::uint8_t;
enum class shared_placement : std::uint8_t;
enum class status : std::uint8_t;

#define MYRIAD_DECLARE(method) struct method;
MYRIAD_METHODS(MYRIAD_DECLARE)
#undef MYRIAD_DECLARE

}  // namespace myriad
