#!/bin/sh
# kernels.sh NAME OBJECT...: what the contact kernels of instruction set NAME define for the linker lies in its own
# namespace.  A function of a shared header that the linker may merge would run everywhere with these instructions, and
# end the program on a processor that lacks them.
set -eu
name=$1
shift
found=$(nm --defined-only -C "$@" | grep -E ' [TWVuBDR] ' || true)
[ -n "$found" ] || { echo "no symbols in $*"; exit 1; }
if echo "$found" | grep -v "densify::dem::$name::"; then
  echo "these symbols are outside of densify::dem::$name"
  exit 1
fi
