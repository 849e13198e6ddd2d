// expect: a method has one controller: choose pi_control or pid_control
// SPDX-License-Identifier: MIT
// Both would choose the length of the next step.
#include <myriad/methods.hpp>

using both = myriad::controlled<myriad::cash_karp, myriad::pi_control, myriad::pid_control>;

int main() { return both::stages; }
