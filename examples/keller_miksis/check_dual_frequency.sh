#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `bubble_dual_frequency` and its plot: waves exchanged give the same in physical units, and two
# waves of one frequency are one with the sum of their amplitudes.
# Usage: check_dual_frequency.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"
header=instance,pa1_bar,pa2_bar,f1_kHz,f2_kHz,expansion,compression,collapse_us,winding,status

check_arguments
expect 2 'pressures-1' "$program" --pressures-1 -1

# The unit of time is another one with the waves exchanged, so all steps are. Some 2000 steps with errors of 1e-10 give
# 2e-7. Times are less sharp: at a minimum by 1e-3 / y'', where y'' is (y - 1) (2 pi f / f1)^2 at least.
"$program" --pressures-1 0.5 --pressures-2 0.5 --instances 8 --transient 4 --phases 8 --quiet --output exchanged.csv
check_table exchanged.csv 64 "$header"
rows exchanged.csv | awk -F, '
    function differ(a, b, tolerance) { return !((a - b) ^ 2 <= (tolerance * b) ^ 2) }
    { exchanged = $5 "," $4 }
    $10 != "stopped_by_event" { print "failed: " $0; bad = 1 }
    exchanged in radius {
        if (differ($6 + 1, radius[exchanged], 1e-6) || differ($7, ratio[exchanged], 1e-6) ||
            differ($8, time[exchanged], 1e-3) || differ($9 * $4, rate[exchanged], 1e-6)) {
            print "another result with exchanged waves: " $0; bad = 1
        }
        ++compared
    }
    { radius[$4 "," $5] = $6 + 1; ratio[$4 "," $5] = $7; time[$4 "," $5] = $8; rate[$4 "," $5] = $9 * $4 }
    END { if (compared != 28) { print compared " pairs"; bad = 1 }; exit bad }' || fail 'exchanging the waves matters'

# Rounding apart the same equations: 0.5 + 0.7 bar, or 1.2 + 0 bar, both with f1.
"$program" --pressures-1 0.5 1.2 --pressures-2 0.7 0 --instances 5 --transient 2 --phases 8 --quiet --output sums.csv
check_table sums.csv 100 "$header"
rows sums.csv | awk -F, '
    $4 != $5 { next }
    $2 == 0.5 && $3 == 0.7 { sum[$4] = $7; radius[$4] = $6 }
    $2 == 1.2 && $3 == 0 {
        if (!(($7 / sum[$4] - 1) ^ 2 < 1e-12 && ($6 / radius[$4] - 1) ^ 2 < 1e-12)) { print "no sum: " $0; bad = 1 }
        ++compared
    }
    END { exit bad || compared != 5 }' || fail 'two waves of one frequency are not their sum'

check_small 576 "$header"
if rows small.csv | grep -q nan; then fail 'values are missing'; fi
check_plot small.csv plot_dual_frequency.py
echo 'All checks passed.'
