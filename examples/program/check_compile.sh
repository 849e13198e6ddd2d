#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that the program compiles headers of models, keeps what it compiled, and draws; and the job scripts, without
# SLURM. Usage: check_compile.sh MYRIAD
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"
export MYRIAD_CACHE_DIR=$work/cache
PATH=$(dirname "$program"):$PATH
mkdir examples
cp -r "$here" examples/program
cp -r "$here/../quickstart" examples
cd examples/program
commands() {
    # snippet: commands
    myriad run bifurcation.toml
    myriad info bifurcation
    myriad export bifurcation bifurcation.nc
    # end of snippet
}
commands >said 2>&1 || fail "the commands of the documentation fail: $(<said)"
grep -q '^4608 of 4608 instances: 4608 success' said || fail "not all instances were integrated: $(<said)"
myriad info bifurcation --json | tr -d ' \n' | grep -qF '"x":{"dimensions":["k","phase"]' || fail 'no array of x'
if plotting_python >/dev/null; then
    # snippet: plot
    myriad plot bifurcation
    # end of snippet
    [[ $(head -c 4 bifurcation.png | tail -c 3) == PNG ]] || fail 'no picture'
    if python_with matplotlib, netCDF4 >/dev/null; then
        expect 0 '' myriad plot bifurcation.nc --output of_file.png
        cmp bifurcation.png of_file.png || fail 'the picture of the netCDF file is another than that of the folder'
        echo 'k,x' >table.nc
        expect 2 'table\.nc cannot be read' myriad plot table.nc
        expect 2 'absent\.nc cannot be read: No such file' myriad plot absent.nc
    fi
fi
expect 0 '^$' myriad resume bifurcation --quiet # nothing is compiled again
sed -i 's/y\[v\], y\[x\]/y[w], y[x]/' ../quickstart/model.hpp
expect 2 'bifurcation\.toml:5:1: model\.hpp does not compile .*model\.hpp:[0-9]+:[0-9]+: error: ' \
    myriad run bifurcation.toml
cp "$here/../quickstart/model.hpp" ../quickstart/model.hpp
# What the library advises is said in the words of files.
sed '/^method = /d; s/^header = /method = "runge_kutta_4"\n&/' bifurcation.toml >fixed.toml
expect 2 'fixed\.toml: step is not set, but the method takes fixed steps: give step under \[options\]$' \
    myriad run fixed.toml
printf '\n// changed\n' >>../quickstart/model.hpp
expect 2 'bifurcation\.toml.*another study' myriad run bifurcation.toml
cp "$here/../quickstart/model.hpp" ../quickstart/model.hpp

# The job scripts, with programs in place of SLURM's.
mkdir bin
printf '#!/bin/sh\nexec "$@"\n' >bin/srun
printf '#!/bin/sh\necho "$@" >>requeued\n' >bin/scontrol
chmod +x bin/*
PATH=$PWD/bin:$PATH
for script in array.slurm preempted.slurm; do bash -n "$script" || fail "$script is no script"; done
rm -rf bifurcation
SLURM_CPUS_PER_TASK=1 sh array.slurm >/dev/null 2>&1 &
SLURM_CPUS_PER_TASK=1 sh array.slurm >/dev/null 2>&1 || fail 'a task of the array failed'
wait $! || fail 'a task of the array failed'
myriad info bifurcation | grep -q ' 4608 of 4608 instances' || fail 'the array has not done all'
rm -rf bifurcation
printf '#!/bin/sh\nexec timeout -s TERM 0.3 "$@"\n' >bin/srun
status=0
SLURM_JOB_ID=17 sh preempted.slurm >/dev/null 2>&1 || status=$?
[[ $status == 143 || $status == 124 ]] || fail "the job that was preempted ends with $status"
printf '#!/bin/sh\nexec "$@"\n' >bin/srun
SLURM_JOB_ID=17 sh preempted.slurm >/dev/null 2>&1 || fail 'the job does not go on'
myriad info bifurcation | grep -q ' 4608 of 4608 instances' || fail 'the job has not done all'
echo 'All checks passed.'
