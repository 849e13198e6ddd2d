#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the validation, runs it, and writes its report as CSV, Markdown and plots. Exit status 1 if a bound is
# exceeded.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

usage() {
    cat <<'END_OF_USAGE'
Usage: scripts/validate.sh [--device cpu|cuda] [--mutations] [--quick] [--deps DIR] [--output DIR] [--jobs N] [--help]

Compares every method on every problem with SUNDIALS CVODE and closed forms, and writes DIR/report.csv, DIR/report.md
and DIR/tolerance.png, DIR/work.png (default of DIR: results/validation/DEVICE); on the CPU, sensitivities with those of
CVODES too, DIR/sensitivities.md.

  --device cpu     installs what is missing (as root or with sudo), builds in build/release; compares with the results
                   in validation/gpu/results.csv too, if they are there (default)
  --device cuda    builds in build/cuda, installs nothing; compares with the CPU in the same run; DIR/recorded.csv are
                   the results to keep as validation/gpu/results.csv
  --mutations      then also shows that wrong coefficients and wrong loops are found
  --quick          fewer tolerances and shorter statistics
  --deps DIR       folder with what is not installed: DIR/xsimd, DIR/CLI, DIR/sundials with include/ and lib/
                   (default: .deps, if it is there)
  --jobs N         processes at a time (default: number of cores)
END_OF_USAGE
}

device=cpu
deps=.deps
output=""
jobs=$(nproc)
mutations=no
program_options=()
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --mutations) mutations=yes ;;
        --quick) program_options+=(--quick) ;;
        --device | --deps | --output | --jobs)
            (($# > 1)) || usage_error "$1 needs a value"
            case $1 in --device) device=$2 ;; --deps) deps=$2 ;; --output) output=$2 ;; --jobs) jobs=$2 ;; esac
            shift ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
    shift
done
[[ $device == cpu || $device == cuda ]] || usage_error "There is no device '$device': choose cpu or cuda"
output=${output:-results/validation/$device}
mkdir -p "$output"

options=(-DMYRIAD_BUILD_TESTS=OFF -DMYRIAD_BUILD_EXAMPLES=OFF -DMYRIAD_BUILD_BENCHMARKS=OFF)
if [[ $device == cpu ]]; then
    require_packages g++ cmake ninja-build python3 \
        libeigen3-dev libxsimd-dev libcli11-dev libboost-dev libsundials-dev python3-matplotlib
    preset=release
else
    has_command nvcc || fail "nvcc is not on the PATH: install the CUDA Toolkit" 2
    nvidia-smi --query-gpu=name,driver_version --format=csv,noheader || fail "There is no GPU, or no driver for it" 2
    preset=cuda
    mapfile -t of_dependencies < <(dependency_options "$deps")
    options+=(-DMYRIAD_CUDA_COMPILE_CHECK=OFF "${of_dependencies[@]}")
fi

# A separate folder, so that the user's own configuration is not changed.
build=build/validate-$device
say "Building in $build"
quietly "$output/configure.log" cmake --preset "$preset" -B "$build" "${options[@]}"
targets=(validate)
if [[ $device == cpu ]]; then targets+=(validate_sensitivities); fi
if [[ $mutations == yes ]]; then targets+=(validate_mutated_methods); fi
quietly "$output/build.log" cmake --build "$build" --parallel "$jobs" --target "${targets[@]}"

program=$build/validation/validate
if [[ $device == cuda ]]; then
    program_options+=(--record "$output/recorded.csv")
elif [[ -r validation/gpu/results.csv ]]; then
    program_options+=(--compare validation/gpu/results.csv)
fi
say "Validating on $device"
status=0
"$program" --device "$device" --output "$output" "${program_options[@]}" || status=$?
((status < 2)) || exit "$status"

if [[ $device == cpu ]]; then
    "$build/validation/sensitivities/validate_sensitivities" | tee "$output/sensitivities.md" || status=1
fi

images=""
if python=$(plotting_python); then
    "$python" validation/plot.py "$output/report.csv" "$output"
    images=.
else
    say "No pictures, as no Python here has matplotlib"
fi
python3 validation/report.py "$output/report.csv" "$output/report.md" --images "$images" \
    --command "scripts/validate.sh --device $device"
say "Report: $output/report.md"

if [[ $mutations == yes ]]; then
    say "Mutations"
    "$build/validation/validate_mutated_methods" || status=1
    cmake --build "$build" --target check_mutated_loops || status=1
fi
exit "$status"
