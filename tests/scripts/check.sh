#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the scripts: syntax, options, how tests are counted, and what is said when packages are missing.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# expect NAME STATUS REGULAR-EXPRESSION COMMAND...: the command's exit status and output.
expect() {
    local name=$1 status=$2 pattern=$3 output actual=0
    shift 3
    output=$("$@" 2>&1) || actual=$?
    if ((actual != status)) || ! grep -qE -- "$pattern" <<<"$output"; then
        printf 'FAILED %s: exit status %d (expected %d), output (expected %s):\n%s\n' \
            "$name" "$actual" "$status" "$pattern" "$output"
        failures=$((failures + 1))
    else
        printf 'ok     %s\n' "$name"
    fi
}

# in_lib COMMANDS: evaluates them with lib.sh sourced.
# shellcheck disable=SC2317 # called through expect
in_lib() { bash -c "set -euo pipefail; source scripts/lib.sh; $1"; }

scripts=(scripts/*.sh .ci/run tests/scripts/check.sh tests/must_not_compile/check.sh tests/start_page/run.sh)
for script in "${scripts[@]}"; do
    expect "$script is valid bash" 0 '' bash -n "$script"
done
if command -v shellcheck >/dev/null; then
    expect "shellcheck finds nothing" 0 '' shellcheck -x "${scripts[@]}"
fi

expect "test.sh --help" 0 'Usage: scripts/test.sh' scripts/test.sh --help
expect "test.sh refuses an unknown option" 2 "Unknown option '--fast'" scripts/test.sh --fast
expect "test.sh refuses an unknown step" 2 "no step 'gpu'" scripts/test.sh --only ci,gpu
expect "test.sh refuses --only without steps" 2 '--only needs steps' scripts/test.sh --only
expect "test.sh refuses a wrong number of jobs" 2 '--jobs needs' scripts/test.sh --jobs 0
expect "release.sh --help" 0 'Usage: scripts/release.sh' scripts/release.sh --help
expect "release.sh refuses an unknown option" 2 "Unknown option '--push'" scripts/release.sh --push
if git rev-parse --verify --quiet HEAD >/dev/null 2>&1; then
    # In a copy with what this folder has, committed or not.
    copied=$work/copy
    git clone --quiet --no-hardlinks . "$copied"
    git ls-files -co --exclude-standard | while read -r file; do
        rm -f "$copied/$file"
        if [[ -f $file ]]; then install -D --mode="$(stat -c %a "$file")" "$file" "$copied/$file"; fi
    done
    copy_git() { git -C "$copied" -c user.name=tester -c user.email=tester@example.invalid "$@"; }
    copy_git add --all
    copy_git commit --quiet --allow-empty --message "As it is"
    expect "release.sh --dry-run checks and packs" 0 'myriad-[0-9.]+\.tar\.gz' "$copied/scripts/release.sh" --dry-run
    expect "release.sh makes no tag then" 0 '^$' copy_git tag --list 'v*'
    sed -i 's/^version: .*/version: 99.0.0/' "$copied/CITATION.cff"
    expect "release.sh refuses what is not committed" 1 'not committed:.*|CITATION.cff' \
        "$copied/scripts/release.sh" --dry-run
    copy_git commit --quiet --all --message "Another version"
    expect "release.sh refuses versions that differ" 1 'CITATION.cff says 99.0.0' "$copied/scripts/release.sh" --dry-run
fi
expect "all files agree on the version" 0 'agree on version' scripts/version.py --check
expect "format.sh --help" 0 'Usage: scripts/format.sh' scripts/format.sh --help
expect "format.sh refuses an unknown option" 2 "Unknown option '--now'" scripts/format.sh --now
printf 'int  wrong ( );\n' >"$work/wrong.cpp"
expect "format.sh finds a file that is not formatted" 1 'wrong.cpp|Formatting not checked' \
    scripts/format.sh --required "$work/wrong.cpp"
printf '# %0200d\n' 0 >"$work/long.py"
expect "format.sh finds a line that is too long" 1 'long.py:1: 202 columns' scripts/format.sh "$work/long.py"
expect "validate.sh --help" 0 'Usage: scripts/validate.sh' scripts/validate.sh --help
expect "validate.sh refuses an unknown device" 2 "no device 'abacus'" scripts/validate.sh --device abacus
expect "case_studies.sh --help" 0 'Usage: scripts/case_studies.sh' scripts/case_studies.sh --help
expect "case_studies.sh refuses an unknown program" 2 "no case study 'abacus'" scripts/case_studies.sh --only abacus
expect "case_studies.sh refuses an unknown device" 2 "no device 'abacus'" scripts/case_studies.sh --device abacus
expect "python.sh --help" 0 'Usage: scripts/python.sh' scripts/python.sh --help
expect "docs.sh --help" 0 'Usage: scripts/docs.sh' scripts/docs.sh --help
expect "docs.sh refuses an unknown option" 2 "Unknown option '--quick'" scripts/docs.sh --quick
expect "site_sources.py puts the site's sources together" 0 '^$' scripts/site_sources.py "$work/sources"
expect "site_sources.py gives them the version" 0 "^$(python3 scripts/version.py)$" cat "$work/sources/version.txt"
mkdir "$work/site"
printf '<a href="#here">x</a><a href="b.html#gone">y</a><img src="c.png"><p id="here">' >"$work/site/a.html"
printf '<p id="there">' >"$work/site/b.html"
expect "check_site.py finds an anchor that is not there" 1 'b.html#gone has no such anchor' \
    scripts/check_site.py "$work/site"
expect "check_site.py finds an image that is not there" 1 'c.png is not there' scripts/check_site.py "$work/site"
expect "check_site.py counts what is broken" 1 '2 pages, 3 links within the site, 2 of them broken' \
    scripts/check_site.py "$work/site"
expect "check_site.py refuses an empty folder" 1 '0 pages' scripts/check_site.py "$work/none"
expect "quickstart.sh --help" 0 'Usage: scripts/quickstart.sh' scripts/quickstart.sh --help
expect "quickstart.sh refuses an unknown option" 2 "Unknown option 'now'" scripts/quickstart.sh now

none_failed='100% tests passed, 0 tests failed out of 3'
printf '%s\n' '1/3 Test #1: a .......   Passed    0.01 sec' "$none_failed" >"$work/good.log"
printf '%s\n' '67% tests passed, 1 tests failed out of 3' >"$work/bad.log"
printf '%s\n' '2/3 Test #2: b .......***Skipped   0.01 sec' "$none_failed" >"$work/skipped.log"
printf '%s\n' 'No tests were found!!!' >"$work/none.log"
expect "tests that passed are counted" 0 '^3 0 0$' in_lib "count_tests '$work/good.log' 0"
expect "tests that failed are counted" 0 '^2 1 0$' in_lib "count_tests '$work/bad.log' 8"
expect "skipped tests have not passed" 0 '^2 0 1$' in_lib "count_tests '$work/skipped.log' 0"
expect "a run without tests is a failure" 0 '^0 1 0$' in_lib "count_tests '$work/none.log' 8"

# Steps, with a cmake and a ctest that only say how they were called, and packages that are all there.
mkdir -p "$work/steps/scripts" "$work/programs"
cp scripts/test.sh scripts/lib.sh scripts/budgets.txt "$work/steps/scripts"
sed -i 's/^require_packages .*//' "$work/steps/scripts/test.sh"
cat >"$work/programs/cmake" <<'END'
#!/bin/sh
echo "cmake $*" >>calls
END
cat >"$work/programs/ctest" <<'END'
#!/bin/sh
echo "ctest $*" >>calls
case $* in
*exclude*) echo '50% tests passed, 1 tests failed out of 2' && exit 8 ;;
*) echo '100% tests passed, 0 tests failed out of 3' ;;
esac
END
chmod +x "$work"/programs/*
# shellcheck disable=SC2317 # called through expect
run_steps() { PATH=$work/programs:$PATH "$work/steps/scripts/test.sh" "$@" && echo succeeded; }
# shellcheck disable=SC2317 # called through expect
last_of_steps() { run_steps "$@" | tail -n 1; }
expect "test.sh fails where a test does" 1 'ci: 1 passed, 1 failed' run_steps --quick
expect "test.sh ends with the counts" 1 '^4 passed, 1 failed$' last_of_steps --only programs,ci
expect "test.sh succeeds where all tests do" 0 '^succeeded$' last_of_steps --only programs
expect "test.sh says what a step computed" 0 'programs +[0-9]+ +[0-9]+ +[1-9][0-9]+$' run_steps --only programs
printf 'programs 0\n' >"$work/steps/scripts/budgets.txt"
expect "a step that computes for longer than its budget is a failure" 1 'programs: FAILED, it computed for [1-9]' \
    env 'BASH_FUNC_cmake%%=() { awk "BEGIN { for (i = 0; i < 1.5e8; i++); }"; }' PATH="$work/programs:$PATH" \
    "$work/steps/scripts/test.sh" --only programs
rm "$work/steps/calls"
run_steps --only ci,programs >/dev/null
left_out=$(sed -n 's/^ctest .* --label-exclude ^cuda$|//p' "$work/steps/calls")
chosen=$(sed -n 's/^ctest .* --label-regex //p' "$work/steps/calls")
expect "each test of preset ci but cuda's runs in one of two steps" 0 '' test -n "$chosen" -a "$left_out" = "$chosen"

missing='has_package() { return 1; }'
expect "without root and sudo, packages and command are named" 1 'apt-get install libxsimd-dev catch2' \
    in_lib "$missing; id() { echo 1000; }; has_command() { [[ \$1 == apt-get ]]; }
            require_packages libxsimd-dev catch2"
expect "without apt-get, packages are named" 1 'Debian.s packages: libxsimd-dev catch2' \
    in_lib "$missing; has_command() { return 1; }; require_packages libxsimd-dev catch2"
expect "nothing is installed if nothing is missing" 0 'All packages needed' \
    in_lib "has_package() { return 0; }; apt_get() { exit 9; }; require_packages libxsimd-dev"
installs='apt-get .*install --yes --no-install-recommends catch2'
expect "with sudo, apt-get runs through it" 0 "called with env DEBIAN_FRONTEND=noninteractive $installs" \
    in_lib "has_package() { [[ -e '$work/done' ]]; }; id() { echo 1000; }; has_command() { return 0; }
            sudo() {
                [[ \$1 == -n ]] && return
                echo called with \"\$@\" >>'$work/sudo.log'
                [[ \$* == *install* ]] && touch '$work/done'
                return 0
            }
            require_packages catch2; cat '$work/sudo.log'"
expect "output of apt-get is shown if it fails" 1 'no such thing' \
    in_lib "$missing; root_prefix() { return 0; }; env() { echo no such thing; return 100; }; require_packages catch2"

# Every file with code says its licence, and none knows where it was written.
unlicensed=$(find . \( -name '.?*' -o -name build -o -name results -o -name __pycache__ \) -prune -o -type f \
    \( -name '*.hpp' -o -name '*.cuh' -o -name '*.cpp' -o -name '*.cu' \
    -o -name '*.sh' -o -name '*.py' -o -name '*.cmake' -o -name CMakeLists.txt \) \
    -exec grep -L 'SPDX-License-Identifier: MIT' {} +)
expect "every file with code has its SPDX line" 0 '^$' echo "$unlicensed"

exit $((failures > 0))
