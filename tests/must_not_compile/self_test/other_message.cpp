// expect: this text is in the source line, not in the message
// SPDX-License-Identifier: MIT
// A wrong program that fails for another reason than expected: check.sh must complain.
int wrong() { return nothing; }  // this text is in the source line, not in the message
