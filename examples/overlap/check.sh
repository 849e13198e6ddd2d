#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `overlap` and its plot: the bits of one call of solve, the tables of the chunks, the order of the
# steps. Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

check_arguments
expect 2 'solvers' "$program" --solvers 0
expect 2 'unknown' "$program" --small --devices cpu,abacus

# Uneven chunks; on the CPU, two devices are two solvers or more that take turns on it.
small=(--instances 1003 --phases 4)
expect 0 '' "$program" "${small[@]}" --chunks 7 --check --output table.csv --device cpu
grep -q 'have the bits of one call' stdout || fail 'not compared'
grep -q 'two or more at once for' stdout || fail 'no share of the time'
expect 0 '' "$program" "${small[@]}" --chunks 5 --solvers 1 --devices cpu:1,cpu:2 --check --output two.csv --quiet
expect 0 '' "$program" "${small[@]}" --chunks 1 --solvers 1 --output whole.csv --quiet --device cpu:1

header=solver,device,chunk,step,begin,end,kernel_seconds
check_table table.csv 35 "$header"
check_table two.csv 25 "$header"
check_table whole.csv 5 "$header"
together() {
    local chunk
    for ((chunk = 1; chunk <= $2; ++chunk)); do rows "$1_chunks/${chunk}_of_$2.csv"; done
}
check_table whole_chunks/1_of_1.csv 1003 instance,k,x,v,x_global_max,zeros
cmp <(together table 7) <(together whole 1) || fail 'the tables of the chunks are not that of the whole'
cmp <(together two 5) <(together whole 1) || fail 'the tables of the chunks are not that of the whole'

# Of a solver, a step begins when the one before has ended; a device has one integration at a time; every chunk has
# every step.
rows table.csv | awk -F, '
    $5 < ended[$1] || $6 < $5 { print "out of order: " $0; bad = 1 }
    $4 == 2 && $5 < integrated { print "two integrations at once: " $0; bad = 1 }
    $4 == 2 { integrated = $6 }
    $4 != (last[$3] == "" ? 0 : last[$3] + 1) { print "a step is missing before: " $0; bad = 1 }
    { ended[$1] = $6; last[$3] = $4 }
    END { for (chunk = 0; chunk < 7; ++chunk) if (last[chunk] != 4) bad = 1; exit bad }' || fail 'wrong timeline'

check_small 80 "$header"
check_plot table.csv
echo 'All checks passed.'
