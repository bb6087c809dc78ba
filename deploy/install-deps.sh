#!/bin/sh
# Installs the Debian 12 packages that Isotherm is built from and tested with. Needs root or sudo only if
# something is missing; run it as often as you like.
#
#   deploy/install-deps.sh            install what is missing for build and tests
#   deploy/install-deps.sh --build    only what the build and the demo need (Node.js is for tests only)
#   deploy/install-deps.sh --arm64    also a cross compiler, an emulator and, unpacked into build/arm64-sysroot (0.8 GB),
#                                     the arm64 libraries for the preset arm64; this system's libraries stay as they are
#   deploy/install-deps.sh --images   also what deploy/make-readme-images.sh, the plots of deploy/bench.sh and deploy/bench_live.sh need
#   deploy/install-deps.sh --check    also what deploy/check.sh and the presets clang and fuzz need
#   deploy/install-deps.sh --coverage also what the preset coverage needs
#   deploy/install-deps.sh --list     print the packages, install nothing
# Package lists are words on purpose:
# shellcheck disable=SC2086
set -eu

# Compiler, build tools, and what the build reads.
packages="build-essential cmake ninja-build ccache pkg-config git ca-certificates
  cyclonedds-dev cyclonedds-tools
  libeigen3-dev libhwy-dev
  libprotobuf-dev protobuf-compiler
  libexpected-dev libfmt-dev libcli11-dev nlohmann-json3-dev
  libzstd-dev zlib1g-dev libpng-dev libsystemd-dev
  libusb-1.0-0-dev libopenni2-dev
  libboost1.81-dev libssl-dev libmeshoptimizer-dev libqrencode-dev libisal-dev
  libgtest-dev libgmock-dev libbenchmark-dev
  libopencv-core-dev libopencv-imgproc-dev libopencv-calib3d-dev libopencv-features2d-dev libceres-dev"

# Recordings are checked against the format's reference implementation, which is JavaScript. Node.js may come from
# elsewhere (NodeSource's package brings its own npm and conflicts with Debian's).
# Emulated USB devices need umockdev; the units are started by a systemd in a container; sources are formatted by
# clang-format 14.
# The console's page is shown by Debian's Chromium. Nearly two hundred test programs are linked: lld does it in a third of the
# time.
add_test_packages() {
  packages="$packages umockdev libumockdev-dev systemd systemd-container clang-format iproute2 chromium lld"
  # Checks the configurations for it that we ship. Where services run it would take this computer's clock over from
  # another one, so there its test is skipped unless it is installed.
  [ -d /run/systemd/system ] || packages="$packages chrony"
  command -v node >/dev/null 2>&1 || packages="$packages nodejs"
  command -v npm >/dev/null 2>&1 || packages="$packages npm"
}

# What the arm64 preset links against: the libraries from above, and those of C and C++.
sysroot=$(dirname "$0")/../build/arm64-sysroot
unpack_arm64() {
  wanted="libc6-dev libstdc++-12-dev"
  for package in $packages; do
    case "$package" in *-dev) wanted="$wanted $package" ;; esac
  done
  if [ "$(cat "$sysroot/.packages" 2>/dev/null)" = "$wanted" ]; then
    echo "install-deps: the arm64 libraries are there"
    return
  fi
  echo "install-deps: unpacking arm64 libraries"
  rm -rf "$sysroot"
  mkdir -p "$(dirname "$sysroot")"
  mmdebstrap --quiet --architectures=arm64 --variant=extract --include="$wanted" bookworm "$sysroot"
  # Links that start at the root would lead into this system.
  find "$sysroot" -type l -lname '/*' | while read -r link; do
    ln -sfnr "$sysroot$(readlink "$link")" "$link"
  done
  echo "$wanted" >"$sysroot/.packages"
}

arm64=0
case "${1-}" in
  "") add_test_packages ;;
  --build) ;;
  --arm64) arm64=1; add_test_packages; packages="$packages g++-aarch64-linux-gnu qemu-user mmdebstrap" ;;
  --check) add_test_packages; packages="$packages clang-14 clang-tidy-14 libclang-rt-14-dev" ;;
  --coverage) add_test_packages; packages="$packages gcovr" ;;
  --images) packages="$packages python3 python3-pil zstd fonts-dejavu-core gnuplot-nox stress-ng" ;;
  --list) add_test_packages; for package in $packages; do echo "$package"; done; exit 0 ;;
  *) echo "usage: deploy/install-deps.sh [--build | --arm64 | --images | --check | --coverage | --list]" >&2; exit 64 ;;
esac

if ! command -v apt-get >/dev/null 2>&1; then
  echo "install-deps: this is not a Debian system (no apt-get). Install the equivalents of:" $packages >&2
  exit 69
fi

missing=""
for package in $packages; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing="$missing $package"
done

install_missing() {
  sudo=""
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
      echo "install-deps: missing:$missing" >&2
      echo "install-deps: run it as root or install sudo" >&2
      exit 69
    fi
    sudo="sudo"
  fi
  # Waits for another apt to finish instead of failing. Lists that cannot be refreshed (no network, a foreign
  # repository that is down) are no reason to stop: what is needed may be known already.
  apt="$sudo env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=500"
  echo "install-deps: installing$missing"
  $apt update || echo "install-deps: package lists could not be refreshed; going on with what is known"
  $apt install -y --no-install-recommends $missing
  echo "install-deps: done"
}

if [ -z "$missing" ]; then
  echo "install-deps: all packages are installed"
else
  install_missing
fi
[ "$arm64" = 0 ] || unpack_arm64
