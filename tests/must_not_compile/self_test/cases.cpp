// case: compiles
// expect: anything
// case: other_message
// expect: anything
// SPDX-License-Identifier: MIT
// A correct program, and one with a different error than expected: check.sh must complain about each.
#ifdef CASE_other_message
int wrong() { return nothing; }
#endif
