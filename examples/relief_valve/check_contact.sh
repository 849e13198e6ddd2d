#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `relief_valve_contact` and its plot: rests as the closed form says, and nobody fails.
# Usage: check_contact.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

header=instance,phase,q,y_min,y_max,u_contact,time_at_rest,status
check_arguments
"$program" --instances 240 --transient 128 --phases 64 --quiet --output table.csv
check_table table.csv $((240 * 64)) "$header"
# At rest u' = beta q up to delta, so that the time at rest is (delta - u_contact) / (beta q); the opening has a
# tolerance of 1e-12 in u, and time is rounded to 1e-15. Valves rest in every cycle up to q = 0.02006, by CVODE
# (validation/case_studies).
rows table.csv | awk -F, '
    $8 != "stopped_by_event" || $4 < -1e-12 { print "wrong: " $0; bad = 1 }
    $7 > 0 {
        wrong = $7 - (10 - $6) / (20 * $3)
        if (wrong > 1e-8 || wrong < -1e-8) { print "wrong time: " $0; bad = 1 }
        rest[$1]++
    }
    { q[$1] = $3 }
    END { for (i in q) if (q[i] < 0.0200 && !rest[i]) { print "no rest at q = " q[i]; bad = 1 } exit bad }' ||
    fail 'not the rests of the closed form'
check_small $((512 * 64)) "$header"
check_plot table.csv plot_contact.py

# What ends as event_accumulation without resting contact (check.sh) rests once and goes on.
"$program" --first 0.2 --last 0.27 --instances 8 --transient 0 --phases 80 --quiet --output start.csv
rows start.csv | awk -F, '
    $8 != "stopped_by_event" { bad = 1 }
    $7 > 0 { rests[$1] = 1 }
    END { for (i in rests) ++n; exit bad || n != 8 }' ||
    fail 'valves with small flows do not rest'
echo 'All checks passed.'
