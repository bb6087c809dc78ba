#!/usr/bin/env bash
# Builds the console's page from ground/console/web/src into ground/console/web/dist, which is committed
# (docs/adr/0015-the-built-page-is-in-the-repository.md). Checks types and lints first.
#
#   deploy/build-page.sh             build
#   deploy/build-page.sh --compare   build elsewhere and compare with what is committed; exit status 1 if it differs, 77 if
#                                    node, npm, protoc or the packages are not available
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
web=$root/ground/console/web
compare=0
[ "${1-}" = --compare ] && compare=1
work=${PAGE_WORK:-$root/build/page}

skip() { echo "SKIPPED: $1"; exit 77; }
for tool in node npm protoc; do
  command -v "$tool" >/dev/null || skip "$tool is not installed"
done

# The packages are installed beside a copy, so that the source tree stays as it is.
mkdir -p "$work"
cp "$web"/package.json "$web"/package-lock.json "$web"/*.mjs "$web"/tsconfig.json "$work"
rm -rf "$work/src"
cp -r "$web/src" "$work/src"
cd "$work"
if ! cmp -s package-lock.json installed-lock.json; then
  rm -f installed-lock.json
  npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 >npm.log 2>&1 || { cat npm.log; skip "npm ci failed: no registry?"; }
  cp package-lock.json installed-lock.json
fi
node build.mjs --out "$work/dist" --root "$root"
npx --no-install tsc --noEmit
npx --no-install eslint src

if [ "$compare" = 1 ]; then
  diff -rq "$work/dist" "$web/dist" || { echo "build-page: what is committed differs from what is built; deploy/build-page.sh makes it anew"; exit 1; }
  echo "build-page: what is committed is what is built"
else
  rm -rf "$web/dist"
  cp -r "$work/dist" "$web/dist"
  du -ch "$web"/dist/*.js "$web"/dist/*.css "$web"/dist/*.html | tail -n 1 | sed 's/^/build-page: /'
fi
