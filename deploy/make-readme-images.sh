#!/usr/bin/env bash
# Makes every image of README.md and docs/ again, with the programs that are built:
#
#   deploy/make-readme-images.sh           writes docs/images; takes about five minutes on two free cores
#   BIN=DIR deploy/make-readme-images.sh   with the programs in DIR instead of build/release/bin
#
# The simulated scan follows from its seed, so the images change only when the programs do (a few pixels differ, because live
# feedback depends on the moment). Needs more than the build does: deploy/install-deps.sh --images.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=$(realpath "${BIN:-build/release/bin}")
images=$PWD/docs/images
work=out/images
mkdir -p "$images" "$work/model"

say() { printf '== %s\n' "$*"; }
quietly() { "$@" >"$work/log" 2>&1 </dev/null || { cat "$work/log" >&2; return 1; }; }

say "scan of the simulated furnace door, over DDS"
quietly "$bin/isotherm" demo --output "$work/demo" --duration 20

say "the model as it grows"
# The view that shows the whole model, taken from the end of the scan, serves for all.
view=$("$bin/isotherm" render "$work/demo" -o "$work/whole.png" --size 400x340 | sed -n 's/.*--view "\(.*\)"/\1/p')
snapshot() {  # MODEL SECONDS
  quietly "$bin/isotherm" render "$1" -o "$work/model/$2.png" --size 400x340 --scale 30..260 --view "$view"
}
for seconds in 0.5 1 2 3 5 7 10 13 16; do
  deploy/scan_movie.py cut "$work/demo/scan.mcap" "$seconds" "$work/part.mcap"
  # Twice the voxel size: the images are small, and it takes a third of the time.
  quietly "$bin/isotherm" reconstruct "$work/part.mcap" -o "$work/part" --force --voxel 0.004 \
    --initial-pose-from "$work/demo/trajectory.txt"
  snapshot "$work/part" "$seconds"
done
snapshot "$work/demo" 20
deploy/scan_movie.py movie "$work/demo/scan.mcap" "$work/model" "$images/scan.gif"

say "images of the finished model"
render() {  # NAME ARGUMENTS...
  local name=$1
  shift
  quietly "$bin/isotherm" render "$work/demo" -o "$images/$name.png" --size 400x300 "$@"
}
cp "$work/demo/renders/thermal.png" "$images/furnace_door.png"
render isotherms --palette inferno --scale 20..200 --isotherms "60, 100#00ff00, 150"
render bands --bands "150.., 60..70#ff00ff"
render from_the_side --palette iron --unit kelvin --view-from "-0.35 0.2 -0.45" --look-at "0.36 0.42 0.5"
render coverage --layer coverage
du -b "$images"/*
