# Shared by the shell scripts: source it after `set -euo pipefail`.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

# Prints the comment at the top of the calling script.
usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; }

say() { printf '== %s\n' "$*" >&2; }

die() {
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 2
}

as_root() {
    if [ "$(id -u)" = 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        die "must run as root (or with sudo installed) to install packages"
    fi
}

# Installs those of the named Debian packages that are missing; needs no network when none is.
install_packages() {
    local missing
    # One line per package that dpkg knows; what is not "installed" there, or not there at all, is missing.
    missing=$(comm -23 <(printf '%s\n' "$@" | sort -u) <(installed_among "$@"))
    [ -n "$missing" ] || return 0
    say "installing" $missing
    as_root apt-get -o Acquire::Retries=3 update -qq
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 install -y -q --no-install-recommends $missing
}

installed_among() {
    { dpkg-query -W -f '${binary:Package} ${db:Status-Status}\n' "$@" 2>/dev/null || true; } |
        sed -n 's/^\([^: ]*\)\(:[a-z0-9]*\)\{0,1\} installed$/\1/p' | sort -u
}
