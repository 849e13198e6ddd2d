#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `relief_valve` and its plot: the seat, grazing, and the stability limit of the equilibrium.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

header=instance,phase,q,y_min,y_max,impacts,status
check_arguments
"$program" --instances 981 --transient 400 --phases 64 --quiet --output table.csv
check_table table.csv $((981 * 64)) "$header"
# q goes in steps of 0.01. The oscillation grazes the seat at q = 7.55721, by CVODE (validation/case_studies). The
# equilibrium, u = y + delta, q = y sqrt(u), has the characteristic polynomial l^3 + (kappa + a) l^2 + (1 + kappa a) l +
# a + b with a = beta y / (2 sqrt(u)), b = beta sqrt(u), and so is stable where (kappa + a) (1 + kappa a) > a + b
# (Routh, Hurwitz). Below that limit the square of the amplitude is nearly a parabola over q, whose zero is the limit.
# It is followed over 0.05 from three points 0.05 apart; its third difference, 0.05, over its slope, 20, times 0.05, and
# so on, leaves 0.015 at most.
rows table.csv | awk -F, '
    function stable(y,  u, a) {
        u = y + 10; a = 10 * y / sqrt(u)
        return (1.25 + a) * (1 + 1.25 * a) > a + 20 * sqrt(u)
    }
    # Nothing is below the seat by more than the tolerance of its event.
    $4 < -1e-6 { print "through the seat: " $0; bad = 1 }
    # Only impacts that accumulate end an instance: with a valve that starts at 0.2, has lost its speed 1.8 units of
    # time later and is lifted after delta / (beta q), for q below 0.28.
    $7 == "event_accumulation" && $3 < 0.28 { next }
    $7 != "stopped_by_event" && $7 != "stopped_by_user" { print "failed: " $0; bad = 1 }
    $1 != instance { instance = $1; first = $6; low = $4; high = $5; next }
    {
        if ($4 < low) low = $4
        if ($5 > high) high = $5
        q = int($3 * 100 + 0.5); impacts[q] = $6 - first; swing[q] = high - low
    }
    END {
        for (q in impacts) if (impacts[q] > 0) { if (q / 100 > last) last = q / 100 } else if (q + 0 < 755) silent++
        printf "impacts up to q = %g\n", last
        if (!(last > 7.535 && last < 7.5672)) { print "grazing is at 7.55721"; bad = 1 }
        if (silent) { print silent " instances below the grazing flow have no impacts"; bad = 1 }
        low = 0; high = 10
        for (k = 0; k < 60; ++k) { y = (low + high) / 2; if (stable(y)) high = y; else low = y }
        limit = y * sqrt(y + 10)
        s0 = swing[844] ^ 2; s1 = swing[839] ^ 2; s2 = swing[834] ^ 2  # the parabola through these
        half = (s2 - 2 * s1 + s0) / 2; slope = s1 - s0 - half
        zero = 8.44 - 0.05 * (-slope + sqrt(slope ^ 2 - 4 * half * s0)) / (2 * half)
        printf "the equilibrium is stable from q = %.6f on, oscillations vanish at %.4f\n", limit, zero
        if (!(zero - limit < 0.015 && limit - zero < 0.015)) bad = 1
        for (q in swing) {
            if (q + 0 > 100 * (limit + 0.2) && swing[q] > 1e-5) { print "oscillates at q = " q / 100; bad = 1 }
        }
        exit bad
    }' || fail 'not the valve of the linearisation'
check_small $((512 * 16)) "$header"
check_plot table.csv
echo 'All checks passed.'
