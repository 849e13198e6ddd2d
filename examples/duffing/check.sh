#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `duffing` and its plot: exit statuses, messages, the file's form, and that no half-written file
# stays. Usage: check.sh PROGRAM
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"
small=(--instances 40 --transient 3 --phases 2)

expect 0 'Integrating 40 instances' "$program" "${small[@]}" --device cpu --output new/table.csv
grep -q '40 success' stdout || fail 'no report'
check_table new/table.csv 80 instance,phase,k,B,x,v,x_local_max,v_second_zero,x_global_max,zeros,status
[[ $(tail -n 1 new/table.csv) == 39,4,0.3,0.3,*,success ]] || fail 'wrong last row'
if rows new/table.csv | grep -q nan; then fail 'values are missing'; fi

expect 0 '' "$program" "${small[@]}" --output one.csv --device cpu:1 --quiet
[[ ! -s stdout && ! -s stderr ]] || fail '--quiet is not quiet'
cmp one.csv new/table.csv || fail 'the result depends on the number of threads'

if ! nvidia-smi -L >/dev/null 2>&1; then
    expect 2 'device "cuda" is not available: .*use "cpu" or "auto"' \
        "$program" "${small[@]}" --device cuda --output no.csv
    [[ ! -e no.csv ]] || fail 'a file without a result'
    expect 0 'Computing on cpu.*; no GPU: ' "$program" "${small[@]}" --output auto.csv
    cmp one.csv auto.csv || fail 'the result without a GPU is not that of the CPU'
fi

check_arguments
expect 2 'phases' "$program" --phases many
expect 2 'no file name' "$program" --output ''
expect 2 'folder cannot be created' "$program" --output no/such/folder/table.csv
expect 2 'at least 800000000 GB are needed, and [0-9.]+ [kMG]B are free' \
    "$program" --instances 100000000 --phases 100000000 --output huge.csv
expect 2 'out of memory: chunks of [0-9]+ instances would take' \
    "$program" --instances 100000000 --phases 100000000 --output huge.nc
echo old >old.csv
expect 2 'File too large' \
    bash -c "ulimit -f 2; exec '$program' --instances 400 --transient 1 --phases 2 --output old.csv"
[[ $(<old.csv) == old ]] || fail 'a file of an earlier run was harmed'

expect 0 'Integrating 1000 instances over 128 . 16 phases' "$program" --small --output small.csv
expect 2 '' "$program" --transient none

# The same numbers in a netCDF file, from memory and from a folder in which the work goes on.
expect 0 'Integrating 40 instances' "$program" "${small[@]}" --device cpu --output new/results.nc
expect 0 '' "$program" "${small[@]}" --quiet --output folder.nc --folder kept
expect 0 '' "$program" "${small[@]}" --output folder.nc --folder kept
grep -q '^40 instances, all done before' stdout || fail 'what was kept was computed again'
expect 2 'options.phases' "$program" --instances 40 --transient 3 --phases 3 --folder kept --output no.nc
if python=$(python_with netCDF4); then
    "$python" - <<'END' || fail 'the files differ'
import netCDF4
import numpy
table = numpy.genfromtxt("new/table.csv", delimiter=",", names=True, comments="#", usecols=range(10), skip_header=10)
for path in "new/results.nc", "folder.nc":
    with netCDF4.Dataset(path) as data:
        assert data["x"].dimensions == ("k", "phase")
        assert data.title.startswith("Duffing oscillator")
        for name in "x", "v", "x_local_max", "v_second_zero", "x_global_max", "zeros":
            assert (data[name][:].ravel() == table[name]).all(), name
        assert (numpy.repeat(data["k"][:], 2) == table["k"]).all()
        assert (numpy.tile(data["phase"][:], 40) == table["phase"]).all()
END
fi

check_full_output "${small[@]}" --output full.csv

check_plot new/table.csv
if python_with netCDF4 >/dev/null && python=$(plotting_python); then
    expect 0 '' "$python" "$here/plot.py" new/results.nc netcdf.png
    cmp picture.png netcdf.png || fail 'the pictures of the table and of the netCDF file differ'
    echo no >wrong.nc
    expect 2 'wrong.nc cannot be read' "$python" "$here/plot.py" wrong.nc other.png
fi
: >empty.csv
if python=$(plotting_python); then
    expect 2 'is empty' "$python" "$here/plot.py" empty.csv other.png
    expect 0 '' "$program" "${small[@]}" --quiet --output drawn.csv --plot
    [[ -s drawn.png ]] || fail '--plot draws nothing'
    expect 0 '' "$program" "${small[@]}" --quiet --output drawn.csv --plot named.png
    [[ -s named.png ]] || fail '--plot does not draw what it was told'
    expect 3 'was not drawn; the table is in undrawn.csv' \
        "$program" "${small[@]}" --quiet --output undrawn.csv --plot /dev/null/no.png
    [[ -s undrawn.csv ]] || fail 'no table of a picture that was not drawn'
fi
expect 2 'plot needs a Python 3 with matplotlib' \
    env PATH=/nowhere PYTHONHOME=/nowhere "$program" "${small[@]}" --plot --output not.csv
[[ ! -e not.csv ]] || fail 'worked before it looked for matplotlib'
echo 'All checks passed.'
