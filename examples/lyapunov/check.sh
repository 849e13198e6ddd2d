#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `lyapunov` and its plot: the exponents of the fixed point at rho = 0, the sums, and the files.
# Usage: check.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
plot=$(dirname "$(realpath "$0")")/plot.py
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    exit 1
}

"$program" --help | grep -q -- --instances || fail 'no help'
"$program" --instances 26 --transient 100 --recorded 200 --quiet --output table.csv
[[ $(grep -vc '^#' table.csv) == 27 ]] || fail 'a header and 26 rows were expected'
grep -v '^#' table.csv | awk -F, '
    NR == 1 { if ($0 != "instance,rho,lambda_1,lambda_2,lambda_3,status") { print "wrong header: " $0; bad = 1 }; next }
    $6 != "success" { print "failed: " $0; bad = 1 }
    # The divergence is -(10 + 1 + 8/3). Some 100 steps per unit of time, each of which errs by 1e-8 in three tangents;
    # where solutions oscillate faster, more of them.
    ($3 + $4 + $5 + 41 / 3) ^ 2 > 1e-10 { print "wrong sum: " $0; bad = 1 }
    # The eigenvalues at the origin for rho = 0. Tangents turn to theirs within 100 phases, of which 1/50 is left over.
    NR == 2 && (($3 + 1) ^ 2 > 1e-6 || ($4 + 8 / 3) ^ 2 > 1e-6 || ($5 + 10) ^ 2 > 1e-6) { print "wrong: " $0; bad = 1 }
    END { exit bad }' || fail 'wrong exponents'
if "$program" --output /dev/null 2>stderr; then fail 'a device was taken for a file'; fi
grep -q 'not a regular file' stderr || fail 'no reason'

for python in python3 /usr/bin/python3; do
    "$python" -c 'import matplotlib' 2>/dev/null || continue
    "$python" "$plot" table.csv picture.png
    [[ $(head -c 4 picture.png | tail -c 3) == PNG ]] || fail 'no picture'
    status=0
    "$python" "$plot" missing.csv other.png 2>stderr || status=$?
    [[ $status == 2 && ! -e other.png ]] || fail 'no error without a table'
    break
done
echo 'All checks passed.'
