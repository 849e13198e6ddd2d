#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `relief_valve` and its plot.
# Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

check_arguments
expect 0 '' "$program" --instances 64 --transient 8 --phases 2 --quiet --output table.csv
check_table table.csv 128 instance,phase,q,y_min,y_max,impacts,status
check_plot table.csv
echo 'All checks passed.'
