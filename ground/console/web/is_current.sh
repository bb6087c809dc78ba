#!/bin/sh
# Says whether dist was built from the sources that are here, without Node.js. Exit status 1 if not.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
root=$here/../../..
failed=0
while read -r hash name; do
  case $name in
    ground/*) path=$root/$name ;;
    *) path=$here/$name ;;
  esac
  if [ "$(sha256sum <"$path" | cut -d ' ' -f 1)" != "$hash" ]; then
    echo "$name is newer than the built page"
    failed=1
  fi
done <"$here/dist/sources.sha256"
for path in "$here"/src/*; do
  name=src/$(basename "$path")
  [ "$name" = src/gen ] || grep -q "  $name\$" "$here/dist/sources.sha256" || { echo "$name is not in the built page"; failed=1; }
done
[ "$failed" = 0 ] || echo "deploy/build-page.sh builds the page anew; commit what it writes"
exit "$failed"
