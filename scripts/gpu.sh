#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds both backends on a machine with a GPU, offline, and tests, sanitizes and measures the CUDA backend there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

usage() {
    cat <<'END'
Usage: scripts/gpu.sh [--tests] [--sanitize] [--bench] [--profile] [--methods] [--python] [--deps DIR] [--output DIR]
                      [--jobs N] [--help]

Needs nvcc, cmake, ninja, g++, Eigen, Catch2, Boost and a GPU, and for studies nlohmann's JSON. Nothing is installed and
nothing fetched.
Without --tests, --sanitize, --bench, --profile, --methods or --python: the first three, in this order.

  --tests        the test programs on the GPU, then those of the solver on the CPU too
  --sanitize     compute-sanitizer memcheck and racecheck on small cases
  --bench        the benchmarks, as CSV, and a table of registers, stack and spills per kernel
  --profile      what Nsight Compute counts in four kernels of the benchmark; needs ncu
  --methods      the methods beside each other, as CSV; its kernels take minutes to compile
  --python       the Python package: its wheel is built, and its tests for GPUs and benchmarks are run. Needs Python
                 with NumPy, libnvrtc of the CUDA Toolkit, and in DIR/wheels what the wheel is built and tested with:
                 pip download --only-binary :all: --dest DIR/wheels scikit-build-core nanobind pytest
                 With scipy too, the validation has its references, and errors are compared with other packages'.
                 A wheel of myriad there is taken as it is, which needs neither Python's headers nor CMake.
  --deps DIR     folder with the headers of what is not installed: DIR/xsimd, DIR/CLI, DIR/json (default: .deps,
                 if it is there)
  --output DIR   where logs and CSV files go (default: results/gpu)
  --jobs N       processes at a time (default: number of cores)
END
}

deps=.deps
output=results/gpu
jobs=$(nproc)
parts=()
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --tests | --sanitize | --bench | --profile | --methods | --python) parts+=("${1#--}") ;;
        --deps | --output | --jobs)
            (($# > 1)) || usage_error "$1 needs a value"
            case $1 in --deps) deps=$2 ;; --output) output=$2 ;; --jobs) jobs=$2 ;; esac
            shift ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
    shift
