// case: compiles
// expect: anything
// case: other_message
// expect: anything
// SPDX-License-Identifier: MIT
// A right program, and one that is wrong for another reason than expected: check.sh must complain of each.
#ifdef CASE_other_message
int wrong() { return nothing; }
#endif
