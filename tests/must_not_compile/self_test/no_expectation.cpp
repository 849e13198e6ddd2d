// SPDX-License-Identifier: MIT
// A wrong program without an expectation: check.sh must complain.
int wrong() { return nothing; }
