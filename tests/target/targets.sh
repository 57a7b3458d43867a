# The machines on which the library is tested besides the host: how to compile for each, and how to run the result.
# shellcheck shell=bash disable=SC2034 # what target sets is for the scripts that ask

readonly OPTIONS='-std=c99 -ffp-contract=off -fno-tree-slp-vectorize -fno-math-errno -DWH_NO_CONTRACTION -Wall -Wextra -Ilib -Itests'
readonly M7='-mthumb -mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard'
readonly M0='-mthumb -mcpu=cortex-m0plus'
readonly M3='-mthumb -mcpu=cortex-m3'
readonly M4='-mthumb -mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard'

# Sets COMPILER, FLAGS, LINK, RUN and FLOAT for m7 (Cortex-M7, double), m4f (Cortex-M4F, float), m0 (Cortex-M0+, float in
# software, on an M4 that knows the same instructions), m4 (the same machine, double in software, with an addition of our own:
# tests/target/soft_double.c says why), m3 (Cortex-M3), rv64, aarch64 and powerpc (big-endian, 32 bits).
target() {
    FLOAT='' LINK='' RUN=()
    case $1 in
    m7 | m4f | m4 | m0)
        COMPILER=arm-none-eabi-gcc
        FLAGS="-O2 $M4"
        [[ $1 != m7 ]] || FLAGS="-O2 $M7"
        [[ $1 != m0 ]] || FLAGS="-O2 $M0"
        [[ $1 != m4f && $1 != m0 ]] || FLOAT=1
        LINK='--specs=rdimon.specs -T tests/target/mps2.ld tests/target/startup.c'
        [[ $1 != m4 ]] || LINK="tests/target/soft_double.c -Wl,--allow-multiple-definition $LINK"
        RUN=(qemu-system-arm -M "$([[ $1 == m7 ]] && echo mps2-an500 || echo mps2-an386)" -nographic -monitor none
            -serial none -semihosting-config "enable=on,target=native" -kernel)
        ;;
    m3) # for tests/target/board.c, whose line is the UART
        COMPILER=arm-none-eabi-gcc FLAGS="-O2 $M3"
        LINK='--specs=rdimon.specs -T tests/target/lm3s.ld tests/target/startup.c'
        RUN=(qemu-system-arm -M lm3s6965evb -nographic -monitor none -semihosting-config "enable=on,target=native" -kernel)
        ;;
    rv64)
        COMPILER=riscv64-unknown-elf-gcc
        FLAGS='-O2 -march=rv64gc -mabi=lp64d -mcmodel=medany --specs=picolibc.specs'
        LINK='--oslib=semihost --crt0=hosted -Wl,--defsym=__flash=0x80000000 -Wl,--defsym=__flash_size=4M
            -Wl,--defsym=__ram=0x80400000 -Wl,--defsym=__ram_size=4M -Wl,--defsym=__stack_size=256K'
        RUN=(qemu-system-riscv64 -M virt -bios none -nographic -monitor none -serial none
            -semihosting-config "enable=on,target=native" -kernel)
        ;;
    aarch64 | powerpc)
        COMPILER=$1-linux-gnu-gcc
        FLAGS='-O2'
        LINK='-static'
        RUN=("qemu-${1/powerpc/ppc}")
        ;;
    esac
}

# build_library FOLDER: for the chosen target. A folder is built by one process at a time, since parallel checks share some
# folders.
build_library() {
    local ar=ar
    [[ $COMPILER != *-gcc ]] || ar=${COMPILER%gcc}ar
    mkdir -p "$1"
    flock "$1/lock" make -s -j"$(nproc)" library B="$1" CC="$COMPILER" AR="$ar" CFLAGS="$FLAGS" FLOAT="$FLOAT" >/dev/null
}

# build_target NAME: chooses it, and builds its library in the folder $library; the checks share it
build_target() {
    target "$1"
    library=build/verify/targets/$1
    build_library "$library"
}

# compile FOLDER PROGRAM ARGUMENT...: against the library in FOLDER
compile() {
    local folder=$1 program=$2
    shift 2
    # shellcheck disable=SC2086 # words
    "$COMPILER" $FLAGS $OPTIONS ${FLOAT:+-DWH_FLOAT} "$@" "$folder/libwaferhand.a" $LINK -lm -o "$program"
}
