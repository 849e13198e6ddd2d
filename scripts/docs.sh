#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the documentation's site: docs/ and the reference of the public interface, as HTML.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

tools=build/docs-tools
sources=build/site-sources
site=build/site
doctrees=build/site-doctrees

usage() {
    cat <<END
Usage: scripts/docs.sh [--external] [--required] [--help]

Builds the site of the documentation, $site/index.html. Warnings are errors, and so are links within the site
that lead nowhere. Doxygen comes from Debian; Sphinx and its theme, in the versions of docs/requirements.txt, from PyPI
into $tools. Exit status 77 if they can be neither found nor installed.

Options:
  --external  checks the links to other sites too, which takes a network
  --required  exit status 1 instead of 77
  --help      this text
END
}

external=no
missing_status=77
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --external) external=yes ;;
        --required) missing_status=1 ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
    shift
done

# The tools are those of docs/requirements.txt if they were installed from the same file.
tools_are_there() {
    cmp -s docs/requirements.txt "$tools/requirements.txt" && "$tools/bin/python" -c 'import sphinx' 2>/dev/null
}
install_tools() {
    rm -rf "$tools"
    mkdir -p "${tools%/*}"
    python3 -m venv "$tools" >"$tools.log" 2>&1 &&
        "$tools/bin/python" -m pip install --quiet --disable-pip-version-check --retries 1 --timeout 20 --no-deps \
            --requirement docs/requirements.txt >>"$tools.log" 2>&1 &&
        cp docs/requirements.txt "$tools/requirements.txt"
}

(require_packages doxygen python3-venv) || true
if ! has_command doxygen; then
    say "The site was NOT built: there is no doxygen, and it could not be installed."
    exit "$missing_status"
fi
if ! tools_are_there && ! install_tools; then
    tail -n 5 "$tools.log" >&2 || true
    say "The site was NOT built: Sphinx is not in $tools, and could not be installed there ($tools.log)."
    exit "$missing_status"
fi

started=$SECONDS
scripts/check_readme.py
scripts/site_sources.py "$sources"
scripts/reference.py --write "$sources/reference"
scripts/python_reference.py --write "$sources/reference"
rm -rf "$site"
"$tools/bin/python" -m sphinx -q -W --keep-going -n -j auto -b html -d "$doctrees" "$sources" "$site"
scripts/check_site.py "$site"
if [[ $external == yes ]]; then
    "$tools/bin/python" -m sphinx -q -W --keep-going -b linkcheck -d "$doctrees" "$sources" build/site-links
fi
say "Built $site/index.html in $(duration $((SECONDS - started)))"
