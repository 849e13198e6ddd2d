#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `resonance` and its plot: amplification and resonance frequency of the linear oscillator against
# their closed forms, the samples against the accessories, and the memory of both.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

check_arguments
expect 0 '' "$program" --small --device cpu --output table.csv
# Five accessories against times and values of 8 * 200 samples, in 600 instances.
grep -q 'By hooks: 24000 bytes' stdout || fail 'not the memory of five accessories'
grep -q 'By dense output: 15360000 bytes' stdout || fail 'not the memory of the samples'
check_table table.csv 600 \
    beta,start,omega,maximum,minimum,mean_square,maximum_sampled,minimum_sampled,mean_square_sampled,status
rows table.csv | awk -F, '
    function abs(a) { return a < 0 ? -a : a }
    function wrong(what) { print what ": " $0; bad = 1 }
    { if ($10 != "success") wrong("failed") }
    $1 == 0 && $2 == 0 {
        # A = 1 / sqrt((1 - r^2)^2 + (2 zeta r)^2), zeta = 0.05, and the mean square A^2 / 2. 1e-8: errors of a step,
        # 1e-10 of the amplitude and some 100 steps in a period, live for 1 / (2 pi zeta) periods, 3; their signs
        # differ.
        exact = 1 / sqrt((1 - $3 ^ 2) ^ 2 + (0.1 * $3) ^ 2)
        if (!(abs($4 / exact - 1) <= 1e-8 && abs($5 / exact + 1) <= 1e-8)) wrong("amplification is not " exact)
        if (!(abs(2 * $6 / exact ^ 2 - 1) <= 2e-8)) wrong("mean square is not half the square of " exact)
        n++; s[n] = $3 ^ 2; q[n] = 1 / $4 ^ 2
        if ($4 > top) { top = $4; at = n }
    }
    {
        # A sample is at most half an interval, pi / 199, from the maximum of x, whose second derivative there is at
        # most (1 + beta A^2) A + 1, in units in which t = phase / omega.
        d = atan2(0, -1) / 199 / $3
        missed = ((1 + $1 * $4 ^ 2) * $4 + 1) * d ^ 2 / 2 + 1e-6
        if (!($4 - $7 <= missed && $4 - $7 >= -1e-6)) wrong("sampled maximum")
        if (!($8 - $5 <= missed && $8 - $5 >= -1e-6)) wrong("sampled minimum")
        # Sums over whole periods are exact for all harmonics that the samples resolve; samples err by 1e-6 at most.
        if (!(abs($9 / $6 - 1) <= 1e-6)) wrong("sampled mean square")
    }
    END {
        # 1 / A^2 is quadratic in s = r^2: the vertex of the parabola through any three points is at 1 - 2 zeta^2.
        # Errors of 2e-8 in values of 0.01 at a distance of 0.02 in s move it by some 1e-8, of which 1e-6 leaves a
        # margin.
        a = at - 1; b = at; c = at + 1
        slope = (q[b] - q[a]) / (s[b] - s[a])
        bend = ((q[c] - q[b]) / (s[c] - s[b]) - slope) / (s[c] - s[a])
        vertex = (s[a] + s[b]) / 2 - slope / (2 * bend)
        printf "resonance frequency %.9f, closed form %.9f\n", sqrt(vertex), sqrt(1 - 2 * 0.05 ^ 2)
        if (n != 100 || abs(sqrt(vertex) - sqrt(1 - 2 * 0.05 ^ 2)) > 1e-6) bad = 1
        exit bad
    }' || fail 'not the response that is known'
# Two stable responses between the folds: the start decides.
rows table.csv | awk -F, '$1 == 0.01 { n[$3]++; m[$3, $2] = $4 }
    END { for (w in n) if (m[w, 1] > 2 * m[w, 0]) both++; exit both < 5 }' || fail 'no second branch'
check_plot table.csv
echo 'All checks passed.'
