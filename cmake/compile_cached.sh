#!/bin/sh
# compile_cached.sh ROOT RELATIVE CCACHE COMPILER ARGUMENTS...: compiles by ccache with paths below ROOT written relative to the
# build folder, where ninja runs compilers, so that another clone compiles from this one's cache. ccache by itself leaves some
# paths absolute (clang's precompiled header and its list of what sanitizers ignore), and clang writes them into the precompiled
# header, so that no other clone found anything. Macros keep theirs: ISOTHERM_SOURCE_DIR is read at run time.
root=$1 relative=$2 before=
shift 2
for argument; do
  shift
  case "$argument" in
    -D*) ;;
    "$root" | "$root"/* | -I"$root" | -I"$root"/* | *="$root"/*)
      argument=${argument%%"$root"*}$relative${argument#*"$root"} ;;
  esac
  # A precompiled header that is compiled again counts the one before among its inputs, and then differs from any other clone's.
  case "$before $argument" in "-o "*.gch | "-o "*.pch) rm -f "$argument" ;; esac
  before=$argument
  set -- "$@" "$argument"
done
exec "$@"
