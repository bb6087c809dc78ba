#!/usr/bin/env bash
# Checks sources without running them: formatting (clang-format), names and what finds bugs (clang-tidy), and that what a mutex
# guards is used only with it held (clang's thread-safety analysis).
#
#   deploy/check.sh                 what was changed since the last version tag, if there is none by the last commit
#   deploy/check.sh FILE...         these files
#   deploy/check.sh --since COMMIT  what was changed since then
#   deploy/check.sh --quick         the same without the thread-safety analysis, which compiling with the preset asan does, too
#   deploy/check.sh --threads       only the thread-safety analysis, which always covers every source that names a mutex
#
# Needs clang-14 and clang-tidy-14 (deploy/install-deps.sh --check). Nothing but the generated headers is built (build/clang).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
tree=build/clang
status=0

say() { printf '== %s\n' "$*"; }

last_version() {
  git describe --tags --abbrev=0 2>/dev/null || git rev-parse HEAD~1 2>/dev/null || git hash-object -t tree /dev/null
}
changed_since() {
  { git diff --name-only --diff-filter=d "$1"; git ls-files --others --exclude-standard; } |
    sort -u | grep -E '\.(h|cc)$' || true
}

files=()
threads=1
if [ "${1-}" = --quick ]; then threads=0; shift; fi
case "${1-}" in
  --threads) ;;
  --since) mapfile -t files < <(changed_since "${2:?--since needs a commit}") ;;
  "") since=$(last_version); echo "changed since $since"; mapfile -t files < <(changed_since "$since") ;;
  -*) sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 64 ;;
  *) files=("$@") ;;
esac

for tool in clang++-14 clang-tidy-14 clang-format; do
  command -v "$tool" >/dev/null || { echo "$tool is missing: deploy/install-deps.sh --check" >&2; exit 69; }
done

say "generated headers ($tree)"
cmake --preset clang >/dev/null
mapfile -t headers < <(ninja -C "$tree" -t targets rule CUSTOM_COMMAND | grep -E '\.h$')
ninja -C "$tree" "${headers[@]}" | tail -1

# Sources that the build compiles: clang-tidy would guess how to compile others.
compiled=$(grep -oE '"file": "[^"]+"' "$tree/compile_commands.json" | cut -d'"' -f4 | sed "s|^$PWD/||" | sort -u)

# Reads sources, one a line, and checks those that are compiled; a header is checked by way of its own source.
tidy() {
  { grep -xFf <(echo "$compiled") || true; } | sort -u | nice xargs -r -P "$(nproc)" -n 1 clang-tidy-14 --quiet -p "$tree" "$@" 2> >(
    grep -vE '^[0-9]+ warnings? (generated|treated)|^Suppressed|^Use -header-filter' >&2 || true)
}

if [ "${#files[@]}" -gt 0 ]; then
  say "formatting, ${#files[@]} files"
  clang-format --dry-run -Werror "${files[@]}" || status=1
  say "clang-tidy"
  printf '%s\n' "${files[@]}" | sed -E 's|^\./||; s|\.h$|.cc|' | tidy || status=1
fi

if [ "$threads" = 1 ]; then
  say "what mutexes guard"
  # Sources that use a mutex; of a header its own source. Half of all sources include such a header by way of others.
  git grep --untracked -lE 'MutexLock|GUARDED_BY|REQUIRES\(' -- '*.h' '*.cc' | sed -E 's|\.h$|.cc|' |
    tidy --checks='-*,misc-definitions-in-headers,clang-diagnostic-thread-safety*' || status=1
fi

[ "$status" = 0 ] && say "all is well" || say "see above"
exit "$status"
