#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the wheels of the Python package for a release page, and shows that they can be installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh
# shellcheck source=scripts/wheel.sh
source scripts/wheel.sh

wheels=results/wheels
environments=build/wheels

usage() {
    cat <<END
Usage: scripts/wheels.sh [--test] [--help] [PYTHON...]

Builds the wheels of the Python package, as users get them, into $wheels, and installs each in a fresh virtual
environment with NumPy alone. PYTHON are programs (default: python3). A wheel built with Python 3.12 or newer has
CPython's stable ABI, and is for all of them; 3.10 and 3.11 have one each. The tag names the oldest systems that a wheel
runs on, which auditwheel finds: those with the C library of this one, so build them on an old system. The interpreter
in them needs a processor with AVX2.

  --test  also runs the tests of the package with each, those that take long apart
END
}

run_tests=no
pythons=()
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --test) run_tests=yes ;;
        -*) usage_error "Unknown option '$1'" ;;
        *) pythons+=("$1") ;;
    esac
    shift
done
((${#pythons[@]})) || pythons=(python3)

require_packages g++ cmake ninja-build python3 python3-dev python3-venv libxsimd-dev nlohmann-json3-dev
mkdir -p "$wheels"
mapfile -t to_build < <(packages_of wheel)
mapfile -t to_test < <(packages_of test)
for python in "${pythons[@]}"; do
    has_command "$python" || fail "There is no $python."
    tools=$environments/tools clean=$environments/clean made=$environments/made
    make_environment "$python" "$tools" build/wheels.log numpy "${to_build[@]}" ||
        fail "What wheels are built with could not be installed (build/wheels.log)."
    build_wheel "$tools" "$made"
    wheel=$(realpath "$made"/*.whl)
    make_environment "$python" "$clean" build/wheels.log numpy || fail "NumPy could not be installed."
    begun=$(date +%s%N)
    pip_of "$clean" install --no-index "$wheel"
    took=$((($(date +%s%N) - begun) / 1000000))
    say "Installed in $((took / 1000)).$(printf %03d $((took % 1000))) s"
    if [[ $run_tests == yes ]]; then
        pip_of "$clean" install --no-compile pytest-xdist "${to_test[@]}"
        MYRIAD_TEST_WHEEL=$wheel "$clean/bin/python" -m pytest -q --numprocesses "$(nproc)" --dist loadfile python/tests
    fi
    cp "$wheel" "$wheels"
done
(cd "$wheels" && sha256sum ./*.whl)
