#!/usr/bin/env bash
# The README's two commands in a bare Debian 12: debootstrap's smallest root, a fresh clone in it, nothing else.
# Not part of ./tests/run.sh: it needs root, debootstrap, a Debian mirror, some 4 GB of disk and as long as two clean builds.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

usage() {
  cat <<'TXT'
Usage: tests/house/bare_debian.sh FOLDER [--quickstart-only]

Makes a Debian 12 root in FOLDER (kept if it is there), clones this repository's HEAD into it and runs, as its root,
./deploy/quickstart.sh --once and ./tests/run.sh. Prints how long each took; exit 1 where one fails.
$DEBIAN_MIRROR is the mirror (default: http://deb.debian.org/debian).
TXT
}
case "${1:--}" in
  -*) usage >&2; exit 2 ;;
esac
root=$1
commands=("./deploy/quickstart.sh --once" "./tests/run.sh")
[ "${2:-}" != --quickstart-only ] || commands=("./deploy/quickstart.sh --once")

mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
if [ ! -e "$root/etc/debian_version" ]; then
  debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1 || { tail -n 20 "$root.log"; exit 1; }
fi
rm -rf "$root/driftlab"
git clone --quiet --no-hardlinks "$repository" "$root/driftlab"
mount --bind /proc "$root/proc"
mount --bind /dev "$root/dev"
trap 'umount "$root/proc" "$root/dev"' EXIT

for command in "${commands[@]}"; do
  start=$SECONDS
  chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb \
    bash -c "cd /driftlab && $command" || { echo "FAILED after $((SECONDS - start)) s: $command"; exit 1; }
  echo "passed in $((SECONDS - start)) s: $command"
done
