#!/usr/bin/env bash
# The Debian 12 packages driftlab needs, in one place, and the function that installs what is missing.
# Sourced by deploy/quickstart.sh and tests/run.sh; run by itself it prints a set: ./deploy/packages.sh build
#
#   runtime   shared libraries of the finished binaries driftlab and driftlabd
#   build     compiler, headers and tools that make them
#   dashboard node and npm, which build the pages; whatever of the two is there already stays as it is
#   test      what the suites of tests/ need beside that
#   browser   Chromium, which tests/browser drives, and what reads the pages that it prints
#   python    what tests/python needs beside the set test: builds and checks the package clients/python, runs its notebook
#   fuzz      clang 19 for the libFuzzer targets
#   sanitize  clang 19 for the asan-ubsan and tsan presets
#   tidy      clang-tidy and clang-format 19

# `ceres` is used for its header-only TinySolver: nothing of SuiteSparse is linked (see NOTICE).
driftlab_packages() {
  case "$1" in
    runtime) echo libboost-url1.81.0 libsqlite3-0 libpq5 libspdlog1.10 libssl3 libarchive13 liblzma5 libzstd1 zlib1g libstdc++6 \
                  libgeographiclib23 libcairo2 libjemalloc2 libhdf5-103-1 libhdf5-hl-100 ca-certificates ;;
    build) echo build-essential cmake ninja-build ccache pkg-config git curl ca-certificates \
                libboost1.81-dev libboost-url1.81-dev nlohmann-json3-dev libeigen3-dev libceres-dev libsqlite3-dev libpq-dev \
                libspdlog-dev libfmt-dev libcli11-dev libtomlplusplus-dev libssl-dev libexpected-dev libarchive-dev liblzma-dev libzstd-dev zlib1g-dev \
                libgeographiclib-dev libcairo2-dev libhdf5-dev libjemalloc-dev python3 python3-yaml ;;
    dashboard) command -v node >/dev/null || echo nodejs; command -v npm >/dev/null || echo npm ;;
    browser) echo chromium fonts-liberation poppler-utils ;;
    test) echo libgtest-dev libgmock-dev libbenchmark-dev python3-numpy python3-h5py python3-jsonschema xz-utils zstd sqlite3 postgresql prometheus zsh fish \
               python3-swift awscli iproute2 ;;
    python) echo python3-venv python3-pip python3-setuptools python3-wheel python3-yaml mypy flake8 jupyter-nbconvert python3-ipykernel ;;
    fuzz) echo clang-19 libclang-rt-19-dev ;;
    sanitize) echo clang-19 libclang-rt-19-dev ;;
    tidy) echo clang-19 clang-tidy-19 clang-format-19 ;;
    *) echo "packages.sh: unknown set '$1'; known: runtime build dashboard test browser python fuzz sanitize tidy" >&2; return 2 ;;
  esac
}

# Packages of the argument list that dpkg does not report as installed.
missing_packages() {
  local name state
  for name in "$@"; do
    state=$(dpkg-query --show --showformat='${db:Status-Status}' "$name" 2>/dev/null) || state=absent
    [ "$state" = installed ] || printf '%s\n' "$name"
  done
}

# install_packages LOG SET...: installs what is missing of the sets through apt, output to LOG, shown where it fails.
# Nothing missing: no apt call, no word, no root needed.
install_packages() {
  local log=$1 set wanted=() missing=()
  shift
  for set in "$@"; do
    # shellcheck disable=SC2207  # package names have no blanks
    wanted+=($(driftlab_packages "$set")) || return
  done
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This is not Debian: nothing is installed; these Debian 12 packages, or their like, have to be there:" >&2
    echo "  ${wanted[*]}" >&2
    return 0
  fi
  mapfile -t missing < <(missing_packages "${wanted[@]}" | sort -u)
  [ "${#missing[@]}" -gt 0 ] || return 0

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Packages are missing and there is no sudo here. As root, run:" >&2
      echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
  if [[ " ${missing[*]} " == *" libboost1.81-dev "* ]] && [ -z "$(missing_packages libboost1.74-dev)" ]; then
    echo "  libboost1.74-dev is installed and cannot stand beside libboost1.81-dev: apt will replace it."
  fi
  mkdir -p "$(dirname "$log")"
  if ! "${as_root[@]}" apt-get update >"$log" 2>&1; then
    tail -n 15 "$log" >&2
    echo "apt-get update failed; the whole output is in $log" >&2
    return 1
  fi
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "${missing[@]}" \
      >>"$log" 2>&1 </dev/null; then
    tail -n 15 "$log" >&2
    echo "apt-get install failed; the whole output is in $log" >&2
    return 1
  fi
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  driftlab_packages "${1:?which set? runtime build dashboard test browser python fuzz sanitize tidy}"
fi
