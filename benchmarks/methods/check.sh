#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `methods` and its plot on a few instances, and that docs/methods.md has the tables of what was measured.
# Usage: check.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    exit 1
}

"$program" --help | grep -q -- --tolerances || fail 'no help'
"$program" --instances 16 --repetitions 1 --tolerances 1e-6,1e-8 --output table.csv >/dev/null
# 8 methods in each of three cases and 3 in the last, at two tolerances, below the header.
[[ $(grep -vc '^#' table.csv) == 55 ]] || fail 'a header and 54 rows were expected'
grep -v '^#' table.csv | awk -F, '
    NR == 1 { next }
    $12 != 0 { print "failed: " $0; bad = 1 }
    # A hundred times finer: order two at the least, whose error falls as the tolerance does.
    $5 == 1e-6 { error[$1 $2] = $10; work[$1 $2] = $9 }
    $5 == 1e-8 && !($10 < error[$1 $2] / 10) { print "no smaller error: " $0; bad = 1 }
    $5 == 1e-8 && !($9 > work[$1 $2]) { print "no more work: " $0; bad = 1 }
    END { exit bad }' || fail 'wrong errors'
if "$program" --output /dev/null 2>stderr >/dev/null; then fail 'a device was taken for a file'; fi
grep -q 'not a regular file' stderr || fail 'no reason'

for python in python3 /usr/bin/python3; do
    "$python" -c 'import matplotlib' 2>/dev/null || continue
    "$python" "$here/plot.py" table.csv --images .
    for case in keller_miksis relief_valve relief_valve_watched robertson; do
        [[ $(head -c 4 $case.png | tail -c 3) == PNG ]] || fail "no picture of $case"
    done
    cp "$here/../../docs/methods.md" methods.md
    "$python" "$here/plot.py" --into methods.md
    diff "$here/../../docs/methods.md" methods.md || fail 'docs/methods.md has other tables than the files measured'
    status=0
    "$python" "$here/plot.py" missing.csv --images . 2>stderr || status=$?
    [[ $status == 2 ]] || fail 'no error without a table'
    break
done
echo 'All checks passed.'
