#!/usr/bin/env bash
# From a bare Debian 12 to a parameter table and a running daemon.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

usage() {
  cat <<'TXT'
Usage: ./deploy/quickstart.sh [options]

Installs what is missing, builds driftlab, starts the daemon, characterises a recording, prints the parameter table and
the address, and serves until Ctrl-C. Without --recording the sample is used: the z gyroscope of an iPhone 5S at rest and
at 9 deg/s, simulated by driftlab itself from published figures.

  --once               stop after the table
  --recording FILE     characterise this recording (CSV or .npy, also .gz .xz .zst) instead of the sample
  --rate-hz R          sampling rate in Hz; needed unless the recording has a time column
  --columns C          meaning of columns, e.g. gz=angular_rate:z:deg/s,gx=angular_rate:x:deg/s
  --condition C        dynamic condition, e.g. static or constant_rate:z:9:deg/s (default static)
  --device NAME        device the recording belongs to (default: the file's name)
  --port N             port on 127.0.0.1 (default 8477)
  --data DIR           where the daemon keeps its data (default: ~/.local/share/driftlab)
  --bin DIR            use the driftlab and driftlabd in DIR; install and build nothing
  --help               this text
TXT
}

say() { printf '%s\n' "$*"; }
fail() { printf 'quickstart: %s\n' "$*" >&2; exit "${code:-1}"; }
misuse() { code=2 fail "$* (--help lists the options)"; }

once=no recording='' rate_hz='' columns='' condition='' device='' port=8477 data='' bin=''
while [ $# -gt 0 ]; do
  case "$1" in
    --once) once=yes ;;
    --help | -h) usage; exit 0 ;;
    --recording | --rate-hz | --columns | --condition | --device | --port | --data | --bin)
      [ $# -ge 2 ] || misuse "$1 needs a value"
      case "$1" in
        --recording) recording=$2 ;; --rate-hz) rate_hz=$2 ;; --columns) columns=$2 ;; --condition) condition=$2 ;;
        --device) device=$2 ;; --port) port=$2 ;; --data) data=$2 ;; --bin) bin=$2 ;;
      esac
      shift ;;
    *) misuse "unknown option '$1'" ;;
  esac
  shift
done
if ! [[ "$port" =~ ^[0-9]{1,5}$ ]] || [ "$port" -lt 1 ] || [ "$port" -gt 65535 ]; then
  misuse "--port $port is no port number"
fi
if [ -n "$recording" ]; then
  [ -r "$recording" ] || misuse "cannot read the recording $recording"
elif [ -n "$rate_hz$columns$condition$device" ]; then
  misuse "--rate-hz, --columns, --condition and --device describe a --recording; none is given"
fi
data=${data:-${XDG_DATA_HOME:-${HOME:-/tmp}/.local/share}/driftlab}
logs=$repository/build/logs
[ -z "$bin" ] || logs=$data/logs
mkdir -p "$data" "$logs" || fail "cannot make the directories $data and $logs"

