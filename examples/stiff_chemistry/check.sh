#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `stiff_chemistry` and its plot: oscillations on one side of the Hopf bifurcation, rest on the
# other, near it the period of its eigenvalues; and results that no schedule changes.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

header=instance,f,epsilon,period,z_least,z_largest,growth,frequency,steps,status
check_arguments
grep -q -- --schedule <("$program" --help) || fail '--help does not name --schedule'
expect 2 'schedule' "$program" --schedule sometimes
expect 0 '' "$program" --instances 2000 --transient 31 --device cpu:2 --output table.csv
check_table table.csv 1936 "$header"
grep -Eq '^idle lanes in this run: [0-9.e-]+ %$' stdout || fail 'no idle lanes'
[[ $(grep -c '^idle lanes if .* neighbours waited' stdout) == 2 ]] || fail 'no idle lanes of groups'
rows table.csv | awk -F, '
    {
        turn = $8 > 0 ? 2 * 3.14159265358979 / $8 : 1  # of a small deviation from equilibrium
        grown = 32 * $7 * turn                         # by that power of e, in 32 cycles
        size = ($6 - $5) / $6
        oscillates = $4 > 0 && size > 0.05
        if (least == 0 || $9 < least) least = $9
        if ($9 > most) most = $9
    }
    # The start is 1e-3 of z from equilibrium. Within the factor exp(5) = 150 of growth it may not have reached a size
    # of 0.05, and only there.
    grown > 5 && !oscillates { print "rests: " $0; bad = 1 }
    grown < -5 && oscillates { print "oscillates: " $0; bad = 1 }
    grown > 5 { ++above }
    grown < -5 { ++below }
    # A deviation of relative size s changes the period by terms of s^2; the maximum is found to 1e-9 in x - z, which is
    # about z s: a phase of 1e-9 / (z s), twice, in 2 pi. The steps err by 1e-6 of z, that is 1e-6 / s of the deviation.
    $4 > 0 && size > 1e-4 && size < 0.01 {
        ++small
        off = ($4 / turn - 1) ^ 2
        allowed = size + 1e-6 / size + 1e-9 / ($6 * size)
        if (off > allowed ^ 2) { print "not the period " turn ": " $0; bad = 1 }
    }
    END {
        if (above < 800 || below < 800 || small < 5) { print above, below, small " compared"; bad = 1 }
        if (most < 100 * least) { print "steps from " least " to " most; bad = 1 }
        exit bad
    }' || fail 'wrong oscillations'
for schedule in in_order by_cost; do
    expect 0 '' \
        "$program" --instances 2000 --transient 31 --device cpu:1 --schedule "$schedule" --quiet --output other.csv
    cmp table.csv other.csv || fail "other results with the schedule $schedule"
done
check_small $((32 * 32)) "$header"
check_plot table.csv
echo 'All checks passed.'
