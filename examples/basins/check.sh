#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `basins` and its plot: basins that mirror each other, shares of a third, and that no pendulum that
# was stopped early would have left. validation/case_studies compares single pendulums with CVODE.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

check_arguments
"$program" --small --to-the-end --output table.csv 2>stderr >found || fail "a pendulum has left its magnet: $(<found)"
check_table table.csv $((160 * 160)) x,y,magnet,t
grep -q '^Of 25600 captured instances 0 are over another magnet at the end' found ||
    fail "not all were captured: $(<found)"
saved=$(sed -n 's/^Steps: .* without, \([0-9]*\).*% saved/\1/p' found)
# 78 % at full size.
((saved >= 70)) || fail "the criterion saved no more than '$saved' % of the steps"

rows table.csv | awk -F, '
    # Mirrored in the x axis, magnets 2 and 3 change places, and the program computes the same bits.
    { x = $1; y = $2; of[NR - 1] = $3; t[NR - 1] = $4; r2[NR - 1] = x * x + y * y; n++ }
    END {
        side = int(sqrt(n) + 0.5)
        for (i = 0; i < n; i++) {
            row = int(i / side); column = i % side; mirrored = (side - 1 - row) * side + column
            if (of[mirrored] != (of[i] == 1 ? 1 : 5 - of[i]) || t[mirrored] != t[i]) {
                print "no mirror image: " i; bad = 1
            }
            if (r2[i] > 2.25) continue
            disc++; share[of[i]]++
            if (column + 1 < side && of[i + 1] != of[i] || row + 1 < side && of[i + side] != of[i]) boundary++
        }
        # In a disc the basins have a third each. Cells on a boundary count as a whole for one basin: as many errors of
        # at most one, of either sign.
        for (m = 1; m <= 3; m++) {
            print "magnet " m ": " share[m] " of " disc " cells, " boundary " of them on a boundary"
            if ((share[m] - disc / 3) ^ 2 > 16 * boundary) { print "not a third: " share[m]; bad = 1 }
        }
        exit bad
    }' || fail 'wrong basins'
check_plot table.csv
echo 'All checks passed.'
