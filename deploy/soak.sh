#!/usr/bin/env bash
# Runs both daemons for as long as you like over an emulated radio link that loses packets, breaks down, is too narrow,
# and whose ends are killed again and again (three of four grounds find their recording when they are started again); then
# says what is missing (nothing must be) and how much memory has grown.
# Takes root, for network namespaces.
#
#   deploy/soak.sh                  ten minutes, outages of up to a minute
#   deploy/soak.sh 2h               as long (30s, 45m, 2h)
#   deploy/soak.sh 2h --outage 10m  outages of up to ten minutes
#   deploy/soak.sh 2h --only link   nobody is killed: how much memory a long life takes
#   deploy/soak.sh 2h --only kills  the link is as good as it gets: 2 % lost, 20 ms each way
#   deploy/soak.sh 2h --seed 7      other random events; the same seed does the same to the link. The first process of the rig
#                                   has link.policy LOSSLESS with odd seeds and LIVE with even ones; each later one the other
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"; }

# seconds TEXT: of 30s, 45m, 2h or a number.
seconds() {
  [[ $1 =~ ^([0-9]+)([smh]?)$ ]] || { echo "soak: '$1' is no time; 30s, 45m or 2h is" >&2; exit 64; }
  case "${BASH_REMATCH[2]}" in
    m) echo $((BASH_REMATCH[1] * 60)) ;;
    h) echo $((BASH_REMATCH[1] * 3600)) ;;
    *) echo "${BASH_REMATCH[1]}" ;;
  esac
}

duration=10m
outage=1m
seed=1
only=
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --outage) outage=${2:?"--outage needs a time"}; shift ;;
    --only)
      only=${2:?"--only needs link or kills"}
      [[ $only =~ ^(link|kills)$ ]] || { echo "soak: --only '$only' is neither link nor kills" >&2; exit 64; }
      shift ;;
    --seed) seed=${2:?"--seed needs a number"}; shift ;;
    -*) usage >&2; exit 64 ;;
    *) duration=$1 ;;
  esac
  shift
done
ISOTHERM_SOAK_S=$(seconds "$duration")
ISOTHERM_SOAK_OUTAGE_S=$(seconds "$outage")
ISOTHERM_SOAK_SEED=$seed
ISOTHERM_SOAK_ONLY=$only
export ISOTHERM_SOAK_ONLY ISOTHERM_SOAK_S ISOTHERM_SOAK_OUTAGE_S ISOTHERM_SOAK_SEED

deploy/install-deps.sh
cmake --preset release >/dev/null
cmake --build --preset release --target link_soak_test isotherm isotherm-edge isotherm-ground
exec build/release/tests/system/link_soak_test
