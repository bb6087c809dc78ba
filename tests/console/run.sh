#!/bin/sh
# Usage: run.sh TEST.mjs BIN_FOLDER WORK_FOLDER
# Runs one of the tests here on the programs in BIN_FOLDER. Exit status 77: skipped, and says why.
set -eu
test=$1
CONSOLE_BIN=$2
CONSOLE_WORK=$3
data=${ISOTHERM_DATA_DIR-}
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
skip() { echo "SKIPPED: $1"; exit 77; }

command -v node >/dev/null || skip "node is not installed"
command -v npm >/dev/null || skip "npm is not installed"
[ -x /usr/bin/chromium ] || skip "chromium is not installed"
[ -f "$data/furnace_dev/rig.textproto" ] || skip "no recorded scans (ISOTHERM_DATA_DIR)"
mkdir -p "$CONSOLE_WORK"
(
  flock 9
  cp "$here"/package.json "$here"/package-lock.json "$here"/*.mjs "$CONSOLE_WORK"
  cd "$CONSOLE_WORK"
  if ! cmp -s package-lock.json installed-lock.json; then
    rm -f installed-lock.json
    npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 >npm.log 2>&1 || { cat npm.log; skip "npm ci failed: no registry?"; }
    cp package-lock.json installed-lock.json
  fi
  [ -f furnace.mcap ] || "$CONSOLE_BIN/isotherm" import --from tum "$data/furnace_dev" -o furnace.mcap
) 9>"$CONSOLE_WORK/lock" || exit $?
cd "$CONSOLE_WORK"
export CONSOLE_BIN CONSOLE_WORK
export CONSOLE_RECORDING="$CONSOLE_WORK/furnace.mcap"
case $test in
  *.test.mjs) exec node --test --test-concurrency=1 --test-reporter=spec "$test" ;;
  *) exec node "$test" ;;
esac
