// expect: this text is in the source line, not in the message
// SPDX-License-Identifier: MIT
// A wrong program with a different error than expected: check.sh must complain.
int wrong() { return nothing; }  // this text is in the source line, not in the message
