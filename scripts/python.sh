#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the wheel of the Python package, installs it in a fresh virtual environment, checks its types, and runs its
# tests there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh
# shellcheck source=scripts/wheel.sh
source scripts/wheel.sh

wheels=build/wheels
environment=build/python-environment

usage() {
    cat <<END
Usage: scripts/python.sh [--required] [--others] [--help] [PYTEST ARGUMENT...]

Builds the wheel of the Python package into $wheels, with the tag of the oldest systems that it runs on, which
auditwheel finds, installs it with what its tests need in a fresh virtual environment, $environment, checks
it by ruff and, with the programs of python/examples, by mypy, and runs the tests of python/tests with the arguments
given. scikit-build-core, nanobind, auditwheel and the tests' packages come from PyPI. Exit status 77 if they cannot be
installed.

Options:
  --required  exit status 1 instead of 77
  --others    also tests of work with other packages (JAX, Dask, SALib and more), whose download takes minutes
  --full      an argument of pytest: also tests that are marked as long, with NVRTC
  --all       an argument of pytest: what --full does, tests that are marked as thorough, all models for all GPUs by
              NVRTC, which takes minutes, and a wheel as users get it; without it the wheel is optimised less, and is
              for tests alone
  --help      this text
END
}

missing_status=77
extras=(test)
if has_command nvidia-smi; then extras+=(cuda); fi
as_for_users=no
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --required) missing_status=1 ;;
        --others) extras+=(test-others) ;;
        *) break ;;
    esac
    shift
done

if [[ " $* " == *" --full "* || " $* " == *" --all "* ]]; then extras+=(cuda); fi
if [[ " $* " == *" --all "* ]]; then as_for_users=yes; fi

require_packages g++ cmake ninja-build python3 python3-dev python3-venv libxsimd-dev nlohmann-json3-dev
mapfile -t packages < <(packages_of wheel "${extras[@]}")
if ! make_environment python3 "$environment" "$environment.log" numpy pytest-xdist "${packages[@]}"; then
    say "The Python package was NOT tested: what it is built and tested with could not be installed ($environment.log)."
    exit "$missing_status"
fi
definitions=()
if [[ $as_for_users == no ]]; then
    definitions=(-Ccmake.define.CMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG -DMYRIAD_OUT_OF_LINE")
fi
build_wheel "$environment" "$wheels" "${definitions[@]}"
pip_of "$environment" install --no-compile --no-deps "$wheels"/*.whl
"$environment/bin/ruff" check python
"$environment/bin/mypy" --no-error-summary -p myriad_ode
"$environment/bin/mypy" --no-error-summary python/examples/*.py python/examples/case_studies/*.py
"$environment/bin/mypy" --no-error-summary python/examples/how_to/*.py
MYRIAD_TEST_WHEEL=$(realpath "$wheels"/*.whl) \
    "$environment/bin/python" -m pytest -q --numprocesses "$(nproc)" --dist loadfile "$@" python/tests
