#!/usr/bin/env bash
# Names what was skipped in a run of ctest, and fails if tests/skips.txt does not list it: skips.sh PRESET CTEST_OUTPUT DETAILS
# CTEST_OUTPUT is what ctest printed, DETAILS its LastTest.log with what the programs printed.
set -euo pipefail
preset=$1 printed=$2 details=$3
list=$(dirname "${BASH_SOURCE[0]}")/skips.txt

# Cases of test programs, which ctest calls passed, and tests that ctest itself calls skipped (exit status 77).
skipped=$({
  sed -nE 's/^\[  SKIPPED \] ([A-Za-z0-9_\/]+\.[A-Za-z0-9_\/]+) \(.*$/\1/p' "$details"
  sed -nE 's/^.*Test +#[0-9]+: ([^ ]+) \.*\*\*\*Skipped.*$/\1/p' "$printed"
} | sort -u)
[ -n "$skipped" ] || exit 0
echo "== skipped (reasons in $details)"
echo "$skipped"
unlisted=$(echo "$skipped" | grep -vxFf <(sed -e '/^#/d' -e "s/^$preset: //" "$list") || true)
[ -n "$unlisted" ] || exit 0
echo "== skipped, but not in tests/skips.txt"
echo "$unlisted"
exit 1
