#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes a release of the version in include/myriad/version.hpp: checks, tests, tag, archive.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

usage() {
    cat <<'END'
Usage: scripts/release.sh [--dry-run] [--help]

Checks that everything is committed, that all files agree on the version (scripts/version.py) and that there is no tag
of it yet; runs scripts/test.sh --all; then makes the tag v<version> and results/myriad-<version>.tar.gz with its
SHA-256 sum. Pushes nothing.

  --dry-run  makes the checks and the archive of the last commit; runs no tests and makes no tag
END
}

dry_run=no
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --dry-run) dry_run=yes ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
    shift
done

version=$(python3 scripts/version.py)
tag=v$version
say "Release of version $version"

[[ $(git rev-parse --show-toplevel 2>/dev/null) == "$PWD" ]] || fail "This is no checkout of Myriad: clone it first."
changed=$(git status --porcelain)
[[ -z $changed ]] || fail "These files are not committed:
$changed
Commit them, or put them aside, then run this again."
if git rev-parse --quiet --verify "refs/tags/$tag" >/dev/null; then
    fail "There is a tag $tag already: raise the version in include/myriad/version.hpp."
fi
if [[ $dry_run == yes ]]; then
    python3 scripts/version.py --check || fail "The files do not agree on the version, see above."
    python3 scripts/version.py --release >/dev/null ||
        say "Before the release CHANGELOG.md needs a section of $version with a date."
else
    python3 scripts/version.py --release || fail "The version is not ready, see above."
    scripts/test.sh --all || fail "Tests failed, see above: there is no release."
    git tag --annotate "$tag" --message "Myriad $version"
    say "Tag $tag"
fi

mkdir -p results
archive=results/myriad-$version.tar.gz
git archive --format=tar.gz --prefix="myriad-$version/" --output="$archive" HEAD
sha256sum "$archive"
[[ $dry_run == yes ]] || say "Next: git push origin $tag, the sum above in packaging/spack/package.py, and the wheels of
scripts/wheels.sh --test on the release's page"
