// expect: anything
// SPDX-License-Identifier: MIT
// A correct program: check.sh must complain.
int right() { return 1; }
