#!/usr/bin/env bash
# `mpirun -n N sheaf render` on this machine alone: the bytes of one process for every number of ranks and mix of
# targets, one line for an error of any rank, and --resume after ranks were killed.
#
#   tests/mpi.sh SHEAF              the command
#
# Needs Open MPI's mpirun and a Sheaf that was built with MPI; else it says so and exits with 77, as a skipped test
# does.
set -euo pipefail
sheaf=$(realpath "$1")
scenes=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../scenes")
scene=$scenes/crystal-ball.json
command -v mpirun >/dev/null || { echo "skipped: no mpirun" >&2; exit 77; }
mpirun --version | grep -q "Open MPI" || { echo "skipped: the mpirun is not Open MPI's" >&2; exit 77; }
"$sheaf" info --json | grep -q '"MPI": true' || { echo "skipped: no MPI in this build" >&2; exit 77; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# More ranks than cores, and root, are a test's alone. No rank may hang.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_btl_vader_single_copy_mechanism=none
mpi() { timeout --kill-after=5 120 mpirun "$@"; }
fail() {
  echo "failed: $1" >&2
  cat ./*.err >&2 2>/dev/null || true
  exit 1
}
same() { cmp "$1" "$2" || fail "$3: other bytes than one process"; }
# Runs mpirun, which is to end with that code and one line of Sheaf's that has this text.
refused() {
  local code=$1 text=$2 found=0
  shift 2
  mpi "$@" 2>refused.err >/dev/null || found=$?
  [[ $found -eq $code ]] || fail "exit code $found where $code was expected: $*"
  grep -qF -- "$text" refused.err || fail "not said: $text"
  [[ $(grep -c '^sheaf: \|^rank \|\.json' refused.err) -eq 1 ]] || fail "more than one line: $*"
}

echo "ranks"
options=(--size 500x333 --spp 4 --aov depth,normal,id --tile-size 16)
"$sheaf" render "$scene" -o one.exr "${options[@]}" --quiet --json=one.json
for n in 1 2 4; do
  mpi -n $n "$sheaf" render "$scene" -o ranks.exr "${options[@]}" --quiet --threads 1 --json=ranks.json
  same ranks.exr one.exr "$n ranks"
  [[ $(grep -c '"idle"' ranks.json) -eq $n ]] || fail "$n ranks in the statistics"
  [[ $(grep -m 1 '"traced"' ranks.json) == "$(grep -m 1 '"traced"' one.json)" ]] || fail "other rays of $n ranks"
done

echo "targets"
mapfile -t targets < <("$sheaf" info --json | tr -d '\n ' | sed 's/.*"usable":\[\([^]]*\)\].*/\1/' | tr -d '"' | tr ',' '\n')
mixed=()
for target in "${targets[@]}"; do
  mixed+=("${mixed[@]+:}" -n 1 "$sheaf" render "$scene" -o mixed.exr "${options[@]}" -q --threads 1 --target "$target" --json=mixed.json)
  [[ $target == scalar ]] || last=$target
done
mpi "${mixed[@]:0}" || fail "ranks of ${targets[*]}"
same mixed.exr one.exr "ranks of ${targets[*]}"
for target in "${targets[@]}"; do
  grep -q "\"target\": \"$target\"" mixed.json || fail "no rank of $target"
done
refused 2 "whose bits differ" -n 1 "$sheaf" render "$scene" -o a.png --precision fast : \
  -n 1 "$sheaf" render "$scene" -o a.png --precision fast --target "$last"

refused 2 "--budget: of one process alone" -n 2 "$sheaf" render "$scene" -o a.png --budget 1

echo "files"
# Rank 1 stands where the scene is not.
mkdir here there
cat >here/ball.obj <<'END'
mtllib ball.mtl
v -1 -1 0
v 1 -1 0
v 0 1 0
vt 0 0
vt 1 0
vt 0 1
usemtl red
f 1/1 2/2 3/3
END
printf 'newmtl red\nKd 1 1 1\nmap_Kd skin.png\n' >here/ball.mtl
"$sheaf" render "$scene" -o here/skin.png --size 16x16 --quiet
(cd here && "$sheaf" render ball.obj -o ../model-one.png --size 300x200 --quiet)
mpi -n 1 --wdir "$PWD/here" "$sheaf" render ball.obj -o "$PWD/model.png" --size 300x200 --quiet : \
  -n 2 --wdir "$PWD/there" "$sheaf" render ball.obj -o "$PWD/model.png" --size 300x200 --quiet
same model.png model-one.png "a model that one rank can read"
# Several pictures, each filtered, of cameras that turn.
turn=(--size 120x90 --spp 2 --turntable 3 --denoise --exposure auto --quiet)
"$sheaf" render "$scene" -o 'turn-one{frame}.png' "${turn[@]}"
mpi -n 2 "$sheaf" render "$scene" -o 'turn{frame}.png' "${turn[@]}"
for i in 0 1 2; do same turn$i.png turn-one$i.png "a turntable"; done

echo "errors"
refused 4 "none.json" -n 3 "$sheaf" render none.json -o a.png
echo '{"objects": 7}' >bad.json
refused 3 "bad.json:1" -n 3 "$sheaf" render bad.json -o a.png
refused 2 "was given other options than rank 0" -n 1 "$sheaf" render "$scene" -o a.png : \
  -n 1 "$sheaf" render "$scene" -o a.png --spp 2
refused 4 "/dev/full" -n 2 "$sheaf" render "$scene" -o /dev/full --format png
refused 2 "rank 1 ($(hostname)): --target: unknown target" -n 1 "$sheaf" render "$scene" -o a.png : -n 1 "$sheaf" render "$scene" -o a.png --target sve9
OMPI_COMM_WORLD_SIZE=3 "$sheaf" render "$scene" -o a.png 2>refused.err && fail "a lone process of three"
grep -q "started as 3 processes" refused.err || fail "a lone process of three is not told"
[[ ! -e a.png ]] || fail "a picture of a run that was refused"

echo "kills"
# Until a run has put at least so many bytes of finished rows on disk: it is then in the midst of its work, however
# long its ranks took to start. A run that has ended is not waited for.
journal=.slow.png.sheaf-journal
halted=
await_journal() {
  for i in $(seq 2400); do
    [[ -s $journal && $(stat -c %s $journal) -gt $1 ]] && return
    kill -0 "$job" 2>/dev/null || break
    # Again and again: mpirun hands on what wakes it, and halted amid a message it would hold up rank 0 too.
    if [[ -n $halted ]]; then
      [[ $((i % 60)) -ne 59 ]] || { kill -CONT "$halted" && sleep 0.2; }
      kill -STOP "$halted"
    fi
    sleep 0.05
  done
  fail "no rows on disk"
}
slow=(--size 512x2048 --spp 36 --threads 1 --quiet --resume)
"$sheaf" render "$scene" -o slow-one.png --size 512x2048 --spp 36 --quiet
for victim in first last all; do
  mpirun -n 3 "$sheaf" render "$scene" -o slow.png "${slow[@]}" 2>killed.err &
  job=$!
  await_journal 1000000
  mapfile -t ranks < <(pgrep -P $job)
  case $victim in
    first) kill -KILL "${ranks[0]}" ;;
    last) kill -KILL "${ranks[-1]}" ;;
    all) kill -KILL $job "${ranks[@]}" ;;
  esac
  timeout 30 tail --pid=$job -f /dev/null || fail "ranks hang after a kill"
  wait $job && fail "a killed run ends well"
  [[ ! -e slow.png ]] || fail "a picture of a killed run"
  for rank in "${ranks[@]}"; do timeout 30 tail --pid="$rank" -f /dev/null || fail "a rank outlives a kill"; done
  mpi -n 2 "$sheaf" render "$scene" -o slow.png "${slow[@]}" --json=slow.json || fail "resumed after a kill"
  grep -q '"resumed_rows"' slow.json || fail "nothing was resumed"
  same slow.png slow-one.png "resumed after a kill ($victim)"
  rm slow.png
