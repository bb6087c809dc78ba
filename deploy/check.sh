#!/usr/bin/env bash
# Checks sources without running them: formatting (clang-format), names and what finds bugs (clang-tidy), and that what a mutex
# guards is used only with it held (clang's thread-safety analysis).
#
#   deploy/check.sh                 what was changed since the last version: its tag or, without one, the commit that set it in
#                                   the root's CMakeLists.txt
#   deploy/check.sh FILE...         these files
#   deploy/check.sh --since COMMIT  what was changed since then
#   deploy/check.sh --quick         the same without the thread-safety analysis, which compiling with the preset asan does, too.
#                                   clang-tidy begins with what was changed last and leaves out what it has found clean before
#                                   ($ISOTHERM_CHECK_CACHE); after $ISOTHERM_TIDY_MINUTES it stops and says how many are left
#   deploy/check.sh --list          the files that it would look at, the newest change first
#   deploy/check.sh --threads       only the thread-safety analysis, which always covers every source that names a mutex
#
# Needs clang-14 and clang-tidy-14 (deploy/install-deps.sh --check). Nothing but the generated headers is built (build/clang).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
tree=build/clang
status=0

say() { printf '== %s\n' "$*"; }

last_version() {
  git describe --tags --abbrev=0 2>/dev/null && return
  local commit
  commit=$(git log -1 --format=%H -G'^project\(isotherm VERSION' -- CMakeLists.txt 2>/dev/null || true)
  # Of a history that is cut off, the oldest commit there is seems to have set everything.
  [ "$(git rev-parse --is-shallow-repository 2>/dev/null)" != true ] || commit=
  [ -n "$commit" ] && echo "$commit" || git hash-object -t tree /dev/null
}
changed_since() {
  local still_there
  still_there=$({ git diff --name-only --diff-filter=d "$1"; git ls-files --others --exclude-standard; } | sort -u)
  # Uncommitted first, then commit by commit; from an empty tree, as they come.
  { git diff --name-only HEAD; git ls-files --others --exclude-standard
    git log --format= --name-only "$1..HEAD" 2>/dev/null || true; echo "$still_there"; } |
    awk '!seen[$0]++' | grep -E '\.(h|cc)$' | grep -xFf <(echo "$still_there") || true
}

files=()
threads=1
deadline=0
cache=
if [ "${1-}" = --quick ]; then
  threads=0
  cache=${ISOTHERM_CHECK_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/isotherm-check}
  mkdir -p "$cache"
  [ -z "${ISOTHERM_TIDY_MINUTES-}" ] || deadline=$(($(date +%s) + 60 * ISOTHERM_TIDY_MINUTES))
  shift
fi
case "${1-}" in
  --threads) ;;
  --list) changed_since "$(last_version)"; exit 0 ;;
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

# Checks one source, unless it has been found clean as it is, with its header and by the same rules, or the time is over.
tidy_one() {
  local source=$1 mark=
  shift
  if [ -n "$cache" ]; then
    mark=$cache/$(cat "$source" "${source%.cc}.h" .clang-tidy 2>/dev/null | sha256sum | cut -d' ' -f1)
    [ ! -e "$mark" ] || return 0
  fi
  if [ "$deadline" != 0 ] && [ "$(date +%s)" -ge "$deadline" ]; then echo "$source" >>"$left"; return 0; fi
  clang-tidy-14 --quiet -p "$tree" "$@" "$source" || return 1
  [ -z "$mark" ] || : >"$mark"
}
left=$(mktemp)
trap 'rm -f "$left"' EXIT
export -f tidy_one
export tree cache deadline left

# Reads sources, one a line, and checks those that are compiled; a header is checked by way of its own source.
tidy() {
  { grep -xFf <(echo "$compiled") || true; } | awk '!seen[$0]++' |
    nice xargs -r -P "$(nproc)" -I SOURCE bash -c 'tidy_one "$@"' tidy SOURCE "$@" 2> >(
    grep -vE '^[0-9]+ warnings? (generated|treated)|^Suppressed|^Use -header-filter' >&2 || true)
}

if [ "${#files[@]}" -gt 0 ]; then
  say "formatting, ${#files[@]} files"
  clang-format --dry-run -Werror "${files[@]}" || status=1
  say "clang-tidy"
  printf '%s\n' "${files[@]}" | sed -E 's|^\./||; s|\.h$|.cc|' | tidy || status=1
  [ ! -s "$left" ] || echo "clang-tidy: the time is over, $(wc -l <"$left") older changes were not looked at"
fi

if [ "$threads" = 1 ]; then
  say "what mutexes guard"
  # Sources that use a mutex; of a header its own source. Half of all sources include such a header by way of others.
  git grep --untracked -lE 'MutexLock|GUARDED_BY|REQUIRES\(' -- '*.h' '*.cc' | sed -E 's|\.h$|.cc|' |
    tidy --checks='-*,misc-definitions-in-headers,clang-diagnostic-thread-safety*' || status=1
fi

[ "$status" = 0 ] && say "all is well" || say "see above"
exit "$status"
