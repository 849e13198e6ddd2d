// SPDX-License-Identifier: MIT
// The library's types, declared: what <myriad/fwd.hpp> brings, and the one place of their default arguments.
#pragma once

#include <cstdint>

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
class component_list;
class per_component;
struct components;
struct event_options;
struct options;
struct record_options;
struct sample_options;

enum class action : std::uint8_t;
enum class schedule : std::uint8_t;
enum class status : std::uint8_t;

}  // namespace myriad
