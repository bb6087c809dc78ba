#!/bin/sh
# Both programs, the simulated cameras and nothing else on this computer, in real time: does the ground keep up? Once alone, once
# while another program takes one core half of the time, and once while it does so in the middle third of the scan only.
#
#   deploy/bench_live.sh [SECONDS]   of each scan, 60 without it
#
# Prints what was left out, how long frames waited and how old advice was; the processor time of both programs by stage and by
# thread; and how long after the load's end the ground was back at full rate. All that the programs said is kept in
# build/release/bench. Takes stress-ng (deploy/install-deps.sh --images).
set -eu

case "${1-}" in
  -h | --help) sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 0 ;;
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

# start NAME: begins a scan.
start() {
  say "$1, $seconds s"
  rm -rf "$out/live_$1"
  "$build/bin/isotherm" demo --headless --rate 1 --duration "$seconds" --output "$out/live_$1" >"$out/live_$1.log" 2>&1 &
  scan=$!
}
# finish NAME: waits for its end, its figures into live_NAME.txt.
finish() {
  wait "$scan" || { scan=; tail -n 20 "$out/live_$1.log" >&2; exit 70; }
  scan=
  awk -f deploy/flatten_json.awk "$out/live_$1/stats.json" >"$out/live_$1.txt"
  # "processor 4.5 s, 0.15 of a core: codec 0.10, others 0.05; processes of cameras 0.1 s"
  awk '
    /processor [0-9.]+ s, [0-9.]+ of a core/ { line = $0 }
    END {
      if (!sub(/.*processor [0-9.]+ s, /, "", line)) exit
      print "edge.processor", line + 0
      sub(/;.*/, "", line)
      if (!sub(/^[^:]*: /, "", line)) exit
      threads = split(line, thread, ", ")
      for (i = 1; i <= threads; ++i) print "edge.by_thread." thread[i]
    }' "$out/live_$1/edge.log" >>"$out/live_$1.txt"
}
# wait_for_start NAME: until the ground processes its frames.
wait_for_start() {
  until grep -q 'Ground: scan started' "$out/live_$1/ground.log" 2>/dev/null; do
    kill -0 "$scan" 2>/dev/null || break  # finish says why.
    sleep 0.1
  done
}
# start_load SECONDS
start_load() {
  stress-ng --cpu 1 --cpu-load 50 --timeout "$1" --quiet &
  load=$!
}

stop_both() {
  [ -z "$load" ] || kill "$load" 2>/dev/null || true
  [ -z "$scan" ] || kill "$scan" 2>/dev/null || true
}

load=
scan=
trap stop_both EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
start alone
finish alone

start_load "$((10 * seconds))"
start beside_load
finish beside_load
kill "$load" 2>/dev/null || { echo "bench_live: stress-ng has left: the second scan was not beside a load" >&2; exit 70; }
wait "$load" || true
load=

third=$((seconds / 3))
start middle_third
wait_for_start middle_third
sleep "$third"
load_begin=$(date +%s.%N)
start_load "$third"
wait "$load" || { load=; echo "bench_live: stress-ng failed" >&2; exit 70; }
load=
load_end=$(date +%s.%N)
finish middle_third

cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
cat <<TEXT

$(date -u +%Y-%m-%d), commit $(git describe --always --dirty 2>/dev/null || echo unknown), ${cpu:-$(uname -m)}, $(getconf _NPROCESSORS_ONLN) cores, $seconds s in real time
TEXT
awk '
  FNR == 1 { ++run }
  { value[run, $1] = $2 }
  function show(what, unit, key) {
    printf "%-52s %12s %12s %12s %s\n", what, number(value[1, key]), number(value[2, key]), number(value[3, key]), unit
  }
  function number(x) { return x == "" ? "-" : x == int(x) ? sprintf("%d", x) : sprintf("%.2f", x) }
  END {
    printf "\n%-52s %12s %12s %12s\n", "", "alone", "beside load", "middle third"
    show("processor for each second of data, ground", "core-seconds", "processor.per_second_of_data_s")
    show("processor for each second of data, edge", "core-seconds", "edge.processor")
    show("depth frame, median", "ms", "stages.depth_frame.p50_ms")
    show("thermal frame, median", "ms", "stages.thermal_frame.p50_ms")
    show("depth frames received", "", "frames.depth.in")
    show("  tracked", "", "frames.depth.tracked")
    show("  not integrated to keep up", "", "frames.depth.not_integrated_behind")
    show("  not integrated, pose uncertain", "", "frames.depth.not_integrated_uncertain")
    show("thermal frames received", "", "frames.thermal.in")
    show("  left out to keep up", "", "frames.thermal.left_out_by_reason.behind")
    show("  longest time without one for that reason", "s", "frames.thermal.longest_pause_s")
    show("waiting from arrival to its turn, median", "ms", "link.waiting.p50_ms")
    show("waiting from arrival to its turn, 99 %", "ms", "link.waiting.p99_ms")
    show("depth capture to arrival, 99 %", "ms", "link.capture_to_ground.depth.p99_ms")
    show("depth capture to advice on the edge, median", "ms", "link.feedback.latency_p50_ms")
    show("depth capture to advice on the edge, 99 %", "ms", "link.feedback.latency_p99_ms")
  }' "$out/live_alone.txt" "$out/live_beside_load.txt" "$out/live_middle_third.txt"
awk -v columns="alone|beside load|middle third" -f deploy/bench_processor.awk \
  "$out/live_alone.txt" "$out/live_beside_load.txt" "$out/live_middle_third.txt"
awk -v load_begin="$load_begin" -v load_end="$load_end" -f deploy/bench_recovery.awk "$out/live_middle_third.txt"
