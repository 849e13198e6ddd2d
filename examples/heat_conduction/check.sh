#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `heat_conduction` and its plot: steady heat flows against the closed form, 24 points against 77,
# what the maximum principle says, and the files.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

check_arguments
expect 2 'points' "$program" --points 25
expect 2 'shared-placement' "$program" --shared-placement attic
"$program" --small --quiet --output table.csv
header=instance,phase,t,diffusivity,through,pulse,mean_heat_flow,heat_flow$(printf ',T_%s' {0..32}),status
check_table table.csv $((64 + 12 * 15)) "$header"

# With a steady flow of liquid the heat flow is P / (exp(P (1 - 1/3)) - 1), P = through / diffusivity, when what is left
# of the start has died out: the slowest mode of the shell of thickness two does so by exp(-diffusivity (pi/2)^2 t), or
# faster with a flow; at the start it is no larger than the solution itself, which the flow of liquid changes by no more
# than its double. Steps are exact to 1e-7, a collocation on 24 points of a layer of 1/P >= 0.1 to 1e-9. To and fro,
# heat flow is larger than in liquid at rest (3/2), as inflow gains more than outflow loses. Nowhere is it hotter than
# at the wall or colder than at the sphere.
rows table.csv | awk -F, '
    { a = $4; t = $3; last = $2 == 271; peclet = $5 / a }
    $NF != "success" { print "failed: " $0; bad = 1 }
    peclet != 0 && last {
        exact = peclet / (exp(peclet * 2 / 3) - 1)
        bound = 1e-7 + 2 * exp(-a * 2.4674 * (t - 1))
        error = ($7 - exact) / exact
        if (!(error < bound && -error < bound)) { print "heat flow " $7 " instead of " exact ": " $0; bad = 1 }
        steady++
    }
    $6 > 0 && last { if (!($7 > 1.5)) { print "no gain: " $0; bad = 1 }; pulsed++ }
    { for (i = 9; i <= 41; ++i) if (!($i >= -1e-6 && $i <= 1 + 1e-6)) { print "T out of range: " $0; bad = 1 } }
    END { exit bad || steady != 32 || pulsed != 32 }' || fail 'wrong heat flow'

# A stiff method has the same heat flows, to the errors of both, in a few of the steps.
"$program" --small --quiet --method rodas_5p --transient 16 --output stiff.csv
"$program" --small --quiet --transient 16 --output explicit.csv
paste -d, <(rows stiff.csv | cut -d, -f1-7) <(rows explicit.csv | cut -d, -f7) | awk -F, '
    { d = $7 - $8; if (!(d < 1e-5 && -d < 1e-5)) { print "rodas_5p differs: " $0; bad = 1 } }
    END { exit bad || NR != 64 + 12 * 15 }' || fail 'methods differ'
expect 2 'compiled for 24 points' "$program" --points 77 --method rodas_5p

# Of the smallest diffusivity, whose layers are the thinnest, over a quarter of a period. The flow of liquid begins at
# once, with a layer that has no thickness; after a phase it has sqrt(0.05 / 16) = 0.06, on which 24 points keep four
# digits.
for points in 24 77; do
    "$program" --points $points --instances 4 --transient 0 --phases 4 --quiet --output $points.csv
    rows $points.csv | cut -d, -f1-8 >$points.rows
done
paste -d, 24.rows 77.rows | awk -F, '
    { d = $8 - $16; if (!(d < 1e-4 && -d < 1e-4)) { print "24 and 77 points differ: " $0; bad = 1 } }
    END { exit bad || NR != 16 }' || fail '24 points are too few'

check_plot table.csv
echo 'All checks passed.'