done

# One rank stands still in the midst of its work while the others finish theirs; then all are killed. What is rendered
# again is what it had in work, and what they had not yet finished when the journal, of 12 bytes a pixel, had most.
pixels=$((512 * 2048))
for ranks in 1 2; do
  mpirun -n 3 "$sheaf" render "$scene" -o slow.png "${slow[@]}" 2>killed.err &
  job=$!
  await_journal 500000
  mapfile -t children < <(pgrep -P $job)
  halted=${children[-1]}
  await_journal $((pixels * 12 * 95 / 100))
  halted=
  kill -KILL $job "${children[@]}"
  wait $job 2>/dev/null && fail "a killed run ends well"
  for rank in "${children[@]}"; do timeout 30 tail --pid="$rank" -f /dev/null || fail "a rank outlives a kill"; done
  if [[ $ranks -eq 1 ]]; then
    "$sheaf" render "$scene" -o slow.png "${slow[@]}" --json=slow.json || fail "one process goes on after ranks"
  else
    mpi -n $ranks "$sheaf" render "$scene" -o slow.png "${slow[@]}" --json=slow.json || fail "resumed after a kill"
  fi
  same slow.png slow-one.png "goes on after a kill with areas missing ($ranks)"
  again=$(($(grep -m 1 '"primary"' slow.json | tr -dc 0-9) / 36))
  echo "  $again of $pixels pixels are rendered again"
  [[ $again -gt 0 && $again -lt $((pixels / 20)) ]] || fail "$again pixels are rendered again"
  rm slow.png
done

mpirun -n 2 "$sheaf" render "$scene" -o slow.png "${slow[@]}" 2>killed.err &
job=$!
await_journal 100000
kill -INT $job
timeout 30 tail --pid=$job -f /dev/null || fail "ranks hang after SIGINT"
wait $job && fail "an interrupted run ends well"
[[ ! -e slow.png ]] || fail "a picture of an interrupted run"
echo "MPI: ranks, targets, files, errors and kills are as they should be"
