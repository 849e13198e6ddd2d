#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `monte_carlo` and its plot: the distribution of the peak against what is known of it, the
# parameters against the host's draws, and that neither threads nor the number of instances change a draw.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

header=instance,R0,duration,peak,day,status
check_arguments
grep -q -- --seed <("$program" --help) || fail '--help does not name --seed'
expect 0 '' "$program" --instances 65536 --device cpu:2 --quiet --output table.csv
check_table table.csv 65536 "$header"
# The seed is fixed, so the outcome is, too. A sample lies more than four standard deviations off with probability 6e-5.
# Peaks: s + i - log(s) / R0 is conserved to about 1e-9 in each of some 60 steps.
grep '^#' table.csv | awk '
    / standard deviations apart$/ { ++estimates; if (!($(NF - 3) ^ 2 <= 16)) { print "unlikely: " $0; bad = 1 } }
    /largest error of a peak:/ { ++peaks; if (!($NF < 6e-8)) { print; bad = 1 } }
    /drawn differently by the host:/ { ++draws; if ($NF != 0) { print; bad = 1 } }
    END {
        if (estimates != 6 || peaks != 1 || draws != 1) { print "estimates are missing"; bad = 1 }
        exit bad
    }' || fail 'another distribution'
# The durations are uniform from 4 to 10 days, mean 7 and standard deviation sqrt(3), and independent of R0: both means
# within four standard deviations.
rows table.csv | awk -F, '
    $3 < 4 || $3 > 10 { print "not from 4 to 10: " $0; bad = 1 }
    { sum += $3 - 7; product += ($3 - 7) * ($2 - 2.5) / 0.4 }
    END {
        scale = sqrt(3 * NR)
        if (!((sum / scale) ^ 2 <= 16 && (product / scale) ^ 2 <= 16)) { print sum / scale, product / scale; bad = 1 }
        exit bad
    }' || fail 'wrong durations'
expect 0 '' "$program" --instances 65536 --device cpu:1 --quiet --output other.csv
cmp table.csv other.csv || fail 'another number of threads changes the results'
expect 0 '' "$program" --instances 1000 --quiet --output first.csv
cmp <(rows table.csv | head -n 1000) <(rows first.csv) || fail 'the number of instances changes the first ones'
expect 0 '' "$program" --instances 1000 --seed 2 --quiet --output other.csv
if cmp -s <(rows first.csv) <(rows other.csv); then fail 'another seed changes nothing'; fi
check_small $((1 << 14)) "$header"
check_plot first.csv
echo 'All checks passed.'
