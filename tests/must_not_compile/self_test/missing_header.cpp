// expect: error
// SPDX-License-Identifier: MIT
// A program that fails only because an include is misspelt: check.sh must complain.
#include "myriad/mispelt.hpp"
