#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `lyapunov_map` and its plot: the exponents of rest, order and chaos where they are known, and that
# both kinds of tangents agree. validation/case_studies compares single exponents with CVODE.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

header=k,B,lambda_hand,lambda_library,status
check_arguments
"$program" --instances 33 --transient 64 --phases 128 --quiet --output table.csv
check_table table.csv $((33 * 33)) "$header"
rows table.csv | awk -F, '
    function wrong(what) { print what ": " $0; bad = 1 }
    {
        k = $1; B = $2; hand = $3; lambda = $4; time = 128 * 2 * 3.14159265358979
        least = hand < lambda ? hand : lambda; most = hand < lambda ? lambda : hand
        difference = lambda - hand
        if ($5 != "success" || lambda != lambda + 0) wrong("failed")
        # At rest at x = 1 the tangent turns as (a, b) = e^(-k t / 2) P (rotation) P^-1; cond P is below e^0.4 for k <=
        # 0.5.
        if (B == 0 && (lambda + k / 2) ^ 2 > (0.4 / time) ^ 2) wrong("not the exponent of rest, -k/2")
        # Both exponents add up to -k, so that the larger one is not below -k/2; a tangent may shrink more than that by
        # the ratio of the axes of an ellipse, for which e^5 is plenty.
        if (lambda < -k / 2 - 5 / time) wrong("below half of the divergence")
        # Melnikov: no homoclinic tangle, and so no chaos of it, for B / k < 4 cosh(pi / 2) / (3 sqrt(2) pi) = 0.753, to
        # first order in k and B.
        if (k <= 0.3 && B < 0.75 * k && lambda > 0) wrong("chaos below the criterion of Melnikov")
        # Guckenheimer and Holmes, section 2.2: a strange attractor at k = 0.25, B = 0.3, and none at 0.2.
        if ((k - 0.25) ^ 2 < 1e-12 && (B - 0.3) ^ 2 < 1e-12) { known++; if (lambda < 0.05) wrong("no chaos") }
        if ((k - 0.25) ^ 2 < 1e-12 && (B - 0.2) ^ 2 < 1e-12) { known++; if (lambda > -0.1) wrong("no order") }
        # Where it is regular both are the same but for the rounding of their steps, unless that sends a solution that
        # has been chaotic for long to another end. 1e-7: twenty steps per unit of time that err by 1e-9.
        if (most < -0.01) { regular++; if (difference ^ 2 < 1e-14) same++ }
        if (least > 0.05) { chaotic++; sum += difference; squares += difference ^ 2 }
    }
    END {
        mean = sum / chaotic; error = sqrt((squares / chaotic - mean ^ 2) / (chaotic - 1))
        printf "%s known, %s regular, of which %s are the same, ", known, regular, same
        print chaotic " chaotic, mean difference " mean " +- " error
        # Chaotic solutions part, and are two samples of one mean then: four standard errors.
        if (known != 2 || chaotic < 100 || same < 0.9 * regular || mean ^ 2 > (4 * error) ^ 2) bad = 1
        exit bad
    }' || fail 'wrong exponents'
check_small $((48 * 48)) "$header"
check_plot table.csv
echo 'All checks passed.'
