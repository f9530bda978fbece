#!/usr/bin/env bash
# Installs the project's requirements: Debian packages, the Unity test framework, a Python environment in .venv with the package goe
# of port/python, compiled from the current sources.
#
#   tools/setup.sh          everything
#   tools/setup.sh --demo   only what tools/demo.sh needs
#   tools/setup.sh --rivals everything, and GTSAM in .cache/rivals for the comparison with other estimators
#
# Packages are installed as root or with a sudo that needs no password; otherwise the command to type is printed. Existing
# installations are left alone, so a second run takes a moment. Exit status 1: something needed is missing.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
mkdir -p .cache
log=$root/.cache/setup.log
: >"$log"

demo=false
rivals=false
case ${1:-} in
    --demo) demo=true ;;
    --rivals) rivals=true ;;
    '') ;;
    *)
        sed -n '2,/^set/ { /^#/ s/^# \{0,1\}//p }' "$0" >&2
        exit 2 ;;
esac

die() {
    tail -n 15 "$log" >&2
    echo "setup: $*" >&2
    exit 1
}

# -------------------------------------------------------------------------------------------------------------- packages

# want <list> <package> <command that succeeds if it is installed>...
want() {
    local -n list=$1
    local package=$2
    shift 2
    "$@" >/dev/null 2>&1 || list+=("$package")
}

has() { command -v "$1"; }
has_header() { echo "#include <$1>" | cc -E -x c -; }
has_arm_cxx_header() { echo "#include <$1>" | arm-none-eabi-g++ -E -x c++ -; }
can_count() { echo "int main(void) { return 0; }" | clang-19 -fprofile-instr-generate -x c - -o /dev/null; }
has_arm_header() { echo "#include <$1>" | arm-none-eabi-gcc -E -x c -; }

find_missing() {
    needed=()
    extra=()
    want needed build-essential eval 'has c++ && has_header stdio.h'
    want needed cmake has cmake
    want needed ninja-build has ninja
    want needed libpopt-dev has_header popt.h
    want needed libcsv-dev has_header csv.h
    want needed libinih-dev has_header ini.h
    want needed libjansson-dev has_header jansson.h
    want needed python3-venv python3 -c 'import ensurepip, venv'
    # For the live page, 45 MB. It is built, not shipped: it contains the library, and would therefore change with every change of
    # lib/, and nobody could review 250 KB of WebAssembly.
    want extra clang-19 has clang-19
    want extra lld-19 has wasm-ld-19
    want extra binaryen has wasm-opt
    if ! $demo; then
        want needed curl has curl
        want needed ca-certificates test -e /etc/ssl/certs/ca-certificates.crt
        want needed xz-utils has xz
        # Without these parts of tools/test.sh are skipped.
        want extra llvm-19 has llvm-cov-19
        want extra libclang-rt-19-dev can_count
        want extra cppcheck has cppcheck
        want extra frama-c-base has frama-c
        want extra clang-format-19 has clang-format-19
        want extra clang-tidy-19 has clang-tidy-19
        want extra shellcheck has shellcheck
        want extra doxygen has doxygen
        want extra chromium has chromium
        want extra chromium-driver has chromedriver
        want extra poppler-utils has pdftoppm
        want extra pkgconf has pkg-config
        want extra gcc-arm-none-eabi has arm-none-eabi-gcc
        want extra libnewlib-arm-none-eabi has_arm_header math.h
        want extra qemu-system-arm has qemu-system-arm
        want extra qemu-system-misc has qemu-system-riscv32
        want extra gcc-riscv64-unknown-elf has riscv64-unknown-elf-gcc
        want extra picolibc-riscv64-unknown-elf test -e /usr/lib/picolibc/riscv64-unknown-elf/picolibc.specs
        want extra libeigen3-dev test -e /usr/include/eigen3/Eigen/Dense
        want extra liblapacke-dev has_header lapacke.h
        want extra libstdc++-arm-none-eabi-newlib has_arm_cxx_header cstddef
    fi
}

as_root=()
may_install() {
    command -v apt-get >/dev/null || return 1
    [ "$(id -u)" = 0 ] && return 0
    command -v sudo >/dev/null && sudo -n true 2>/dev/null && as_root=(sudo -n)
}

