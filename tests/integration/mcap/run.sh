#!/bin/sh
# Usage: run.sh MCAP_FIXTURE WORK_FOLDER
# Installs the packages of package-lock.json into WORK_FOLDER (once), then lets either side read what the other wrote.
# Exit status 77: skipped, because node, npm or the packages are not available.
set -eu
fixture=$1
work=$2
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
skip() { echo "SKIPPED: $1"; exit 77; }

command -v node > /dev/null || skip "node is not installed"
command -v npm > /dev/null || skip "npm is not installed"
mkdir -p "$work"
cp "$here"/package.json "$here"/package-lock.json "$here"/*.mjs "$work"
cd "$work"
if ! cmp -s package-lock.json installed-lock.json; then
  rm -f installed-lock.json
  npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 > npm.log 2>&1 || { cat npm.log; skip "npm ci failed: no registry?"; }
  cp package-lock.json installed-lock.json
fi

rm -rf ours theirs
mkdir ours theirs
"$fixture" write ours
node check_ours.mjs ours
node write_theirs.mjs ours/viewable.mcap theirs
for file in theirs/*.mcap; do
  "$fixture" read "$file"
done
