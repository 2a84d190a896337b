#!/bin/sh
# flavours.sh GCC CLANG: what detail/base/abi_tag.hpp names the library's namespace, with each flag of the compilers that changes
# the instructions that they may use. Wherever the macros of two sets of flags differ, by which a compiler tells of these, the
# names do, but for the macros listed here, each with the reason why no code of the library has what it stands for. A new
# compiler's new macro is so told of, until it is in the one list or the other. Clang is asked for other processors, too.
set -eu
include=$(cd "$(dirname "$0")/../../include" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '#include <lightbin/detail/base/abi_tag.hpp>\nname LIGHTBIN_ABI_TAG\n' >"$work/file.cpp"

# Patterns of macros, without the underscores around them. Behind two spaces stands why.
numbers="
    [a-z0-9_]* .*tune_.* OPTIMIZE.* NO_INLINE.*                   processors and how code is tuned
    FLT.* DBL.* LDBL.* DECIMAL_DIG LONG_DOUBLE.* SIZEOF_LONG_DOUBLE BIGGEST_ALIGNMENT FP_FAST_.* GCC_.* CLANG_.*  follow
    SOFT_FLOAT CET                                                is refused, or asks for hints alone"
x86="
    MMX SSE SSE2 MMX_WITH_SSE SSE_MATH SSE2_MATH                  without these nothing of it compiles
    ABM AVX10_1_512 AVX10_1_256 AVX10_2_512 EVEX256               follow from those that are asked
    3dNOW 3dNOW_A PRFCHW PREFETCHWT1 PREFETCHI SHSTK              hints
    AES VAES PCLMUL VPCLMULQDQ SHA SHA512 SM3 SM4 KL WIDEKL CRC32   ciphers and checksums
    F16C AVX512BF16 AVXNECONVERT                                  floats of 16 bits
    AVX512(ER|PF|VP2INTERSECT) AVX5124(FMAPS|VNNIW)               want an intrinsic, as do all of these
    ADX LWP RTM HLE FSGSBASE RDRND RDSEED RDPID RDPRU INVPCID PKU PTWRITE PCONFIG SGX SERIALIZE TSXLDTRK UINTR USERMSR
    HRESET ENQCMD MOVDIRI MOVDIR64B CLDEMOTE CLFLUSHOPT CLWB CLZERO CLFLSH MWAIT MWAITX WAITPKG WBNOINVD AMX_?.* FXSR
    XSAVE XSAVEC XSAVEOPT XSAVES LAHF_SAHF SAHF
    EGPR PPX PUSH2POP2 NDD CCMP NF CF ZU APX_INLINE.*             parts of APX, which no processor has alone"
arm="
    ARM_FEATURE_(AES|CRYPTO|SHA2|SHA512|SM3|SM4|CRC32|SVE2?_(AES|SHA3|SM4|BITPERM))   ciphers and checksums
    ARM_FEATURE_(FP16_(FML|VECTOR.*)|BF16.*|SVE_BF16|SVE_B16B16|FP8.*|SSVE_FP8.*) ARM_BF16.* ARM_FP16.*   floats of 16 and 8 bits
    ARM_FEATURE_(BTI.*|PAC_DEFAULT|GCS.*)                         hints
    ARM_FEATURE_(JCVT|FRINT|LS64|LUT|MEMORY_TAGGING|RNG|TME|LSE128|SME.*|LOCALLY_STREAMING|SYSREG128) ARM_STATE.*  intrinsics
    ARM_FEATURE_(SVE_MATMUL_FP32|SVE_MATMUL_INT8|SVE_VECTOR_OPERATORS|SVE_PREDICATE_OPERATORS)   follow from others
    ARM_ALIGN.* ARM_FEATURE_(UNALIGNED|CMSE|COPROC|QBIT|LDREX) ARM_(FP|NEON_FP|VFPV.*|ARCH_.*|PCS.*|EABI.*) XSCALE"

# ask COMPILER FLAG...: adds to $work/answers what it makes of file.cpp, macros and all; nothing where it takes no such flags
ask() {
    if "$@" -std=c++20 -I "$include" -E -dD "$work/file.cpp" >"$work/said" 2>"$work/refused"; then
        echo "flags $*" | cat - "$work/said" >>"$work/answers"
    fi
}

# judge WHAT NAMES [PATTERNS]: sees that no two answers have one name and different macros, other than those of the PATTERNS;
# without these, that none have one name; and that there are as many NAMES. Then forgets them.
judge() {
    ignored=$(echo "${3-}" | sed 's/^ *//; s/  .*//' | tr -s ' \n' '\n\n' | sed '/^$/d' | paste -s -d '|')
    awk -v what="$1" -v least="$2" -v ignored="${ignored:+^_*($ignored)_*\$}" '
        function words(text, set, n, list, i) { n = split(text, list, ";"); for (i = 1; i <= n; ++i) set[list[i]] = 1 }
        /^flags / { flags = substr($0, 7); macros = ignored == "" ? flags : ""; ++sets }
        ignored != "" && /^#define / && !/^#define LIGHTBIN_/ {
            if (!($2 in tells)) tells[$2] = $2 !~ ignored
            if (tells[$2]) macros = macros $0 ";"
        }
        /^name / && !($2 in named) { named[$2] = macros; by[$2] = flags; ++names; next }
        /^name / && named[$2] != macros && !told[$2]++ {
            print $2 " is the name with " by[$2] " and with " flags
            split("", a); split("", b); words(named[$2], a); words(macros, b)
            for (word in a) if (!(word in b)) print "    the first alone has " word
            for (word in b) if (!(word in a)) print "    the second alone has " word
            wrong = 1
        }
        END { print what ": " sets " sets of flags, " names " names"; exit wrong || names < least }' "$work/answers" || failed=yes
    rm "$work/answers"
}

