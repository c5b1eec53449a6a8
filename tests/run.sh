#!/usr/bin/env bash
# Every test of driftlab, through ctest.
set -uo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$repository" || exit 1

usage() {
  cat <<'TXT'
Usage: ./tests/run.sh [options]

Installs what is missing, builds the release preset and runs every suite, with 5 s for each fuzz target.

  --only REGEX        run only the tests whose name matches
  --sanitize          also the suites under address, undefined-behaviour and thread sanitizers
  --tidy              also clang-tidy over every source, warnings as errors, and the clang-format check
  --fuzz [SECONDS]    fuzz longer: this long for each target (60 when no number follows), and documents too, whose
                      target needs nearly every library
  --long              also the long simulation suites (label `long`: accuracy and coverage), and their page anew:
                      tests/ACCURACY.md; $DRIFTLAB_ACCURACY_SHARE scales their repetitions
  --help              this text

Recordings that may not be in the repository are looked for in $DRIFTLAB_SHARED (default ../shared); the tests that need
them say what they skip without it. Exit: 0 every test passed, 1 something failed, 2 bad usage.
TXT
}
misuse() { printf 'run.sh: %s (--help lists the options)\n' "$*" >&2; exit 2; }

only='' sanitize=no tidy=no long=no fuzz_seconds=5 fuzz_documents=OFF
while [ $# -gt 0 ]; do
  case "$1" in
    --only) [ $# -ge 2 ] || misuse "--only needs a regular expression"; only=$2; shift ;;
    --sanitize) sanitize=yes ;;
    --tidy) tidy=yes ;;
    --long) long=yes ;;
    --fuzz)
      fuzz_seconds=60 fuzz_documents=ON
      if [[ "${2:-}" =~ ^[0-9]+$ ]]; then fuzz_seconds=$2; shift; fi ;;
    --help | -h) usage; exit 0 ;;
    *) misuse "unknown option '$1'" ;;
  esac
  shift
done

logs=$repository/build/logs
mkdir -p "$logs"
jobs=$(nproc)
# Suites of daemons wait for half of their time: three of them keep two processors busy.
tests_at_once=$((jobs + jobs / 2))
export DRIFTLAB_SHARED=${DRIFTLAB_SHARED:-$repository/../shared}

real_input=
if [ ! -d "$DRIFTLAB_SHARED/data" ]; then
  real_input="SKIPPED: the tests on real recordings, for there is no $DRIFTLAB_SHARED/data; set DRIFTLAB_SHARED"
  printf '%s\n' "$real_input"
fi

summary=()
failed=no
# step NAME COMMAND...: runs it, remembers how it ended and how long it took; a failure does not keep the rest from running.
step() {
  local name=$1 start=$SECONDS outcome=passed
  shift
  printf '\n== %s\n' "$name"
  if ! "$@"; then
    outcome=FAILED
    failed=yes
  fi
  summary+=("$(printf '%-6s %5d s  %s' "$outcome" "$((SECONDS - start))" "$name")")
  [ "$outcome" = passed ]
}

# quietly LOG COMMAND...: output goes to LOG; its end is shown where the command fails.
quietly() {
  local log=$logs/$1
  shift
  "$@" >"$log" 2>&1 || { tail -n 60 "$log"; echo "The whole output is in $log"; return 1; }
}

# build PRESET "TARGET..." [cmake options]
build() {
  local preset=$1 targets
  read -ra targets <<<"$2"
  shift 2
  quietly "configure-$preset.log" cmake --preset "$preset" "$@" &&
    quietly "build-$preset.log" cmake --build --preset "$preset" --parallel "$jobs" --target "${targets[@]}"
}

# run_tests NAME ctest-options...: the tests of build/NAME
run_tests() {
  local name=$1
  shift
  ctest --test-dir "build/$name" --output-on-failure --no-tests=error --parallel "$tests_at_once" "$@" ${only:+--tests-regex "$only"}
}

