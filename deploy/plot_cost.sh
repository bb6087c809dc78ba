#!/bin/sh
# Draws what cost_benchmark measured (deploy/bench.sh --plots): one plot for each thing that a frame's cost may grow with.
#
#   deploy/plot_cost.sh RESULTS.tsv FOLDER    lines "cost_benchmark TAB name TAB field TAB value"
set -eu
results=$1
folder=$2
command -v gnuplot >/dev/null || { echo "plot_cost: gnuplot is not installed: deploy/install-deps.sh --images" >&2; exit 69; }
data=$(mktemp -d)
trap 'rm -rf "$data"' EXIT

# table SWEEP X FIELD...: a line per measurement of the sweep, by X, which is a field or what the name says.
table() {
  awk -F'\t' -v sweep="$1" -v x="$2" -v fields="$3" '
    $1 == "cost_benchmark" && index($2, sweep ":") == 1 {
      names[$2] = 1; value[$2, $3] = $4; told[$2] = substr($2, length(sweep) + 2) + 0
    }
    END {
      count = split(fields, field, " ")
      for (name in names) {
        printf "%s", (x == "name" ? told[name] : value[name, x])
        for (i = 1; i <= count; ++i) printf " %s", value[name, field[i]]
        print ""
      }
    }' "$results" | sort -g >"$data/$1"
  [ -s "$data/$1" ] || { echo "plot_cost: $results has nothing of $1" >&2; exit 65; }
}

# plot NAME SWEEP LABEL [SCALE]: times of a depth and a thermal frame, and of a second of both cameras' data.
plot() {
  gnuplot <<GNUPLOT
set terminal svg size 640,400 font "sans,13" background "#ffffff"
set output "$folder/cost_$1.svg"
set xlabel "$3"
set ylabel "frame, ms"
set y2label "a second of data, ms"
set ytics nomirror
set y2tics
set yrange [0:*]
set y2range [0:*]
set grid ytics linecolor "#d0d0d0"
set key above
${4-}
plot "$data/$2" using 1:2 title "depth frame" with linespoints linewidth 2 pointtype 7 linecolor "#1f77b4", \\
     "$data/$2" using 1:3 title "thermal frame" with linespoints linewidth 2 pointtype 5 linecolor "#d62728", \\
     "$data/$2" using 1:4 axes x1y2 title "a second of both (right)" with linespoints dashtype 2 pointtype 6 linecolor "#555555"
GNUPLOT
}

fields="depth_ms thermal_ms second_ms"
table distance_m view_m2 "$fields"
table volume_m name "$fields"
table voxel_mm name "$fields"
table pixels name "$fields"
plot view distance_m "surface in the depth camera's view, m²"
plot volume volume_m "edge of the volume, m" "set logscale x 2"
plot voxel voxel_mm "edge of a voxel, mm"
plot image pixels "pixels of the depth image" "set format x '%.0s %c'"

# Over the minutes of one long scan.
awk -F'\t' '$1 == "cost_benchmark" && index($2, "minutes:") == 1 && $3 ~ /^minute_/ {
  sub(/minute_/, "", $3); print $3 + 0, $4 }' "$results" | sort -g >"$data/minutes"
gnuplot <<GNUPLOT
set terminal svg size 640,400 font "sans,13" background "#ffffff"
set output "$folder/cost_length.svg"
set xlabel "minute of the scan"
set ylabel "a second of both cameras' data, ms"
set yrange [0:*]
set grid ytics linecolor "#d0d0d0"
set key off
plot "$data/minutes" with linespoints linewidth 2 pointtype 7 linecolor "#1f77b4"
GNUPLOT