done
((${#parts[@]})) || parts=(tests sanitize bench)
wants() { [[ " ${parts[*]} " == *" $1 "* ]]; }

has_command nvcc || { say "nvcc is not on the PATH: install the CUDA Toolkit"; exit 2; }
nvidia-smi --query-gpu=name,driver_version --format=csv,noheader || {
    say "There is no GPU, or no driver for it"
    exit 2
}
mkdir -p "$output"
failed=()

# The Python package, unpacked into a folder rather than installed, as nothing may be.
test_python() {
    local packages=$PWD/build/python-gpu wheel
    rm -rf "$packages" build/python-gpu-wheel
    mkdir -p "$packages" build/python-gpu-wheel
    for wheel in "$deps"/wheels/*.whl; do
        [[ -e $wheel && $(basename "$wheel") != numpy-* ]] && python3 -m zipfile -e "$wheel" "$packages"
    done
    export PYTHONPATH=$packages
    if [[ ! -e $packages/myriad_ode ]]; then
        say "Building the wheel"
        python3 - "$PWD/$deps" >"$output/python_build.log" 2>&1 <<'END' ||
import os, sys
from scikit_build_core.build import build_wheel
folders = {"XSIMD": (sys.argv[1], "xsimd"), "JSON": (sys.argv[1] + "/json/include", "nlohmann")}
print(build_wheel("build/python-gpu-wheel", {f"cmake.define.MYRIAD_{name}_INCLUDE_DIR": folder
                                             for name, (folder, headers) in folders.items()
                                             if os.path.isdir(f"{folder}/{headers}")}))
END
            { tail -20 "$output/python_build.log"; return 1; }
        python3 -m zipfile -e build/python-gpu-wheel/*.whl "$packages"
    fi
    local status=0
    MYRIAD_TEST_DEVICE=cuda python3 -m pytest -q --full -p no:cacheprovider --durations=5 \
        python/tests/test_gpu.py python/tests/test_gpu_dynamics.py python/tests/test_validation.py \
        python/tests/test_nvrtc.py 2>&1 |
        tee "$output/python_tests.log" | tail -40 || status=1
    python3 benchmarks/python/van_der_pol.py --check --output "$output/python_van_der_pol.csv" 2>&1 |
        tee "$output/python_van_der_pol.log" || status=1
    python3 benchmarks/python/pleiades.py --check 2>&1 | tee "$output/python_pleiades.txt" || status=1
    python3 benchmarks/python/generated_study.py --check 2>&1 | tee "$output/python_generated_study.txt" || status=1
    if python3 -c 'import scipy' 2>/dev/null; then
        python3 benchmarks/python/compare.py --side 1024 --programs "myriad gpu" cubie myriad \
            --output "$output/python_compare.csv" || status=1
    fi
    return "$status"
}
if wants python; then
    test_python || failed+=(python)
    if [[ ${parts[*]} == python ]]; then
        if ((${#failed[@]})); then
            say "Failed: ${failed[*]}"
            exit 1
        fi
        say "All well"
        exit
    fi
fi

mapfile -t options < <(dependency_options "$deps")
options+=(-DMYRIAD_BUILD_VALIDATION=OFF -DMYRIAD_CUDA_COMPILE_CHECK=OFF)
study=true
if [[ ! -d $deps/json ]] && ! has_package nlohmann-json3-dev; then
    study=false
    options+=(-DMYRIAD_BUILD_STUDY=OFF)
fi
say "Building in build/cuda"
cmake --preset cuda "${options[@]}" >"$output/configure.log" 2>&1 || { tail -30 "$output/configure.log"; exit 1; }
targets=()
if wants tests || wants sanitize; then targets+=(check_gpu); fi
if wants bench; then targets+=(gpu_ensembles end_to_end several_gpus); fi
if wants bench && $study; then targets+=(large_study); fi
if wants profile; then targets+=(gpu_ensembles); fi
if wants methods; then targets+=(methods); fi
cmake --build --preset cuda --parallel "$jobs" --target "${targets[@]}" -- -k 0 >"$output/build.log" 2>&1 || {
    grep -E "error|FAILED" "$output/build.log" | head -40 || true
    failed+=(build)
}

if wants tests; then
    for program in build/cuda/tests/*_test; do
        name=$(basename "$program" _test)
        grep -qw "$name" build/cuda/tests/gpu_programs.txt || continue
        if MYRIAD_TEST_DEVICE=cuda timeout 300 "$program" >"$output/tests_$name.log" 2>&1; then
            say "$name on the GPU: $(tail -2 "$output/tests_$name.log" | head -1)"
        else
            failed+=("$name")
            say "$name on the GPU: FAILED"
            tail -4 "$output/tests_$name.log"
        fi
    done
    if ! build/cuda/tests/solver_test >"$output/tests_solver_cpu.log" 2>&1; then
        failed+=(solver-on-the-cpu)
        tail -4 "$output/tests_solver_cpu.log"
    fi
fi

if wants sanitize; then
    for tool in memcheck racecheck; do
        # Tests provoke errors of the CUDA calls on purpose.
        flags=(--tool "$tool" --error-exitcode 9)
        if [[ $tool == memcheck ]]; then flags+=(--report-api-errors no); fi
        if MYRIAD_TEST_DEVICE=cuda timeout 400 compute-sanitizer "${flags[@]}" \
            build/cuda/tests/solver_test '[small]' >"$output/$tool.log" 2>&1; then
            say "compute-sanitizer $tool: clean"
        else
            failed+=("$tool")
            say "compute-sanitizer $tool: FAILED"
        fi
        grep "SUMMARY" "$output/$tool.log" || true
    done
fi

if wants bench; then
    commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
    build/cuda/benchmarks/gpu_ensembles/gpu_ensembles --commit "$commit" \
        --output "$output/gpu_ensembles.csv" || failed+=(bench)
    build/cuda/benchmarks/end_to_end/end_to_end --commit "$commit" \
        --output "$output/end_to_end.csv" || failed+=(end_to_end)
    if (($(nvidia-smi -L | grep -c '^GPU ') > 1)); then
        build/cuda/benchmarks/several_gpus/several_gpus | tee "$output/several_gpus.csv" || failed+=(several_gpus)
    fi
    if $study; then
        build/cuda/benchmarks/large_study/large_study --device cuda --keep "$output" |
            tee "$output/large_study.txt" || failed+=(large_study)
    fi
    cuobjdump --dump-resource-usage build/cuda/benchmarks/gpu_ensembles/gpu_ensembles 2>/dev/null | c++filt |
        sed -nE '
            /Function/ { s/.*Function (void )?//; s/(, )?\(.*//; h }
            /REG:/ { s/.*(REG:[0-9]+).*(STACK:[0-9]+).*(LOCAL:[0-9]+).*/\1 \2 \3/; G; s/\n/  /p }' |
        tee "$output/kernels.txt" || failed+=(kernels)
fi

# profile CASE SCALE: rows "CASE,SCALE,metric,unit,value" of the first kernel of a case, with its first number of
# instances times SCALE; shares are of the peak, at the GPU's base clocks.
profile() {
    local log=$output/profile_$1.log metrics=(gpu__time_duration.sum
        sm__inst_executed_pipe_fp64.avg.pct_of_peak_sustained_active sm__inst_executed_pipe_fp64.sum # double precision
        smsp__issue_active.avg.pct_of_peak_sustained_active smsp__inst_executed.sum
        sm__warps_active.avg.pct_of_peak_sustained_active   # of the warps that fit
        smsp__thread_inst_executed_per_inst_executed.ratio) # threads that take part, of 32
    ncu --kernel-name integrate_ensemble --launch-count 1 --kill yes --csv --print-units base \
        --metrics "$(IFS=, && printf '%s' "${metrics[*]}")" \
        build/cuda/benchmarks/gpu_ensembles/gpu_ensembles --cases "$1" --instances-scale "$2" --repetitions 1 \
        >"$log" 2>&1 || true
    python3 - "$log" "$1,$2" <<'END'
import csv, sys
rows = [row for row in csv.reader(line for line in open(sys.argv[1]) if line.startswith('"')) if len(row) > 3]
for row in rows[1:]:
    print(sys.argv[2], row[-3], row[-2], row[-1].replace(",", ""), sep=",")
sys.exit(len(rows) < 2)
END
}
if wants profile; then
    say "Profiles"
    {
        printf 'case,instances_scale,metric,unit,value\n'
        profile lorenz_rk4 8 && profile lorenz_tsit5_1e-6 16 && profile keller_miksis 1 && profile relief_valve 3.75
    } | tee "$output/profile.csv" || failed+=(profile)
fi

if wants methods; then
    build/cuda/benchmarks/methods/methods --device cuda --output "$output/methods.csv" || failed+=(methods)
fi

if ((${#failed[@]})); then
    say "Failed: ${failed[*]}"
    exit 1
fi
say "All well"
