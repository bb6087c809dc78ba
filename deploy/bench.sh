#!/bin/sh
# Builds the benchmarks, runs them all and prints one table: median, what it is compared with, and the ratio.
#
#   deploy/bench.sh                 codecs, kernels and the whole line; Open3D beside it where libopen3d-dev is installed
#   deploy/bench.sh SCAN            also `isotherm reconstruct`, with its processor time by stage and thread, and Open3D on a
#                                   recording (.mcap) or a dataset folder
#   deploy/bench.sh SCAN "X Y Z"    the same in a volume with this corner, metres in the world of the scan's ground
#                                   truth, which then gives the first pose
#   deploy/bench.sh --plots         only what a frame costs against each thing that it may grow with, drawn into docs/images
#                                   (takes gnuplot: deploy/install-deps.sh --images), a quarter of an hour
#
# A table is a measurement only on a machine that does nothing else: it says how busy the machine was before, and which
# fraction of the cores others took meanwhile. Codecs are measured on the data in $ISOTHERM_DATA_DIR (or ../shared/data).
# All that the programs said is kept in build/release/bench.
set -eu

plots=0
case "${1-}" in
  -h | --help) sed -n '2,14s/^# \{0,1\}//p' "$0"; exit 0 ;;
  --plots) plots=1; shift; [ $# = 0 ] || { echo "bench: --plots takes no scan" >&2; exit 64; } ;;
  -*) echo "usage: deploy/bench.sh [--plots | SCAN [\"X Y Z\"]]" >&2; exit 64 ;;
esac
scan=${1-}
volume_min=${2-}
if [ -n "$scan" ]; then
  [ -e "$scan" ] || { echo "bench: $scan: there is no such file or folder" >&2; exit 66; }
  scan=$(cd "$(dirname "$scan")" && pwd)/$(basename "$scan")
fi
cd "$(dirname "$0")/.."
build=build/release
out=$build/bench

say() { printf '== %s\n' "$*" >&2; }

say "build (release)"
cmake --preset release >/dev/null
targets="codec_benchmark kernel_benchmark pipeline_benchmark growth_benchmark isotherm"
[ "$plots" = 0 ] || targets=cost_benchmark
if [ "$plots" = 1 ]; then
  command -v gnuplot >/dev/null || { echo "bench: gnuplot is not installed: deploy/install-deps.sh --images" >&2; exit 69; }
elif cmake --build "$build" --target help | grep -q '^open3d_benchmark:'; then
  targets="$targets open3d_benchmark"
else
  echo "Open3D is not installed (libopen3d-dev): left out" >&2
