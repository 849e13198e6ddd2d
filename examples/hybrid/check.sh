#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Compares the table of the program `hybrid` with the closed form of the stick-slip oscillation, and checks its exit
# statuses. Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

check_arguments
"$program" --instances 203 --transient 1 --phases 5 --output table.csv --quiet || fail 'the program failed'
# With kinetic friction k = 1/2, breakaway b = 1, speed w: slips at b, sticks at 2k - b, slides for 2 pi - 2
# atan((b-k)/w) and sticks for 2 (b-k)/w. A hundred steps at tolerances of 1e-10 may be wrong by 1e-8, and the time by
# that over the smallest speed, 0.1, at which the block arrives at an event.
awk -F, '
    /^#|^instance/ { next }
    {
        pi = atan2(0, -1); w = $3; d = 0.5; rows++
        exact = 2 * pi - 2 * atan2(d, w) + 2 * d / w
        if (!($4 - 1 < 1e-8 && 1 - $4 < 1e-8)) { print "wrong x_slip: " $0; wrong++ }
        if (!($5 < 1e-7 && -$5 < 1e-7)) { print "wrong x_stick: " $0; wrong++ }
        if (!($6 - exact < 1e-7 && exact - $6 < 1e-7)) { print "wrong period, " exact ": " $0; wrong++ }
        if ($7 != "stopped_by_event") { print "wrong status: " $0; wrong++ }
    }
    END { exit wrong > 0 || rows != 203 * 5 }' table.csv || fail 'the table is not that of the closed form'

check_small $((64 * 2)) instance,phase,belt,x_slip,x_stick,period,status
check_plot table.csv
echo 'All checks passed.'
