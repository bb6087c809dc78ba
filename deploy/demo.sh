#!/usr/bin/env bash
# Installs what is missing, builds, and scans a simulated furnace door: the edge daemon and the ground service run
# as two processes over DDS on loopback, and the results land in out/demo. Works from a fresh clone.
#
#   deploy/demo.sh              scan, shown in the console on http://127.0.0.1:8080 while it grows; then say where the results
#                               are, and show them in the console
#   deploy/demo.sh --headless   scan, print a summary, end with exit status 0
#
# Further arguments go to `isotherm demo` (see `isotherm demo --help`).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

headless=0
arguments=()
for argument in "$@"; do
  case "$argument" in
    --headless) headless=1 ;;
    -h | --help) sed -n '2,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) arguments+=("$argument") ;;
  esac
done

say() { printf '== %s\n' "$*"; }

say "packages"
deploy/install-deps.sh --build

say "build"
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
NINJA_STATUS="[%f/%t %es] " cmake --build --preset release --target programs

# A browser if there is a display; the address is said in any case.
has_display=0
[ -n "${DISPLAY-}${WAYLAND_DISPLAY-}" ] && command -v xdg-open >/dev/null && has_display=1
if [ "$headless" = 0 ]; then
  say "the console shows the scan while it grows: http://127.0.0.1:8080"
  # It answers as soon as the scan begins.
  [ "$has_display" = 0 ] || (for _ in $(seq 600); do
    (exec 3<>/dev/tcp/127.0.0.1/8080) 2>/dev/null && { xdg-open http://127.0.0.1:8080 >/dev/null 2>&1; break; }
    sleep 0.5
  done) &
fi

say "scan of a simulated furnace door, edge and ground over DDS on loopback"
build/release/bin/isotherm demo --output out/demo "${arguments[@]}"

if [ "$headless" = 0 ]; then
  say "results in out/demo"
  cat <<TEXT
  cloud.ply   points with temperature and measurement classes: open in CloudCompare or MeshLab
  mesh.ply    the same as a triangle mesh
  renders/    renderings: temperature, measurement classes, coverage
  stats.json  what was measured and how long it took
  scan.mcap   the scan itself, to reconstruct again
Further renderings:   build/release/bin/isotherm render out/demo -o IMAGE.png --size 800x600
TEXT
fi

# What an inspector would take home, in the words of the ground service.
covered=$(sed -n 's/^surface .* points, \(.*\) with a temperature.*/\1/p' out/demo/ground.log | tail -n 1)
next=$(sed -n 's/^next  *//p' out/demo/ground.log | tail -n 1)
if [ -n "$covered" ] && [ -n "$next" ]; then
  say "in a sentence"
  echo "Of the scanned surface $covered has a temperature; $next."
fi

# The tool is not on the PATH, and nobody should have to look for it.
say "the tool"
echo "$PWD/build/release/bin/isotherm --help"
echo "export PATH=\"$PWD/build/release/bin:\$PATH\"     # then: isotherm --help"

if [ "$headless" = 0 ]; then
  say "the result in the console, to look at and to measure on"
  echo "build/release/bin/isotherm view out/demo"
  [ "$has_display" = 0 ] || exec build/release/bin/isotherm view out/demo
fi