fi
# shellcheck disable=SC2086
NINJA_STATUS="[%f/%t %es] " cmake --build "$build" --target $targets >&2
mkdir -p "$out"
rm -f "$out"/*.json "$out"/*.txt "$out"/*.tsv

# Seconds that all cores were busy, and that our programs ran, since some start.
busy_s() { awk -v hz="$(getconf CLK_TCK)" '/^cpu / { print ($2 + $3 + $4 + $7 + $8 + $9) / hz }' /proc/stat; }
own_s() {
  times >"$out/times.txt"  # Not in a subshell, which would start from 0.
  awk '{ for (i = 1; i <= NF; ++i) { split($i, t, /[ms]/); s += 60 * t[1] + t[2] } } END { print s }' "$out/times.txt"
}
cores=$(getconf _NPROCESSORS_ONLN)
load_before=$(cut -d' ' -f1-3 /proc/loadavg)
busy_before=$(busy_s)
own_s >"$out/own_before.txt"
start=$(date +%s)

# Google Benchmark's report as lines "program TAB name TAB field TAB value": medians, or the only run.
medians() {
  awk -v program="$1" '
    /"name":/ { name = $2; gsub(/[",]/, "", name); median = 0 }
    /"run_type": "iteration"/ || /"aggregate_name": "median"/ { median = 1 }
    /^ *"[a-z0-9_]+": [-+.0-9e]+,?$/ {
      key = $1; value = $2; gsub(/[":]/, "", key); sub(/,/, "", value); fields[key] = value
    }
    /^    }/ {
      sub(/\/(min_time|iterations|real_time).*/, "", name)
      if (median) for (key in fields) print program "\t" name "\t" key "\t" fields[key]
      split("", fields)
    }' "$out/$1.json" >>"$out/results.tsv"
}
run_benchmark() {
  program=$1; folder=$2; shift 2
  say "$program"
  "$build/$folder/$program" --benchmark_out="$out/$program.json" --benchmark_out_format=json "$@" \
    >"$out/$program.txt" 2>&1 || { cat "$out/$program.txt" >&2; exit 70; }
  medians "$program"
}
run_open3d() {
  say "open3d_benchmark $*"
  "$build/tests/benchmark/open3d_benchmark" "$@" >"$out/open3d.txt" || exit 70
  cat "$out/open3d.txt" >&2
  awk '/^median ms/ { inside = 1; next } NF == 0 { inside = 0 }
    inside { name = $0; sub(/ +[.0-9]+ +[.0-9]+ +[.0-9]+ *$/, "", name)
             print "open3d\t" name "\t" $(NF - 2) "\t" $(NF - 1) }' "$out/open3d.txt" >>"$out/results.tsv"
}
run_reconstruct() {
  recording=$scan
  if [ -d "$scan" ]; then
    recording=$out/scan.mcap
    say "import"
    "$build/bin/isotherm" import "$scan" -o "$recording" --force >"$out/import.txt" 2>&1 ||
      { cat "$out/import.txt" >&2; exit 70; }
  fi
  say "isotherm reconstruct"
  "$build/bin/isotherm" reconstruct "$recording" -o "$out/scan" --force \
    ${volume_min:+--volume-min "$volume_min" --initial-pose-from "$recording"} \
    >"$out/reconstruct.txt" 2>"$out/progress.txt" || { tail -n 1 "$out/progress.txt" >&2; exit 70; }
  cat "$out/reconstruct.txt" >&2
  awk '/^  "stages"/ { inside = 1 } /^  }/ { inside = 0 }
    inside && /: {$/ { stage = $1; gsub(/[":]/, "", stage) }
    inside && /_ms"/ { key = $1; value = $2; gsub(/[":]/, "", key); sub(/,/, "", value)
                       print "reconstruct\t" stage "\t" key "\t" value }' "$out/scan/stats.json" >>"$out/results.tsv"
}

: >"$out/results.tsv"
if [ "$plots" = 1 ]; then
  run_benchmark cost_benchmark tests/benchmark
else
  run_benchmark codec_benchmark tests/benchmark '--benchmark_filter=/(isotherm|png_1)/'
  run_benchmark kernel_benchmark tests/benchmark --benchmark_enable_random_interleaving=true
  run_benchmark pipeline_benchmark tests/benchmark '--benchmark_filter=voxel_mm:2/'
  run_benchmark growth_benchmark tests/benchmark
fi
[ -z "$scan" ] || run_reconstruct
case "$targets" in
  *open3d*) run_open3d ${scan:+"$scan"} ${volume_min:+--volume-min "$volume_min"} ;;
esac

seconds=$(($(date +%s) - start))
own_s >"$out/own_after.txt"
others=$(awk -v all="$(busy_s)" -v before="$busy_before" -v own="$(cat "$out/own_after.txt")" \
  -v own_before="$(cat "$out/own_before.txt")" -v s="$seconds" -v cores="$cores" \
  'BEGIN { fraction = 100 * (all - before - own + own_before) / (s * cores); printf "%.0f", (fraction > 0 ? fraction : 0) }')
simd=
[ "$plots" = 1 ] || simd=$(sed -n 's/.*"machine": ".*SIMD \([A-Z0-9_]*\)".*/\1/p' "$out/kernel_benchmark.json")
cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
commit=$(git describe --always --dirty 2>/dev/null || echo unknown)

cat <<TEXT

$(date -u +%Y-%m-%d), commit $commit, ${cpu:-$(uname -m)}, $cores cores${simd:+, SIMD $simd}
load average before $load_before, after $(cut -d' ' -f1-3 /proc/loadavg); others took $others % of the cores meanwhile

TEXT
if [ "$plots" = 1 ]; then
  cat "$out/cost_benchmark.txt"
else
  awk -v simd="$simd" -f deploy/bench_table.awk "$out/results.tsv"
  if [ -n "$scan" ]; then
    awk -f deploy/flatten_json.awk "$out/scan/stats.json" >"$out/reconstruct_stats.txt"
    awk -v columns=reconstruct -f deploy/bench_processor.awk "$out/reconstruct_stats.txt"
  fi
fi

# Above this the figures tell more about the others.
if [ "$others" -gt 5 ]; then
  printf '\nBUSY: others took %s %% of the cores; do not take these figures for the machine'"'"'s.\n' "$others"
fi
if [ "$plots" = 1 ]; then
  if [ "$others" -gt 5 ]; then
    echo "docs/images stays as it was; to draw them all the same: deploy/plot_cost.sh $out/results.tsv FOLDER"
  else
    deploy/plot_cost.sh "$out/results.tsv" docs/images
  fi
fi
