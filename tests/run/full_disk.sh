#!/bin/sh
# A disk that fills up while any of the files is written: exit code 4, a message that names the file, and with space
# again --resume (or a new start, before the first checkpoint) ends bit for bit as an undisturbed run.
# usage: full_disk.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
cp "$scenes/lattice.toml" "$scenes/lattice.csv" .

run_code run lattice.toml --quiet --out whole
[ "$code" -eq 0 ] || fail "the lattice: $(cat "$err")"

# go_on NAME FOLDER: takes the run up again, after a failure whose message is in $err.
go_on() {
  [ "$code" -eq 4 ] || fail "$1: exit code $code: $(cat "$err")"
  [ "$(wc -l <"$err")" -eq 1 ] || fail "$1: not one line of errors: $(cat "$err")"
  grep -q "$2/.*: cannot write this file (.*); free some space" "$err" || fail "$1: $(cat "$err")"
  sed "s|^densify: $2/\([a-z]*\).*|\1|" "$err" >>"$work.log/named"
  if [ -f "$2/checkpoint.h5" ]; then resume=--resume; else resume=; fi
  run_code run lattice.toml --quiet --out "$2" $resume
  [ "$code" -eq 0 ] || fail "$1: goes not on: $(cat "$err")"
  same_end whole "$2"
  [ "$(cd "$2" && find . | sort)" = "$(cd whole && find . | sort)" ] || fail "$1: other files than of a whole run"
}

# The largest file that may be written, in blocks of 512 bytes: each stops the run somewhere else.
for blocks in 1 16 50 78 100 300 700; do
  rm -rf limited
  code=0
  (ulimit -f "$blocks"; exec "$densify" run lattice.toml --quiet --out limited 2>"$err") || code=$?
  go_on "at most $blocks blocks a file" limited
done

# A real file system that is full; needs the right to mount one.
mkdir -p small
for size in 64k 300k 500k; do
  if [ "$(id -u)" -eq 0 ] && mount -t tmpfs -o size=$size densify_test small 2>/dev/null; then
    trap 'umount small 2>/dev/null || true' EXIT
    code=0
    "$densify" run lattice.toml --quiet --out small/run 2>"$err" || code=$?
    mount -o remount,size=4m small
    go_on "a disk of $size" small/run
    umount small
    trap - EXIT
  fi
done
for file in specimen history checkpoint result; do
  grep -qx "$file" "$work.log/named" || fail "no run was stopped at $file"
done
finish
