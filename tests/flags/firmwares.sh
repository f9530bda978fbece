# shellcheck shell=bash
# The compiler flags of four firmwares. Sourced; sets flags and levels for the named firmware.
# shellcheck disable=SC2034 # used by files that source this one
firmwares=(px4 ardupilot betaflight inav)

firmware_flags() {
    case $1 in
        px4)
            flags=(-Wall -Wextra -Wdouble-promotion -Wfloat-equal -Wshadow -Wcast-align -Wlogical-op -Wpointer-arith
                -Wframe-larger-than=1300 -freciprocal-math -fno-signed-zeros -fno-trapping-math -fno-math-errno)
            levels=(-O2 -Os) ;;
        ardupilot)
            flags=(-Wall -Wextra -Wframe-larger-than=1300 -Wfloat-equal -Wmissing-declarations -Wlogical-op
                -fsingle-precision-constant -DNDEBUG)
            levels=(-Os -O2) ;;
        betaflight)
            flags=(-Wall -Wextra -Wpedantic -Wdouble-promotion -Wold-style-definition -flto -ffast-math)
            levels=(-O2 -Ofast) ;;
        inav)
            flags=(-Wall -Wextra -Wdouble-promotion -Wstrict-prototypes -fsingle-precision-constant -flto)
            levels=(-Os -O2) ;;
        *)
            return 1 ;;
    esac
}

# Warnings of all four together, for reading the sources without generating code: a warning of one firmware never silences one of
# another. -fsingle-precision-constant, which does, is left out.
reading_flags() {
    local firmware flag
    for firmware in "${firmwares[@]}"; do
        firmware_flags "$firmware"
        for flag in "${flags[@]}"; do
            [[ $flag != -W* ]] || echo "$flag"
        done
    done | sort -u
}
