#!/bin/sh
# Both programs, the simulated cameras and nothing else on this computer, in real time: does the ground keep up? Once alone, and
# once while another program takes one core half of the time.
#
#   deploy/bench_live.sh [SECONDS]   of each scan, 60 without it
#
# Prints one table: processor time for each second of data, what was left out, how long frames waited, how old advice was. All
# that the programs said is kept in build/release/bench. Takes stress-ng (deploy/install-deps.sh --images).
set -eu

case "${1-}" in
  -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
esac
seconds=${1:-60}
case "$seconds" in
  '' | *[!0-9]*) echo "usage: deploy/bench_live.sh [SECONDS], a whole number" >&2; exit 64 ;;
esac
[ "$seconds" -ge 10 ] || { echo "bench_live: $seconds s tell nothing; ten or more" >&2; exit 64; }
command -v stress-ng >/dev/null ||
  { echo "bench_live: stress-ng is not installed: deploy/install-deps.sh --images" >&2; exit 69; }
cd "$(dirname "$0")/.."
build=build/release
out=$build/bench

say() { printf '== %s\n' "$*" >&2; }

say "build (release)"
[ -f "$build/build.ninja" ] || cmake --preset release >/dev/null
NINJA_STATUS="[%f/%t %es] " cmake --build "$build" --target programs >&2
mkdir -p "$out"

# A JSON file, two spaces a level, as lines "path.to.key value".
flatten() {
  awk '{
    level = int(match($0, /[^ ]/) / 2)
    if (!match($0, /"[^"]*": /)) next
    key[level] = substr($0, RSTART + 1, RLENGTH - 4)
    value = substr($0, RSTART + RLENGTH)
    sub(/,$/, "", value)
    if (value == "{" || value == "[") next
    path = key[1]
    for (i = 2; i <= level; ++i) path = path "." key[i]
    print path, value
  }' "$1"
}

# run NAME: one scan, its figures into live_NAME.txt.
run() {
  say "$1, $seconds s"
  rm -rf "$out/live_$1"
  "$build/bin/isotherm" demo --headless --rate 1 --duration "$seconds" --output "$out/live_$1" >"$out/live_$1.log" 2>&1 ||
    { tail -n 20 "$out/live_$1.log" >&2; exit 70; }
  flatten "$out/live_$1/stats.json" >"$out/live_$1.txt"
  # "processor 4.5 s, 0.15 of a core: ..."
  sed -n 's/.*processor [0-9.]* s, \([0-9.]*\) of a core.*/edge.processor \1/p' "$out/live_$1/edge.log" |
    tail -n 1 >>"$out/live_$1.txt"
}

load=
trap '[ -z "$load" ] || kill "$load" 2>/dev/null || true' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
run alone
stress-ng --cpu 1 --cpu-load 50 --timeout "$((10 * seconds))" --quiet &
load=$!
run beside_load
kill -0 "$load" 2>/dev/null || { echo "bench_live: stress-ng has left: the second scan was not beside a load" >&2; exit 70; }

cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
cat <<TEXT

$(date -u +%Y-%m-%d), commit $(git describe --always --dirty 2>/dev/null || echo unknown), ${cpu:-$(uname -m)}, $(getconf _NPROCESSORS_ONLN) cores, $seconds s in real time
TEXT
awk '
  FNR == 1 { ++run }
  { value[run, $1] = $2 }
  function show(what, unit, key) {
    printf "%-52s %12s %12s %s\n", what, number(value[1, key]), number(value[2, key]), unit
  }
  function number(x) { return x == "" ? "-" : x == int(x) ? sprintf("%d", x) : sprintf("%.2f", x) }
  END {
    printf "\n%-52s %12s %12s\n", "", "alone", "beside load"
    show("processor for each second of data, ground", "core-seconds", "processor.per_second_of_data_s")
    show("processor for each second of data, edge", "core-seconds", "edge.processor")
    show("depth frame, median", "ms", "stages.depth_frame.p50_ms")
    show("thermal frame, median", "ms", "stages.thermal_frame.p50_ms")
    show("depth frames received", "", "frames.depth.in")
    show("  tracked", "", "frames.depth.tracked")
    show("  not integrated to keep up", "", "frames.depth.not_integrated_behind")
    show("thermal frames received", "", "frames.thermal.in")
    show("  left out to keep up", "", "frames.thermal.left_out_by_reason.behind")
    show("  longest time without one for that reason", "s", "frames.thermal.longest_pause_s")
    show("waiting from arrival to its turn, median", "ms", "link.waiting.p50_ms")
    show("waiting from arrival to its turn, 99 %", "ms", "link.waiting.p99_ms")
    show("depth capture to advice on the edge, median", "ms", "link.feedback.latency_p50_ms")
    show("depth capture to advice on the edge, 99 %", "ms", "link.feedback.latency_p99_ms")
  }' "$out/live_alone.txt" "$out/live_beside_load.txt"
