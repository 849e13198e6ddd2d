#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `poincare` and its plot: where orbits double their period, and the return times near the first
# doubling. Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

header=instance,phase,c,x,z,return_time,status
check_arguments
"$program" --first 5 --last 8.6 --instances 361 --transient 2000 --phases 16 --quiet --output table.csv
check_table table.csv $((361 * 16)) "$header"
# The multiplier is -1 at these c, by CVODE (validation/case_studies/poincare.cpp). c goes in steps of 0.01, and what is
# nearer to a doubling than 0.002 may not have settled after 2000 returns. Points split by 0.5 (c - c0)^(1/2) or more:
# 0.02 for 0.002.
rows table.csv | awk -F, '
    $7 != "stopped_by_event" || $4 >= 0 || !($6 > 5.8 && $6 < 6.3) { print "wrong: " $0; bad = 1 }
    $1 != instance { if (NR > 1) end(); instance = $1; n = 0 }
    { c = $3; x[n++] = $4 }
    function abs(v) { return v < 0 ? -v : v }
    function end(  p, r, same) {
        for (p = 1; p < 16; p *= 2) {
            same = 1
            for (r = 0; r + p < n; ++r) same = same && abs(x[r + p] - x[r]) < 5e-3
            if (same) break
        }
        if (!(p in first)) first[p] = c
        last[p] = c
    }
    END {
        end()
        split("5.37593 7.77109 8.52879", doubling, " ")
        for (k = 1; k <= 3; ++k) {
            p = 2 ^ (k - 1)
            printf "period %d up to c = %g, period %d from c = %g on\n", p, last[p], 2 * p, first[2 * p]
            if (!(abs(last[p] - doubling[k]) <= 0.012 && abs(first[2 * p] - doubling[k]) <= 0.012)) {
                print "the doubling is at " doubling[k]
                bad = 1
            }
        }
        exit bad
    }' || fail 'not the doublings of the Floquet multipliers'
check_small $((1024 * 32)) "$header"
check_plot table.csv
echo 'All checks passed.'
