#!/bin/sh
# Installs the Debian packages that its arguments name, or without any packages.txt, and this machine lacks, with apt-get:
# as root, or through sudo. Where all are there it does nothing and needs no rights.
set -eu

list=$(dirname "$0")/../packages.txt
[ $# -gt 0 ] || set -- $(sed 's/#.*//' "$list")
missing=
for package in "$@"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) || status=
  [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=
elif command -v sudo >/dev/null; then
  as_root=sudo
else
  echo "error: these packages are missing, and neither root rights nor sudo are there to install them:" >&2
  echo " $missing" >&2
  echo "Ask someone who has the rights to run: apt-get install$missing" >&2
  exit 1
fi

echo "Installing:$missing"
install() {
  # shellcheck disable=SC2086  # the lists are meant to fall into words
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet --no-install-recommends $missing
}
# Package lists may be absent (a fresh root) or older than what the mirror holds.
$as_root apt-get update --quiet
install
