#!/bin/sh
# Draws what isotherm experiment link measured: how a scan fares against lost packets and against the link's rate.
#
#   isotherm experiment link -o out && deploy/plot_link.sh out/link.csv docs/images    takes gnuplot
set -eu
[ $# = 2 ] || { sed -n '2,4s/^# \{0,1\}//p' "$0" >&2; exit 64; }
results=$1
folder=$2
command -v gnuplot >/dev/null || { echo "plot_link: gnuplot is not installed: deploy/install-deps.sh --images" >&2; exit 69; }
data=$(mktemp -d)
trap 'rm -rf "$data"' EXIT

# table NAME POLICY UNIT: what the label says, then the row's values in the order of the columns. Labels that go on behind the
# unit are controls.
table() {
  awk -v policy="$2" -v unit="$3" '
    $0 ~ "^\"" policy ", [0-9]+ " unit "\"," {
      split($0, half, " " unit "\","); sub(/^"[A-Z]+, /, "", half[1])
      gsub(/,/, " ", half[2]); print half[1], half[2] }' "$results" | sort -g >"$data/$1-$2"
  [ -s "$data/$1-$2" ] || { echo "plot_link: $results has no rows \"$2, N $3\"" >&2; exit 65; }
}

# plot NAME UNIT XLABEL: what the ground lacked at most, and how old advice was.
plot() {
  table "$1" LOSSLESS "$2"
  table "$1" LIVE "$2"
  gnuplot <<GNUPLOT
set terminal svg size 900,360 font "sans,13" background "#ffffff"
set output "$folder/link_$1.svg"
set multiplot layout 1,2
set xlabel "$3"
set yrange [0:*]
set grid ytics linecolor "#d0d0d0"
set key above
set ylabel "most that the ground lacked, s"
plot "$data/$1-LOSSLESS" using 1:4 title "LOSSLESS" with linespoints linewidth 2 pointtype 5 linecolor "#d62728", \\
     "$data/$1-LIVE" using 1:4 title "LIVE" with linespoints linewidth 2 pointtype 7 linecolor "#1f77b4"
set logscale y
set yrange [0.05:100]
set ylabel "age of advice on the rig, median, s"
plot "$data/$1-LOSSLESS" using 1:(\$6 / 1000) title "LOSSLESS" with linespoints linewidth 2 pointtype 5 linecolor "#d62728", \\
     "$data/$1-LIVE" using 1:(\$6 / 1000) title "LIVE" with linespoints linewidth 2 pointtype 7 linecolor "#1f77b4"
GNUPLOT
}

plot loss "% lost" "packets lost, %"
plot rate "Mbit/s" "rate of the link, Mbit/s (the cameras take 43)"
