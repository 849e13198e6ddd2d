#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the case studies of docs/case_studies and plots their results.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

usage() {
    cat <<'END_OF_USAGE'
Usage: scripts/case_studies.sh [--device NAME] [--small] [--only PROGRAM,...] [--deps DIR] [--output DIR] [--jobs N]
                               [--help]

Builds the example programs and runs each of them: DIR/PROGRAM.csv, DIR/PROGRAM.png, and what it said in
DIR/PROGRAM.log. The last lines are a table of their times by the clock. Exit status 1 if one of them fails.

  --device NAME        where to compute (default: cuda if nvcc and a GPU are there, else cpu); for a GPU it builds in
                       build/case-studies-cuda and installs nothing, else in build/case-studies-release and installs
                       what is missing (as root or with sudo)
  --small              sizes that take seconds on two cores; the full ones are for a GPU
  --only PROGRAM,...   only these
  --deps DIR           for a GPU: folder with the headers of what is not installed, DIR/xsimd and DIR/CLI
                       (default: .deps), and DIR/json with nlohmann/json for the program duffing
  --output DIR         (default: results/case_studies)
  --jobs N             processes at a time (default: number of cores)
END_OF_USAGE
}

programs=(
    duffing duffing_trajectories resonance lyapunov lyapunov_map basins bubble_response bubble_dual_frequency
    coupled_duffing bubble_cluster relief_valve relief_valve_contact hybrid poincare heat_conduction overlap
    stiff_chemistry monte_carlo
)
device=cpu
if has_command nvcc && nvidia-smi -L >/dev/null 2>&1; then device=cuda; fi
deps=.deps
output=results/case_studies
jobs=$(nproc)
size=()
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --small) size=(--small) ;;
        --device | --only | --deps | --output | --jobs)
            (($# > 1)) || usage_error "$1 needs a value"
            case $1 in
                --device) device=$2 ;; --deps) deps=$2 ;; --output) output=$2 ;; --jobs) jobs=$2 ;;
                --only)
                    IFS=, read -r -a wanted <<<"$2"
                    for program in "${wanted[@]}"; do
                        [[ " ${programs[*]} " == *" $program "* ]] ||
                            usage_error "There is no case study '$program': choose from ${programs[*]}"
                    done
                    programs=("${wanted[@]}") ;;
            esac
            shift ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
    shift
done
[[ $device =~ ^(cpu|cuda)(:[0-9]+)?$ ]] ||
    usage_error "There is no device '$device': choose cpu, cpu:THREADS, cuda or cuda:NUMBER"
[[ $jobs =~ ^[1-9][0-9]*$ ]] || usage_error "--jobs needs a positive number"
((${#programs[@]})) || usage_error "--only needs programs"
mkdir -p "$output"

options=(-DMYRIAD_BUILD_TESTS=OFF -DMYRIAD_BUILD_BENCHMARKS=OFF -DMYRIAD_BUILD_VALIDATION=OFF)
if [[ $device == cuda* ]]; then
    has_command nvcc || fail "nvcc is not on the PATH: install the CUDA Toolkit" 2
    nvidia-smi --query-gpu=name,driver_version --format=csv,noheader || fail "There is no GPU, or no driver for it" 2
    preset=cuda
    mapfile -t of_dependencies < <(dependency_options "$deps")
    options+=(-DMYRIAD_CUDA_COMPILE_CHECK=OFF -DMYRIAD_SKIP_MISSING=ON "${of_dependencies[@]}")
else
    require_packages g++ cmake ninja-build libeigen3-dev libxsimd-dev libcli11-dev nlohmann-json3-dev \
        python3-matplotlib
    preset=release
fi

# A separate folder, so that the user's own configuration is not changed.
build=build/case-studies-$preset
say "Building in $build"
quietly "$output/configure.log" cmake --preset "$preset" -B "$build" "${options[@]}"
while read -r left_out; do
    say "Left out: $left_out, which needs nlohmann-json3-dev"
    for i in "${!programs[@]}"; do
        if [[ ${programs[i]} == "$left_out" ]]; then unset "programs[i]"; fi
    done
done < <(sed -n 's/^Left out: example \([a-z_]*\),.*/\1/p' "$output/configure.log")
quietly "$output/build.log" cmake --build "$build" --parallel "$jobs" --target "${programs[@]}"

plot=()
if plotting_python >/dev/null; then plot=(--plot); else say "No pictures, as no Python here has matplotlib"; fi
status=0
table=()
for program in "${programs[@]}"; do
    executable=$(find "$build/examples" -type f -name "$program" -perm -u+x)
    say "$program"
    begin=${EPOCHREALTIME//[.,]/}
    result=""
    "$executable" --device "$device" "${size[@]}" --output "$output/$program.csv" "${plot[@]}" \
        >"$output/$program.log" 2>&1 || {
        result="failed with exit status $?"
        status=1
        tail -n 5 "$output/$program.log"
    }
    table+=("$(printf '%-24s %8.1f s  %s' "$program" "$(((${EPOCHREALTIME//[.,]/} - begin) / 100000))e-1" "$result")")
done
say "Times, with reading, writing and drawing"
printf '   %s\n' "${table[@]}"
exit "$status"
