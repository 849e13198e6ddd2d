#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that the sources are formatted as .clang-format says, by one version of clang-format, and that no line is too
# long.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

version=14.0.6 # Debian 12's; another one formats some lines otherwise
folder=build/clang-format

usage() {
    cat <<END
Usage: scripts/format.sh [--fix] [--required] [FILE...] [--help]

Checks all files of C++ and CUDA, or those named, with clang-format $version: the one on the PATH if it is of that
version, else the one in $folder, where it is installed from PyPI if it is not there yet. Then checks that
no line of C++, CUDA, CMake, Python and shell has more than 120 columns. Exit status 1 if a file is not as it should be.

Options:
  --fix       formats the files instead of checking them
  --required  fails if there is no such clang-format and none can be installed; else this is said, and no more
  --help      this text
END
}

fix=no
required=no
files=()
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --fix) fix=yes ;;
        --required) required=yes ;;
        -*) usage_error "Unknown option '$1'" ;;
        *)
            [[ -f $1 ]] || usage_error "There is no file '$1'"
            files+=("$1") ;;
    esac
    shift
done

# Prints the path of the right clang-format, or fails.
find_clang_format() {
    local command
    for command in clang-format "clang-format-${version%%.*}" "$folder/bin/clang-format"; do
        if has_command "$command" && "$command" --version 2>/dev/null | grep -qE "version $version(\$|[^0-9])"; then
            printf '%s' "$command"
            return
        fi
    done
    return 1
}
install_clang_format() {
    rm -rf "$folder"
    mkdir -p "${folder%/*}"
    python3 -m venv "$folder" >"$folder.log" 2>&1 &&
        "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --retries 1 --timeout 20 \
            "clang-format==$version" >>"$folder.log" 2>&1
}

if ! clang_format=$(find_clang_format); then
    install_clang_format || true
    if ! clang_format=$(find_clang_format); then
        say "Formatting not checked: clang-format $version is not on the PATH and could not be installed ($folder.log)."
        [[ $required == no ]] || exit 1
        clang_format=''
    fi
fi

if ((${#files[@]} == 0)); then
    mapfile -t files < <(scripts/check_sources.py --list)
fi
formatted=()
for file in "${files[@]}"; do
    if [[ $file =~ \.(hpp|cuh|cpp|cu)$ ]]; then formatted+=("$file"); fi
done

status=0
if [[ $clang_format && ${#formatted[@]} -gt 0 ]]; then
    if [[ $fix == yes ]]; then
        # Once is not enough where comments stand in a column.
        for _ in 1 2; do "$clang_format" -i "${formatted[@]}"; done
    else
        # At most eight processes, a few files each; the first lines of their output are enough.
        wrong=$(printf '%s\0' "${formatted[@]}" | xargs -0 -n 16 -P 8 "$clang_format" --dry-run 2>&1 |
            sed -nE 's/^([^:]+):[0-9]+:[0-9]+: warning: .*/\1/p' | sort | uniq -c | sort -rn)
        if [[ $wrong ]]; then
            printf '%s\n' "Places to be formatted, by file:" "$wrong" "Run scripts/format.sh --fix."
            status=1
        fi
    fi
fi
scripts/check_sources.py --lines "${files[@]}" || status=1
((status)) || say "${#files[@]} files are as they should be."
exit "$status"
