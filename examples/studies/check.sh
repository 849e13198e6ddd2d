#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `studies`: its results, and that a second run has nothing to do. Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"

expect 0 '' "$program"
grep -q '^1800 of 1800 instances: 1800 success' stdout || fail 'not all instances were integrated'
grep -Eq '^mean of x: -?[0-9.e-]+, mean energy: -?[0-9.e-]+$' stdout || fail 'no reductions'
mv duffing_study.nc first.nc
expect 0 '' "$program"
grep -q '^1800 instances, all done before' stdout || fail 'the second run has begun anew'
if python=$(python_with xarray); then
    "$python" - <<'END' || fail 'the file is not as it should be'
import xarray
with xarray.open_dataset("first.nc") as first, xarray.open_dataset("duffing_study.nc") as second:
    assert first.equals(second)
    assert dict(first.sizes) == {"k": 200, "x_start": 9, "phase": 4, "x_bin": 100, "x_side": 3}
    assert first.x.dims == ("k", "x_start", "phase") and first.v_end.dims == ("k", "x_start")
    assert first.x_histogram.sum() + first.x_outside.sum() == first.x.size
    assert abs(first.v_start.mean()) < 0.01 and abs(first.v_start.std() - 0.1) < 0.01
END
    "$python" "$(dirname "$(realpath "$0")")/read.py" >read.txt || fail 'the file is not read as docs/studies.md says'
    grep -q '^True 1e-09$' read.txt || fail 'the statuses or the attributes are not as they should be'
fi
echo 'All checks passed.'
