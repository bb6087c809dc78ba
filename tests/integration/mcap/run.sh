#!/bin/sh
# Usage: run.sh MCAP_FIXTURE ISOTHERM WORK_FOLDER
# Installs the packages of package-lock.json into WORK_FOLDER (once), then lets either side read what the other wrote.
# Exit status 77: skipped, because node, npm or the packages are not available.
set -eu
fixture=$1
isotherm=$2
work=$3
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
# What `isotherm convert` makes for viewers, by the schemas of Foxglove.
printf '1700000000.1 1 2 0.5 0 0 0 1\n1700000000.3 1 2 0.75 0 0 0 1\n' > poses.txt
"$isotherm" convert ours/compact.mcap -o ours/converted.mcap --encoding viewable --trajectory poses.txt
node check_viewable.mjs ours/converted.mcap
node write_theirs.mjs ours/viewable.mcap theirs
for file in theirs/*.mcap; do
  "$fixture" read "$file"
done