# failures TREE: what the tests of build/TREE that failed said of it, once more at the end, where no one must look for it
failures() {
  printf '\n== what failed\n'
  awk '
    /^[0-9]+\/[0-9]+ Test: / { name = substr($0, index($0, "Test: ") + 6); said = 0; wanted = 0; lines = 0; passed = 0 }
    /^Test Passed\.|^Test Pass Reason:/ { passed = 1 }
    /: Failure$|^\[  FAILED  \]|^(FAIL|ERROR): |^not ok |^Traceback|Sanitizer: / { wanted = 12 }
    wanted > 0 { if (said < 60) failure[said++] = $0; wanted-- }
    { last[lines++ % 30] = $0 }
    /" end time: / && !passed {
      printf "\n-- %s\n", name
      for (i = 0; i < said; ++i) print failure[i]
      if (said == 0) for (i = lines > 30 ? lines - 30 : 0; i < lines; ++i) print last[i % 30]
    }
  ' "build/$1/Testing/Temporary/LastTest.log"
}

tidy_sources() {
  quietly configure-tidy.log cmake --preset tidy -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DDRIFTLAB_FUZZ=ON \
    -DCMAKE_CXX_COMPILER_LAUNCHER= || return 1
  python3 tests/house/tidy.py build/tidy --jobs "$jobs" >"$logs/tidy.log" 2>&1 ||
    { grep -A 6 -E '(warning|error):' "$logs/tidy.log" | head -n 200; echo "The whole output is in $logs/tidy.log"; return 1; }
}

format_check() { git -c safe.directory='*' ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format-19 --dry-run -Werror; }

# --- packages ---------------------------------------------------------------------------------------------------------
# shellcheck source=deploy/packages.sh
. deploy/packages.sh
sets=(build dashboard test browser python fuzz)
[ "$sanitize" = no ] || sets+=(sanitize)
[ "$tidy" = no ] || sets+=(tidy)
install_packages "$logs/apt.log" "${sets[@]}" || exit 1

# --- build and test ---------------------------------------------------------------------------------------------------
if [ "$tidy" = yes ]; then
  step "clang-format" format_check
  step "clang-tidy" tidy_sources
fi
if [ "$sanitize" = yes ]; then
  for preset in asan-ubsan tsan; do
    step "build $preset" build "$preset" all && { step "test $preset" run_tests "$preset" --label-exclude 'long|house' || failures "$preset"; }
  done
fi

# Release suites and fuzz targets are one ctest run, so that its closing lines speak for all of them.
trees=()
step "build release" build release "all benchmarks header_check" -DDRIFTLAB_TESTS=ON -DDRIFTLAB_BENCH=ON && trees+=(release)
step "build fuzz targets" build fuzz fuzz_targets "-DDRIFTLAB_FUZZ_SECONDS=$fuzz_seconds" "-DDRIFTLAB_FUZZ_DOCUMENTS=$fuzz_documents" && trees+=(fuzz)
labels=(--label-exclude long)
if [ "$long" = yes ]; then
  labels=()
  step "build long suites" build release long_suites
  export DRIFTLAB_ACCURACY_DIR=${DRIFTLAB_ACCURACY_DIR:-$repository/build/accuracy}
  mkdir -p "$DRIFTLAB_ACCURACY_DIR/hidden"
fi
if [ "${#trees[@]}" -gt 0 ]; then
  mkdir -p build/all
  printf 'subdirs("%s")\n' "${trees[@]/#/$repository/build/}" >build/all/CTestTestfile.cmake
  step "test" run_tests all "${labels[@]}" || failures all
fi
if [ "$long" = yes ]; then
  step "accuracy page" python3 tests/accuracy/page.py "$DRIFTLAB_ACCURACY_DIR"
  step "hidden effects page" python3 tests/accuracy/page.py "$DRIFTLAB_ACCURACY_DIR/hidden" tests/hidden/RESULTS.md
fi

printf '\n'
printf '%s\n' "${summary[@]}"
[ -z "$real_input" ] || printf '%s\n' "$real_input"
[ "$failed" = no ]
