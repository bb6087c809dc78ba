#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test that needs no hardware. Works from a fresh clone.
#
#   deploy/test.sh                 release build, all tests
#   deploy/test.sh -L unit         the same build, ctest arguments passed on
#   PRESET=asan deploy/test.sh     another preset of CMakePresets.json (dev, asan, tsan)
#   LABELS="unit lint" deploy/test.sh   builds and runs only the tests with one of these labels
#   STRICT=1 deploy/test.sh        fails if a case is skipped that tests/skips.txt does not list, or if a package without which
#                                  tests would be left out is missing (continuous integration does)
#   UNITY=1 deploy/test.sh         compiles the sources of a library several at once: faster from nothing, slower after a change
#
# Tests on recorded data look for it in $ISOTHERM_DATA_DIR (or ../shared/data) and say so when they skip.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${PRESET:-release}
labels=${LABELS:-}
strict=${STRICT:-0}

say() { printf '== %s\n' "$*"; }

say "packages"
case "$preset" in
  asan | clang) deploy/install-deps.sh --check ;;  # Clang compiles these.
  *) deploy/install-deps.sh ;;
esac

# Formatting of the files being worked on. Other versions of clang-format decide differently, so only the one
# of Debian 12 has a say.
check_format() {
  command -v clang-format >/dev/null || { echo "clang-format is not installed: not checked"; return 0; }
  case "$(clang-format --version)" in
    *"version 14."*) ;;
    *) echo "not clang-format 14: not checked"; return 0 ;;
  esac
  git rev-parse HEAD >/dev/null 2>&1 || { echo "not a git repository: not checked"; return 0; }
  local files
  files=$({ git diff --name-only --diff-filter=d HEAD
            git show --name-only --diff-filter=d --pretty=format: HEAD
            git ls-files --others --exclude-standard; } |
          sort -u | grep -E '\.(h|cc)$' || true)
  [ -z "$files" ] && { echo "no changed source files"; return 0; }
  # shellcheck disable=SC2086
  clang-format --dry-run -Werror $files || { echo "run: clang-format -i" $files >&2; return 1; }
  echo "$(echo "$files" | wc -l) changed files are formatted"
}
say "formatting"
check_format

say "build ($preset)"
cmake --preset "$preset" -DISOTHERM_ALL_TESTS="$strict" -DISOTHERM_UNITY="${UNITY:-0}" >/dev/null
targets=()
for label in $labels; do targets+=(--target "tests_$label"); done
[ -z "$labels" ] || set -- -L "^(${labels// /|})\$" "$@"
NINJA_STATUS="[%f/%t %es] " cmake --build --preset "$preset" "${targets[@]}"

say "tests ($preset)"
log=build/$preset/Testing/ctest.log
mkdir -p "$(dirname "$log")"
status=0
# Two more at a time than there are processors: the longest tests, of which two run at once, wait for time-outs of daemons. The
# summary is held back until the skipped cases have been named.
ctest --preset "$preset" --parallel "$(($(nproc) + 2))" "$@" 2>&1 | tee "$log" |
  sed --unbuffered '/% tests passed/,$d' || status=$?
details=build/$preset/Testing/Temporary/LastTest.log
if [ -f "$details" ] && ! bash tests/skips.sh "$preset" "$log" "$details" && [ "$strict" = 1 ]; then status=1; fi
say "result"
sed -n '/% tests passed/,$p' "$log"
exit "$status"
