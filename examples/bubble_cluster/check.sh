#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `bubble_cluster` and its plot: the table, and bubbles at rest without sound.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

check_arguments
expect 0 '' "$program" --small --device cpu --output table.csv
check_table table.csv $((8 * 2 * 128)) instance,phase,pressure,bubble,radius,x,y,z,y_end,status
# Without sound a bubble stays at rest; within rounding of its constants, 1e-16 of accelerations of some 1e5.
rows table.csv | awk -F, '
    $10 != "success" { print "failed: " $0; bad = 1 }
    $5 < 3 || $5 > 8 { print "radius: " $0; bad = 1 }
    $1 == 0 && !($9 - 1 < 1e-8 && 1 - $9 < 1e-8) { print "moves without sound: " $0; bad = 1 }
    $1 == 7 && ($9 > 1.05 || $9 < 0.95) { moves++ }
    END { exit bad || moves < 64 }' || fail 'not what sound does'
check_plot table.csv
echo 'All checks passed.'
