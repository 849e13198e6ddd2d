#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `bubble_response` and its plot: small oscillations have the amplitude that the linearised equation
# gives in closed form, hence its eigenfrequency and damping, and one maximum per period.
# Usage: check_response.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"
header=instance,phase,f_kHz,y_max,maxima,status

check_arguments
expect 2 'pressure' "$program" --pressure -1

"$program" --pressure 1e-4 --instances 60 --transient 400 --phases 1 --quiet --output linear.csv
check_table linear.csv 60 "$header"
# In SI units from the linearised Keller-Miksis equation, see docs/case_studies/keller_miksis.md; not from the program's
# constants. Relative errors: 1.1e-3 at 1 MHz, where the maximum is taken within 1e-6 of zero slope, 1e-12 / (2 y'')
# beside the top; second-order terms, up to the amplitude, 7e-4, times 1, or where twice the frequency meets the
# resonance 4e-5 times half of Q, 16; transients e^(-400 pi / (3 Q)) = 2e-6 at most.
rows linear.csv | awk -F, '
    BEGIN {
        pi = atan2(0, -1); P = 10; R = 10e-6; gamma = 1.4
        rho = 997.0639504998557; sigma = 0.071977583160056; mu = 8.902125058209557e-4; c = 1497.251785455527
        ambient = 1e5 - 3166.775638952003; gas = ambient + 2 * sigma / R
        m = rho * R ^ 2 * (1 + 4 * mu / (rho * R * c)); k = 3 * gamma * gas - 2 * sigma / R
        d = 4 * mu + R / c * (ambient + (3 * gamma - 1) * gas)
    }
    {
        w = 2 * pi * 1e3 * $3
        a = P * sqrt(1 + (R * w / c) ^ 2) / sqrt((k - m * w ^ 2) ^ 2 + (d * w) ^ 2)
        if ($6 != "success" || $5 != 1) { print "no single maximum: " $0; bad = 1 }
        if (!((($4 - 1) / a - 1) ^ 2 < 4e-6)) { print "amplitude " a " expected: " $0; bad = 1 }
        if ($4 > top) { top = $4; at = $3 }
    }
    # The grid is 7 % wide; the peak is at f0 to 1 / (4 Q^2), 0.1 %.
    END {
        f0 = sqrt(k / m) / (2 * pi * 1e3)
        if (at < f0 / 1.07 || at > f0 * 1.07) { print "resonance at " at " instead of " f0 " kHz"; bad = 1 }
        exit bad
    }' || fail 'not the linear response'
grep -q 'eigenfrequency 339.11' linear.csv || fail 'another eigenfrequency'

# At 1.5 bar: collapses, several maxima per period at low frequencies, one at f0 (Parlitz et al. 1990), and every period
# of every instance is there.
"$program" --instances 40 --transient 32 --phases 8 --quiet --output table.csv
check_table table.csv 320 "$header"
rows table.csv | awk -F, '
    $6 != "success" || !($4 > 0.9 && $4 < 12) { print "wrong: " $0; bad = 1 }
    $3 < 25 && $5 < 7 { print "no rebounds: " $0; bad = 1 }
    $3 > 180 && $3 < 340 && $5 != 1 { print "more than one maximum: " $0; bad = 1 }
    END { exit bad }' || fail 'wrong response'
check_small $((200 * 16)) "$header"
check_plot table.csv plot_response.py
echo 'All checks passed.'
