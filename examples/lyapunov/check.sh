#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `lyapunov` and its plot: the exponents of the fixed point at rho = 0, the sums, and the files.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

header=instance,rho,lambda_1,lambda_2,lambda_3,status
check_arguments
"$program" --instances 26 --transient 100 --phases 200 --quiet --output table.csv
check_table table.csv 26 "$header"
rows table.csv | awk -F, '
    $6 != "success" { print "failed: " $0; bad = 1 }
    # The divergence is -(10 + 1 + 8/3). Some 100 steps per unit of time, each of which errs by 1e-8 in three tangents;
    # where solutions oscillate faster, more of them.
    ($3 + $4 + $5 + 41 / 3) ^ 2 > 1e-10 { print "wrong sum: " $0; bad = 1 }
    # The eigenvalues at the origin for rho = 0. Tangents turn to theirs within 100 phases, of which 1/50 is left over.
    NR == 1 && (($3 + 1) ^ 2 > 1e-6 || ($4 + 8 / 3) ^ 2 > 1e-6 || ($5 + 10) ^ 2 > 1e-6) { print "wrong: " $0; bad = 1 }
    END { exit bad }' || fail 'wrong exponents'
check_small 200 "$header"
check_plot table.csv
echo 'All checks passed.'
