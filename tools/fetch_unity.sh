#!/usr/bin/env bash
# Fetches the sources of the Unity test framework into .cache/unity/src, pinned by checksums: from its repository,
# or otherwise from the Debian source package that contains them. Does nothing if they exist.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
target=$root/.cache/unity

version=2.6.1
archive=https://github.com/ThrowTheSwitch/Unity/archive/refs/tags/v$version.tar.gz
archive_sha256=b41a66d45a6b99758fb3202ace6178177014d52fc524bf1f72687d93e9867292

debian_source=ntpsec # Unity 2.5.1 in its tests/unity
debian_sha256='2e3a0610268455520a5796345b503d00c34a47fe97ed3750349cbd4b2b1990f3  unity.c
681ac98a63ac11effb11e59d580f6ca82abca1bd34069465c38e3b15344256c0  unity.h
adfd612c217e59468c5ebe978640e77e5f539e820ffc0c195a98c5a36f0ac868  unity_internals.h'

if [ -e "$target/src/unity.c" ]; then
    exit 0
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

from_archive() {
    curl -fsSL --connect-timeout 5 --max-time 60 -o unity.tar.gz "$archive" &&
        echo "$archive_sha256  unity.tar.gz" | sha256sum --check --quiet &&
        tar -xzf unity.tar.gz && mv Unity-$version/src src
}

# apt-get with separate lists of source packages. The machine's lists stay unchanged.
private_apt() {
    apt-get -qq -o "Dir::Etc::SourceList=$scratch/sources.list" -o Dir::Etc::SourceParts=- \
        -o "Dir::Etc::TrustedParts=$scratch/keys" -o "Dir::State::Lists=$scratch/lists" -o "Dir::Cache=$scratch/cache" \
        -o APT::Sandbox::User="$(id -un)" -o Acquire::Retries=1 -o Acquire::http::Timeout=15 \
        -o Acquire::https::Timeout=15 "$@"
}

# Tries the machine's package sources one by one: a mirror may lack some of the source packages.
from_debian() {
    mkdir -p keys lists/partial cache/archives/partial
    find /etc/apt/trusted.gpg.d /etc/apt/keyrings /usr/share/keyrings \( -name '*.gpg' -o -name '*.asc' \) \
        -exec ln -sf -t keys {} + 2>/dev/null || true
    # shellcheck disable=SC2016 # these are fields of apt-get
    apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
        awk '!seen[$0]++' >places
    local place
    while read -r place; do
        echo "$place" >sources.list
        if private_apt update && private_apt source --download-only --tar-only $debian_source; then
            tar -xf $debian_source*.tar.* --wildcards '*/tests/unity/unity*' && mkdir -p src &&
                mv $debian_source*/tests/unity/{unity.c,unity.h,unity_internals.h} src &&
                (cd src && echo "$debian_sha256" | sha256sum --check --quiet) && return 0
        fi
    done <places
    return 1
}

if from_archive 2>log; then
    echo "Unity $version from its repository" >origin
elif command -v apt-get >/dev/null && from_debian >>log 2>&1; then
    echo "Unity 2.5.1 from the Debian source package $debian_source" >origin
else
    cat log >&2
    echo "Unity cannot be fetched. Give its sources to CMake with -DUNITY_DIR=, or copy its src/ to $target/src." >&2
    exit 1
fi
mkdir -p "$target"
mv src origin "$target/"
cat "$target/origin"
