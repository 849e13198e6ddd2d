#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `coupled_duffing` and its plot: the table, and that oscillators which start alike and have the same
# neighbours, mirrored at the odd one, stay alike. Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

check_arguments
expect 0 '' "$program" --small --device cpu --output table.csv
grep -q '^Steps from ' stdout || fail 'no steps'
check_table table.csv $((9 * 4 * 14)) instance,phase,x_start,v_start,unit,x,v,second_maximum,maxima,status
# Units 11 + d and 11 - d see the same ring; sums of their neighbours differ in their order alone, so by rounding, which
# the ring's divergence magnifies less than 1e6 times within four periods.
rows table.csv | awk -F, '
    function abs(a) { return a < 0 ? -a : a }
    { x[$1, $2, $5] = $6; maxima[$1, $2, $5] = $9; if ($10 != "success") bad = 1 }
    $5 == 13 {
        for (d = 1; d < 7; ++d)
            if (!(abs(x[$1, $2, (11 + d) % 14] - x[$1, $2, (11 - d) % 14]) <= 1e-9)) { print "not alike: " $0; bad = 1 }
        if (abs(x[$1, $2, 11] - x[$1, $2, 4]) > 1e-3) differ++
        if ($2 == 3 && maxima[$1, $2, 0] < 4) { print "too few maxima: " $0; bad = 1 }
    }
    END { exit bad || !differ }' || fail 'oscillators that see the same ring differ'
check_plot table.csv
echo 'All checks passed.'
