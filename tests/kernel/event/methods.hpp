// SPDX-License-Identifier: MIT
// The methods for the tests of events. The high-order method, whose interpolant has stages of its own, takes long to
// compile: it is used everywhere in preset nightly, and once in all others.
#pragma once

#include <myriad/methods.hpp>

#define LOW_ORDER_METHODS myriad::cash_karp, myriad::tsitouras_5, myriad::runge_kutta_4
#define ALL_ORDERS LOW_ORDER_METHODS, myriad::dormand_prince_8
#if defined(MYRIAD_NIGHTLY)
#define ALL_METHODS ALL_ORDERS
#else
#define ALL_METHODS LOW_ORDER_METHODS
#endif