processors() {
    "$@" --print-supported-cpus 2>&1 | sed -n 's/^\t//p'
}

# x86_64 COMPILER MACHINE FLAGS PROCESSOR...: each processor, each flag alone, and a processor that has most without each
x86_64() {
    compiler=$1 machine=$2 flags=$3
    shift 3
    ask "$compiler" "$machine"
    for processor; do
        ask "$compiler" "$machine" "-march=$processor"
    done
    for flag in $flags; do
        ask "$compiler" "$machine" "$flag"
        ask "$compiler" "$machine" -march=sapphirerapids "-mno-${flag#-m}"
    done
    judge "$compiler, x86-64" 60 "$numbers $x86"
}

failed=
gcc=$1 clang=$2
flags=$("$gcc" --help=target -Q | sed -n 's/^  \(-m[^ =<]*\)[ \t].*/\1/p' |
    grep -vE '^-m(16|32|x32|iamcu|android|bionic|musl|uclibc|glibc|general-regs-only)$')
# shellcheck disable=SC2046  # several words
x86_64 "$gcc" -m64 "$flags" $("$gcc" --help=target -Q | sed -n '/valid arguments for -march=/{n;s/ native//;p}')
# clang lists no flags of x86: those of gcc and what is newer
newer="-mavx10.1-256 -mavx10.1-512 -mavx10.2 -mavxifma -mavxneconvert -mavxvnniint8 -mavxvnniint16 -mcmpccxadd -mevex512 -mapxf
    -mraoint -msha512 -msm3 -msm4 -mprefetchi -musermsr"
# shellcheck disable=SC2046  # several words
x86_64 "$clang" --target=x86_64-linux-gnu "$flags $newer" $(processors "$clang" --target=x86_64-linux-gnu)

arm64="$clang --target=aarch64-linux-gnu"
# shellcheck disable=SC2086  # several words
{
    for processor in $(processors $arm64); do
        ask $arm64 "-mcpu=$processor"
    done
    # Without vectors of 128 bits nothing compiles.
    for extension in $($arm64 --print-supported-extensions 2>&1 | awk '/^ +[a-z]/ && $1 !~ /^(fp|simd)$/ { print $1 }'); do
        for level in armv8-a armv8.6-a armv9.4-a+sve2p1; do
            ask $arm64 "-march=$level+$extension"
            ask $arm64 "-march=$level+no$extension"
        done
    done
    for bits in 128 256 512 scalable; do
        ask $arm64 -march=armv8-a+sve -msve-vector-bits=$bits
    done
}
judge "$clang, 64-bit ARM" 40 "$numbers $arm ARM_ARCH"

arm32="$clang --target=arm-linux-gnueabihf"
# shellcheck disable=SC2086  # several words
{
    for processor in $(processors $arm32); do
        ask $arm32 "-mcpu=$processor"
    done
    for unit in vfpv2 vfpv3 vfpv3-d16 vfpv4 vfpv4-d16 neon neon-vfpv4 neon-fp-armv8; do
        ask $arm32 -march=armv7-a -mfpu=$unit
    done
}
judge "$clang, 32-bit ARM" 20 "$numbers $arm"

for processor in z10 z196 zEC12 z13 z14 z15 z16 "z13 -mno-vx" "z16 -mno-vx"; do
    # shellcheck disable=SC2086  # two words
    ask "$clang" --target=s390x-linux-gnu -march=$processor
done
judge "$clang, IBM Z" 9 "$numbers HTM VEC"

# Where only the commonest extensions have a part in the name.
for set in rv64gc rv64gcv rv64gc_zba rv64gc_zbb rv64gc_zbs rv64gc_zfa rv64gc_zicond rv64gcv_zba_zbb_zbs; do
    ask "$clang" --target=riscv64-linux-gnu -march=$set
done
judge "$clang, RISC-V" 8
for set in pwr5 pwr6 pwr7 pwr8 pwr9 pwr10 "pwr8 -mno-vsx" "pwr8 -mno-altivec -mno-vsx"; do
    # shellcheck disable=SC2086  # several words
    ask "$clang" --target=powerpc64-linux-gnu -mcpu=$set
done
judge "$clang, POWER" 8
for set in "" -msimd128; do
    # shellcheck disable=SC2086  # a word, or none
    ask "$clang" --target=wasm32 $set
done
judge "$clang, WebAssembly" 2
[ -z "$failed" ]