# Whether apt's current lists contain all of the packages.
known() { apt-get install --simulate --no-install-recommends "$@" >>"$log" 2>&1; }

install_packages() {
    echo "setup: installing $*"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y -o DPkg::Lock::Timeout=300 --no-install-recommends "$@" \
        </dev/null >>"$log" 2>&1
}

update_lists() {
    echo "setup: updating the lists of packages"
    "${as_root[@]}" apt-get update -qq </dev/null >>"$log" 2>&1 || true
}

find_missing
if [ $((${#needed[@]} + ${#extra[@]})) != 0 ]; then
    if may_install; then
        known "${needed[@]}" "${extra[@]}" || update_lists
        if [ ${#needed[@]} != 0 ] && ! install_packages "${needed[@]}"; then
            update_lists # the lists may be outdated
            install_packages "${needed[@]}" || die "apt-get cannot install ${needed[*]}"
        fi
        # All at once, which takes a fraction of the time; one by one if that fails, to find the one that is missing.
        if [ ${#extra[@]} != 0 ] && ! install_packages "${extra[@]}"; then
            for package in "${extra[@]}"; do
                if known "$package"; then
                    install_packages "$package" || echo "setup: $package cannot be installed"
                else
                    echo "setup: there is no package $package here"
                fi
            done
        fi
    else
        echo "setup: missing packages; please type:"
        echo "    sudo apt-get update && sudo apt-get install --no-install-recommends" "${needed[@]}" "${extra[@]}"
        if [ ${#needed[@]} != 0 ]; then
            exit 1
        fi
        echo "setup: going on without ${extra[*]}, which only the live page and some tests need"
    fi
fi

# ----------------------------------------------------------------------------------------------------- Unity and Python

if ! $demo && [ -z "${UNITY_DIR:-}" ] &&
    ! (cd .cache && cmake --find-package -DNAME=unity -DCOMPILER_ID=GNU -DLANGUAGE=C -DMODE=EXIST) >>"$log" 2>&1; then
    tools/fetch_unity.sh
fi

python=${PYTHON:-python3}
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 9))' || die "Python 3.9 or newer is needed"
stamp=.venv/installed
state=$("$python" --version && cat tools/requirements.txt tools/pyproject.toml && echo "$root")
if [ ! -e $stamp ] || [ "$(cat $stamp)" != "$state" ]; then
    echo "setup: making .venv (some three minutes)"
    rm -rf .venv
    "$python" -m venv .venv >>"$log" 2>&1 || die "no Python environment can be made"
    .venv/bin/python -m pip install --quiet --disable-pip-version-check -r tools/requirements.txt >>"$log" 2>&1 ||
        die "pip cannot install tools/requirements.txt"
    .venv/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --editable tools >>"$log" 2>&1 ||
        die "pip cannot install tools/"
    echo "$state" >$stamp
fi

# The Python package goe, always from the current sources: goe.FINGERPRINT identifies those of an installed package, and
# goe_tools refuses any other. It is compiled from scratch: no time stamp can keep an old object.
present=$(.venv/bin/python port/python/bindings.py --lib lib --flight port/flight --cmake port/cmake) ||
    die "port/python/bindings.py does not run"
if [ "$(.venv/bin/python -I -c 'import goe; print(goe.FINGERPRINT)' 2>>"$log")" != "$present" ]; then
    echo "setup: building the Python package goe"
    .venv/bin/python -m pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps \
        --force-reinstall ./port/python >>"$log" 2>&1 || die "pip cannot build port/python"
fi

if $rivals; then
    stamp=.cache/rivals/installed
    state=$("$python" --version && cat tools/requirements-rivals.txt)
    if [ ! -e $stamp ] || [ "$(cat $stamp)" != "$state" ]; then
        echo "setup: making .cache/rivals"
        rm -rf .cache/rivals
        mkdir .cache/rivals
        # Without dependencies and outside .venv; tools/requirements-rivals.txt has the reason.
        .venv/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --target .cache/rivals \
            -r tools/requirements-rivals.txt >>"$log" 2>&1 || die "pip cannot install tools/requirements-rivals.txt"
        [ -e .cache/rivals/gtsam ] || echo "setup: there is no GTSAM for this Python; the comparison goes without it"
        echo "$state" >$stamp
    fi
fi
