#!/bin/sh
# A run that is killed at any moment (SIGKILL, also while it writes) and resumed again and again ends with the same
# history.csv and the same final state, bit for bit, as one that was left alone; two threads end as one does.
# usage: kill_and_resume.sh DENSIFY SCENE WORK_FOLDER SETTING...     (settings that make a run of a second or two)
set -eu
densify=$1 scene=$2 work=$3
shift 3
settings=
for setting in "$@"; do settings="$settings --set $setting"; done
rm -rf "$work"
mkdir -p "$work"

run() { exec "$densify" run "$scene" $settings --quiet "$@"; }  # in a subshell or behind &

begun=$(date +%s%N)
(run --out "$work/whole")
whole=$((($(date +%s%N) - begun) / 1000000))  # [ms]

threads=1 kills=0
run --out "$work/killed" --threads 1 &
pid=$!
while :; do
  # Kill after 15 to 27 % of what the whole run took, at a moment that differs from round to round: a machine twice as
  # fast by now still leaves time for two.
  wait_ms=$((whole * (15 + 3 * (kills % 5)) / 100))
  sleep "$((wait_ms / 1000)).$(printf %03d $((wait_ms % 1000)))"
  kill -KILL "$pid" 2>/dev/null || true
  if wait "$pid" 2>/dev/null; then break; fi
  kills=$((kills + 1))
  threads=$((3 - threads))
  if [ -f "$work/killed/checkpoint.h5" ]; then
    run --resume --out "$work/killed" --threads "$threads" &
  else
    rm -rf "$work/killed"
    run --out "$work/killed" --threads "$threads" &
  fi
  pid=$!
  if [ "$kills" -ge 12 ]; then
    wait "$pid"
    break
  fi
done
[ "$kills" -ge 2 ] || { echo "the run ended before it could be killed twice: make the scene longer" >&2; exit 1; }

cmp "$work/whole/history.csv" "$work/killed/history.csv"
cmp_state() { /usr/bin/python3 - "$1" "$2" <<'PY'
import sys
try:
    import h5py, numpy
except ImportError:
    sys.exit(0)  # history.csv has been compared; the state needs h5py
a, b = (h5py.File(p, "r") for p in sys.argv[1:3])
names = []
a.visititems(lambda n, o: names.append(n) if isinstance(o, h5py.Dataset) else None)
def same(x, y):  # numbers bit for bit (NaN included), texts by content
    x, y = numpy.asarray(x), numpy.asarray(y)
    return x.tolist() == y.tolist() if x.dtype == object else x.tobytes() == y.tobytes()
different = [n for n in names if not same(a[n][()], b[n][()])]
if not names or different:
    sys.exit(sys.argv[1] + " and the resumed one differ in " + ", ".join(different or ["everything: no datasets"]))
PY
}
cmp_state "$work/whole/checkpoint.h5" "$work/killed/checkpoint.h5"
cmp_state "$work/whole/result.h5" "$work/killed/result.h5"  # snapshots, and the effective input with what was derived
echo "killed $kills times, resumed, identical"
