#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `methods` and its plot on a few instances, and that docs/methods.md has the tables of what was
# measured. Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../../examples/common/check.sh"

expect 0 '' "$program" --help
grep -q -- --tolerances stdout || fail 'no help'
expect 0 '' "$program" --instances 16 --repetitions 1 --tolerances 1e-6,1e-8 --output table.csv
# 8 methods in each of three cases and 3 in the last, at two tolerances.
[[ $(rows table.csv | wc -l) == 54 ]] || fail 'a header and 54 rows were expected'
rows table.csv | awk -F, '
    $12 != 0 { print "failed: " $0; bad = 1 }
    # A hundred times finer: order two at the least, whose error falls as the tolerance does.
    $5 == 1e-6 { error[$1 $2] = $10; work[$1 $2] = $9 }
    $5 == 1e-8 && !($10 < error[$1 $2] / 10) { print "no smaller error: " $0; bad = 1 }
    $5 == 1e-8 && !($9 > work[$1 $2]) { print "no more work: " $0; bad = 1 }
    END { exit bad }' || fail 'wrong errors'
expect 2 'not a regular file' "$program" --output /dev/null

if python=$(plotting_python); then
    expect 0 '' "$python" "$here/plot.py" table.csv --images .
    for case in keller_miksis relief_valve relief_valve_watched robertson; do
        [[ $(head -c 4 $case.png | tail -c 3) == PNG ]] || fail "no picture of $case"
    done
    cp "$here/../../docs/methods.md" methods.md
    expect 0 '' "$python" "$here/plot.py" --into methods.md
    diff "$here/../../docs/methods.md" methods.md || fail 'docs/methods.md has other tables than the files measured'
    expect 2 '' "$python" "$here/plot.py" missing.csv --images .
fi
echo 'All checks passed.'
