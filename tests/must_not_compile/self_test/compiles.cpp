// expect: anything
// SPDX-License-Identifier: MIT
// A right program: check.sh must complain.
int right() { return 1; }