# Asked before the long part, and again before the daemon starts.
require_free_port() {
  if (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then
    fail "port $port is taken by another server; choose one with --port"
  fi
}
require_free_port

# --- install and build ------------------------------------------------------------------------------------------------
if [ -z "$bin" ]; then
  # shellcheck source=deploy/packages.sh
  . "$repository/deploy/packages.sh"
  install_packages "$logs/apt.log" build dashboard || exit 1
  build=$repository/build/release
  left="the build in $build with the Debian packages that it needs"
  # A tree that is configured, with the suites perhaps, stays as it is.
  [ -f "$build/CMakeCache.txt" ] || (cd "$repository" && cmake --preset release) >"$logs/configure.log" 2>&1 ||
    { tail -n 20 "$logs/configure.log" >&2; fail "configuring failed; the whole output is in $logs/configure.log"; }
  # Said only where there is something to wait for.
  (sleep 3 >/dev/null 2>&1 && say "Building driftlab (the first time takes some minutes)") &
  notice=$!
  if [ -t 1 ] && [ ! -x "$build/bin/driftlabd" ]; then
    NINJA_STATUS='  [%f/%t] ' ninja -C "$build" --quiet driftlab driftlabd || built=no
  else
    # Without a terminal a line a minute: on a slow machine half an hour of silence looks like a hang.
    (while sleep 60 >/dev/null 2>&1; do say "  $(grep -o '^\[[0-9]*/[0-9]*\]' "$logs/build.log" | tail -n 1)"; done) &
    minutes=$!
    ninja -C "$build" driftlab driftlabd >"$logs/build.log" 2>&1 || { built=no; tail -n 40 "$logs/build.log" >&2; }
    kill "$minutes" 2>/dev/null || true
  fi
  kill "$notice" 2>/dev/null || true
  [ -z "${built:-}" ] || fail "the build failed"
  bin=$build/bin
fi
for program in driftlab driftlabd; do
  [ -x "$bin/$program" ] || fail "there is no $program in $bin"
done

# --- daemon -----------------------------------------------------------------------------------------------------------
address=http://127.0.0.1:$port
daemon=''
stop_daemon() {
  if [ -n "$daemon" ]; then
    kill -TERM "$daemon" 2>/dev/null || true
    wait "$daemon" 2>/dev/null || true
    daemon=''
  fi
}
trap stop_daemon EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

ready() { [ "$(curl --silent --output /dev/null --noproxy '*' --max-time 2 --write-out '%{http_code}' "$address/readyz")" = 200 ]; }
require_free_port
"$bin/driftlabd" --data "$data" --listen "127.0.0.1:$port" 2>"$logs/daemon.log" &
daemon=$!
deadline=$((SECONDS + 30))
until ready; do
  if ! kill -0 "$daemon" 2>/dev/null; then
    daemon=''
    tail -n 5 "$logs/daemon.log" >&2
    fail "the daemon stopped; its log is $logs/daemon.log"
  fi
  [ "$SECONDS" -lt "$deadline" ] || fail "the daemon was not ready within 30 s; its log is $logs/daemon.log"
  sleep 0.1
done

# --- characterise -----------------------------------------------------------------------------------------------------
# characterise FILE CONDITION [options]: upload, one job, its table of every channel on standard output.
characterise() {
  local file=$1 in=$2
  shift 2
  "$bin/driftlab" characterise "$file" --server "$address" --device "$device" --condition "$in" "$@"
}

if [ -n "$recording" ]; then
  name=$(basename "$recording")
  device=${device:-${name%%.*}}
  options=()
  [ -z "$rate_hz" ] || options+=(--rate-hz "$rate_hz")
  [ -z "$columns" ] || options+=(--columns "$columns")
  say "Characterising $recording"
  characterise "$recording" "${condition:-static}" "${options[@]}" || fail "the recording could not be characterised"
else
  device=iphone5s-simulated
  say "Characterising the sample: z gyroscope of an iPhone 5S, simulated by driftlab from Radi et al. (2017), Table 4"
  mkdir -p "$data/sample"
  for condition in static constant_rate:z:9:deg/s; do
    file=$data/sample/iphone5s-z-${condition//[^a-z0-9]/-}.csv
    if [ ! -s "$file" ]; then
      "$bin/driftlab" simulate --preset iphone5s-z --condition "$condition" --out "$file.part" || fail "the simulation failed"
      mv "$file.part" "$file"
    fi
    characterise "$file" "$condition" --rate-hz 100 >"$logs/characterise.log" ||
      fail "the sample could not be characterised"
  done
  say ''
  "$bin/driftlab" table --server "$address" --device "$device" --sensor gyroscope --axis z || fail "there is no table"
fi

say ''
if [ "$once" = yes ]; then
  say "Done: the daemon that served at $address is stopped. It leaves its data in $data, logs in $logs and ${left:-the programs in $bin}; nothing else runs or stays."
  exit 0
fi
say "driftlab serves at $address (open it in a browser: the lab's pages) and keeps its data in $data"
trap 'say ""; say "Stopping"; exit 0' INT
say "Ctrl-C stops it."
wait "$daemon" || code=$?
daemon=''
fail "the daemon stopped (exit ${code:-0}); its log is $logs/daemon.log"
