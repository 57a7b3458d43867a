/* Number type, version and build guards: included by every other header, never needed alone.
 *
 * Units everywhere: mm, rad, s, unless a name says otherwise (`_us`, `_deg`).
 */
#ifndef WH_MATH_CONFIG_H
#define WH_MATH_CONFIG_H

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The only place that has the version number; program, manual, pkg-config and CMake take it from here. */
#define WH_VERSION_MAJOR 0
#define WH_VERSION_MINOR 1
#define WH_VERSION_PATCH 0
#define WH_VERSION WH_TEXT(WH_VERSION_MAJOR) "." WH_TEXT(WH_VERSION_MINOR) "." WH_TEXT(WH_VERSION_PATCH)
#define WH_TEXT(tokens) WH_TEXT_(tokens)
#define WH_TEXT_(tokens) #tokens

/* Features that a firmware does not need can be left out of linking. Define one of these or both,
 * consistently for the library and for everything that includes its headers: on the command line, or in a
 * header of your own that WH_CONFIG_FILE names, as in -DWH_CONFIG_FILE='"our_waferhand.h"'. By default
 * nothing is left out. The remaining functions keep their bits and their hash. If a library was built
 * without a feature, its symbols end with a mark for it, so that it does not link with headers that have
 * the feature.
 *   WH_WITHOUT_SWEEP   no swept checking: wh_grasp_init refuses WH_CHECK_SWEPT (WH_STATUS_NOT_BUILT)
 *   WH_WITHOUT_INDEX   no index over the wafers: wh_grasp_init refuses buckets, wh_grasp_buckets gives 0 */
#if defined(WH_CONFIG_FILE)
#include WH_CONFIG_FILE
#endif
/* The preprocessor takes these as on for any value, so 0, which looks like off, is refused. */
#if defined(WH_FLOAT) && (0 - WH_FLOAT - 1) != 1 && (0 - WH_FLOAT - 1) != -2
#error "waferhand: WH_FLOAT is 0, or not 1: define it as 1 or as nothing for float, leave it out for double"
#endif
#if defined(WH_WITHOUT_SWEEP) && (0 - WH_WITHOUT_SWEEP - 1) != 1 && (0 - WH_WITHOUT_SWEEP - 1) != -2
#error "waferhand: WH_WITHOUT_SWEEP is 0, or not 1: define it as 1 or as nothing, or leave it out"
#endif
#if defined(WH_WITHOUT_INDEX) && (0 - WH_WITHOUT_INDEX - 1) != 1 && (0 - WH_WITHOUT_INDEX - 1) != -2
#error "waferhand: WH_WITHOUT_INDEX is 0, or not 1: define it as 1 or as nothing, or leave it out"
#endif
#if defined(WH_NO_CONTRACTION) && (0 - WH_NO_CONTRACTION - 1) != 1 && (0 - WH_NO_CONTRACTION - 1) != -2
#error "waferhand: WH_NO_CONTRACTION is 0, or not 1: define it as 1 or as nothing, or leave it out"
#endif
#if defined(WH_DEBUG) && (0 - WH_DEBUG - 1) != 1 && (0 - WH_DEBUG - 1) != -2
#error "waferhand: WH_DEBUG is 0, or not 1: define it as 1 or as nothing, or leave it out"
#endif
#if defined(WH_DEBUG_TABLE) && (0 - WH_DEBUG_TABLE - 1) != 1 && (0 - WH_DEBUG_TABLE - 1) != -2
#error "waferhand: WH_DEBUG_TABLE is 0, or not 1: define it as 1 or as nothing, or leave it out"
#endif
/* The most axes and grippers of a machine. By default they are 32 and 16, and 8 and 8 where there is no
 * operating system, so that a small firmware's structs stay small. A machine that needs no more than the
 * smaller counts has equal bits and an equal hash with both. Define your own counts, consistently for the
 * library and for everything that includes its headers:
 *   WH_MOST_AXES       4 to 32
 *   WH_MOST_GRIPPERS   1 to 16 */
#if defined(__unix__) || defined(__APPLE__) || defined(_WIN32)
#define WH_IS_HOST 1
#else
#define WH_IS_HOST 0
#endif
#if defined(WH_MOST_AXES)
#define WH_AXES WH_MOST_AXES
#elif WH_IS_HOST
#define WH_AXES 32
#else
#define WH_AXES 8
#endif
#if defined(WH_MOST_GRIPPERS)
#define WH_GRIPPERS WH_MOST_GRIPPERS
#elif WH_IS_HOST
#define WH_GRIPPERS 16
#else
#define WH_GRIPPERS 8
#endif
#if WH_AXES < 4 || WH_AXES > 32
#error "waferhand: WH_MOST_AXES is 4 to 32: a robot has 4, and bits of a 32-bit word stand for axes"
#endif
#if WH_GRIPPERS < 1 || WH_GRIPPERS > 16
#error "waferhand: WH_MOST_GRIPPERS is 1 to 16"
#endif

#if defined(WH_WITHOUT_SWEEP)
#define WH_SWEEP_BUILT false
#else
#define WH_SWEEP_BUILT true
#endif
#if defined(WH_WITHOUT_INDEX)
#define WH_INDEX_BUILT false
#else
#define WH_INDEX_BUILT true
#endif

/* Equal inputs must give equal bits on every machine; these builds cannot guarantee it. Nor can a build
 * that fuses products and sums, which no macro shows. Build everything that includes these headers with
 * -ffp-contract=off -fno-tree-slp-vectorize -DWH_NO_CONTRACTION, as pkg-config, CMake and meson do. They
 * add -fno-math-errno, which changes no bits: square roots are then one instruction, and smaller. gcc has a
 * macro for each part of -ffast-math. clang has macros only for the whole and for -ffinite-math-only; on
 * x86 the pragma below finds all other parts except -fno-honor-nans and -fno-honor-infinities.
 * lib/manual/building.md lists the cases that remain undetected. */
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0) ||                 \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "waferhand: -ffast-math or a part of it reorders sums and drops NaN, so builds would differ: remove it"
#elif defined(__clang__) && (defined(__x86_64__) || defined(__i386__))
static inline void wh_refuse_fast_math(void) {
#pragma STDC FENV_ACCESS ON /* waferhand: clang refuses this line under a part of -ffast-math: remove it */
}
#endif
#if defined(FLT_EVAL_METHOD)
#if FLT_EVAL_METHOD != 0
#error "waferhand: needs FLT_EVAL_METHOD 0 (no x87): on 32-bit x86 build with -msse2 -mfpmath=sse"
#endif
#elif !defined(__TINYC__) || defined(__i386__) /* tcc does not define it, but evaluates so except on x87 */
#error                                                                                                       \
    "waferhand: unknown rounding: if this compiler rounds each operation to its type, add -DFLT_EVAL_METHOD=0"
#endif

/* The library's real number: double, or float when built with -DWH_FLOAT. Library and program must use one
 * type. */
#if defined(WH_FLOAT)
typedef float wh_real_t;
typedef uint32_t wh_real_bits_t; /* an integer of equal size, to be copied from and to a real */
/* The greatest deviation of an entry of |R^T R - I| from zero. */
#define WH_ROTATION_TOLERANCE 1e-5F
#define WH_SYMBOL_NUMBER "f"
#else
typedef double wh_real_t;
typedef uint64_t wh_real_bits_t;
#define WH_ROTATION_TOLERANCE 1e-6
#define WH_SYMBOL_NUMBER "d"
#endif

/* -fsingle-precision-constant changes numbers, also in float, because random numbers are computed in
 * double. No macro shows it. */
typedef char wh_constants_need_double[sizeof(0.1) == sizeof(double) ? 1 : -1];

/* Structs pass from your files to the library and back. A `#pragma pack` that an earlier header left open,
 * or -fpack-struct, would give them another layout on one side. So each header with structs begins with a
 * sample. It is refused unless it is as large as the one here, which no packing affects. */
#pragma pack(push, 16)
typedef struct {
    char before;
    wh_real_t real;
    char between;
    uint64_t whole;
} wh_unpacked_t;
#pragma pack(pop)
#if defined(__BIGGEST_ALIGNMENT__) && __BIGGEST_ALIGNMENT__ > 1 /* gcc's -fpack-struct packs it, too */
typedef char wh_structs_are_packed[sizeof(wh_unpacked_t) > 2 + sizeof(wh_real_t) + sizeof(uint64_t) ? 1 : -1];
#endif
#if defined(__FRAMAC__) /* which reads the pragma in another way, and does not pack */
#define WH_REFUSE_PACKING(header) typedef char wh_##header##_is_packed[1]
#else
#define WH_REFUSE_PACKING(header)                                                                            \
    typedef struct {                                                                                         \
        char before;                                                                                         \
        wh_real_t real;                                                                                      \
        char between;                                                                                        \
        uint64_t whole;                                                                                      \
    } wh_##header##_sample_t;                                                                                \
    typedef char wh_##header##_is_packed[sizeof(wh_##header##_sample_t) == sizeof(wh_unpacked_t) ? 1 : -1]
#endif

/* True where numbers are computed by software; a comparison that saves a product is then worthwhile. It
 * changes no result. */
#if defined(__ARM_ARCH) && (!defined(__ARM_FP) || (!defined(WH_FLOAT) && (__ARM_FP & 8) == 0))
#define WH_REAL_IS_SLOW true
#elif defined(__riscv) && (!defined(__riscv_flen) || (!defined(WH_FLOAT) && __riscv_flen < 64))
#define WH_REAL_IS_SLOW true
#else
#define WH_REAL_IS_SLOW false
#endif

/* A cast, in the words of the language: C++ may warn of C's (-Wold-style-cast). */
#if defined(__cplusplus)
#define WH_CAST(type, value) (static_cast<type>(value))
#define WH_ADDRESS(pointer) (reinterpret_cast<uintptr_t>(pointer))
#else
#define WH_CAST(type, value) ((type)(value))
#define WH_ADDRESS(pointer) ((uintptr_t)(pointer))
#endif

/* A literal of the library's number type. In C++ a cast from double to double is one too many for
 * -Wuseless-cast; a product with 1 is the number itself, to the bit. */
#if defined(__cplusplus) && !defined(WH_FLOAT)
#define WH_REAL(literal) (1.0 * (literal))
#else
#define WH_REAL(literal) WH_CAST(wh_real_t, literal)
#endif

/* It follows `typedef enum`: four bytes, whatever -fshort-enums and similar options say on either side.
 * Debuggers still show the names, and C++ takes the fields without a cast. A compiler without such a word
 * is refused if its enumerations are shorter. */
#if (defined(__cplusplus) && __cplusplus >= 201103L) ||                                                      \
    (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L)
#define WH_FOUR_BYTES : int32_t
#elif defined(__GNUC__) || defined(__TINYC__)
#define WH_FOUR_BYTES __attribute__((mode(SI)))
#else
#define WH_FOUR_BYTES
typedef enum { WH_ENUM_SHORTEST } wh_enum_shortest_t;
typedef char wh_enumerations_need_4_bytes[sizeof(wh_enum_shortest_t) == 4 ? 1 : -1]; /* IAR: --enum_is_int */
#endif

/* It rises when a struct or a function changes so that headers and library of two versions do not match. */
#define WH_ABI 2

/* The features that the library is built without, as the ends of its symbols. */
#if defined(WH_WITHOUT_SWEEP) && defined(WH_WITHOUT_INDEX)
#define WH_SYMBOL_FEATURES _without_sweep_index
#elif defined(WH_WITHOUT_SWEEP)
#define WH_SYMBOL_FEATURES _without_sweep
#elif defined(WH_WITHOUT_INDEX)
#define WH_SYMBOL_FEATURES _without_index
#else
#define WH_SYMBOL_FEATURES /* nothing: the complete library */
#endif
/* The ends for own counts of axes and grippers. */
#if defined(WH_MOST_AXES) || defined(WH_MOST_GRIPPERS)
#define WH_SYMBOL_MOST WH_SYMBOL_COUNTS(WH_AXES, WH_GRIPPERS)
#define WH_SYMBOL_COUNTS(axes, grippers) WH_SYMBOL_COUNTS_(axes, grippers)
#define WH_SYMBOL_COUNTS_(axes, grippers) _most_##axes##_##grippers
#else
#define WH_SYMBOL_MOST /* nothing: the default counts */
#endif

/* It follows each prototype. For the linker wh_pose_validate is wh_pose_validate_2d: number type, ABI,
 * features and counts end the name. So headers and a library that do not match do not link, in any way of
 * linking. For example "undefined reference to wh_pose_validate_2d" from a float library means that
 * WH_FLOAT is missing where the headers are included. Debuggers show the name of the source. A compiler
 * that cannot rename a symbol, or -DWH_SYMBOL_MACROS, gets these names by macros: math/symbols.h. */
#if (defined(__GNUC__) || defined(__TINYC__)) && !defined(WH_SYMBOL_MACROS)
#if defined(__USER_LABEL_PREFIX__)
#define WH_SYMBOL_START WH_TEXT(__USER_LABEL_PREFIX__)
#else
#define WH_SYMBOL_START ""
#endif
#define WH_SYMBOL(name)                                                                                      \
    __asm__(WH_SYMBOL_START #name "_" WH_TEXT(WH_ABI) WH_SYMBOL_NUMBER WH_TEXT(WH_SYMBOL_FEATURES)           \
                WH_TEXT(WH_SYMBOL_MOST))
#else
#define WH_SYMBOL(name)
#define WH_SYMBOL_RENAMED(name) WH_SYMBOL_JOIN(name, WH_ABI, WH_SYMBOL_FEATURES, WH_SYMBOL_MOST)
#define WH_SYMBOL_JOIN(name, abi, features, most) WH_SYMBOL_JOIN_(name, abi, features, most)
#if defined(WH_FLOAT)
#define WH_SYMBOL_JOIN_(name, abi, features, most) name##_##abi##f##features##most
#else
#define WH_SYMBOL_JOIN_(name, abi, features, most) name##_##abi##d##features##most
#endif
#include "symbols.h"
#endif

/* Functions in headers have no symbol that could end with the number type. So each file of yours that gcc
 * compiles tells the linker its type. Two files that differ in WH_FLOAT, or in the ABI, do not link:
 * "multiple definition of waferhand_files_differ_in_WH_FLOAT". It takes no byte in the program. In clang
 * with -flto it would refuse good files, and no macro shows that. A program that has both types on purpose,
 * in files that share no struct of the library, defines WH_BOTH_NUMBERS in the files of one type. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__ELF__) && !defined(WH_BUILDING_LIBRARY) &&         \
    !defined(WH_BOTH_NUMBERS)
#define WH_NUMBER_OF_FILE "waferhand_" WH_TEXT(WH_ABI) WH_SYMBOL_NUMBER
/* With -flto several files become one for the assembler; hence the conditions. */
__asm__(".ifndef .L" WH_NUMBER_OF_FILE "\n"
        ".ifdef waferhand_files_differ_in_WH_FLOAT\n"
        ".error \"waferhand: files differ in WH_FLOAT\"\n"
        ".else\n"
        ".set .L" WH_NUMBER_OF_FILE ", 1\n"
        ".pushsection .rodata.waferhand,\"aG\",%progbits," WH_NUMBER_OF_FILE ",comdat\n"
        ".globl waferhand_files_differ_in_WH_FLOAT\n"
        ".hidden waferhand_files_differ_in_WH_FLOAT\n"
        "waferhand_files_differ_in_WH_FLOAT:\n"
        ".popsection\n"
        ".endif\n"
        ".endif");
#endif

/* Each public header begins and ends with these macros. They give C's names in C++, and equal bits of the
 * inline functions, also if -ffp-contract=off was forgotten. The file that includes them keeps its own
 * settings. Forgetting the flag has a cost on a machine that fuses: gcc calls these functions instead of
 * inlining them, and clang, where it knows no float_control, compiles all of the file without contraction.
 * clang's own -ffp-contract=fast overrules every pragma, so it is forbidden. -DWH_NO_CONTRACTION says that
 * the flags are set: gcc for Arm cannot detect them, and would call functions even then. */
#if defined(WH_NO_CONTRACTION)
#define WH_SAME_BITS_BEGIN
#define WH_SAME_BITS_END
#elif defined(__clang__) && (defined(__x86_64__) || defined(__i386__))
#define WH_SAME_BITS_BEGIN _Pragma("float_control(push)") _Pragma("STDC FP_CONTRACT OFF")
#define WH_SAME_BITS_END _Pragma("float_control(pop)")
#elif defined(__clang__)
#define WH_SAME_BITS_BEGIN _Pragma("STDC FP_CONTRACT OFF")
#define WH_SAME_BITS_END
#elif defined(__GNUC__) && (defined(__FP_FAST_FMA) || defined(__FP_FAST_FMAF))
#define WH_SAME_BITS_BEGIN                                                                                   \
    _Pragma("GCC push_options") _Pragma("GCC optimize (\"fp-contract=off,no-tree-slp-vectorize\")")
#define WH_SAME_BITS_END _Pragma("GCC pop_options")
#else
#define WH_SAME_BITS_BEGIN
#define WH_SAME_BITS_END
#endif
/* The shared library exports the declarations of public headers. */
#if defined(WH_BUILDING_LIBRARY) && defined(__GNUC__)
#define WH_PUBLIC_BEGIN _Pragma("GCC visibility push(default)")
#define WH_PUBLIC_END _Pragma("GCC visibility pop")
#else
#define WH_PUBLIC_BEGIN
#define WH_PUBLIC_END
#endif
#if defined(__cplusplus)
#define WH_HEADER_BEGIN WH_SAME_BITS_BEGIN WH_PUBLIC_BEGIN extern "C" {
#define WH_HEADER_END                                                                                        \
    }                                                                                                        \
    WH_PUBLIC_END WH_SAME_BITS_END
#else
#define WH_HEADER_BEGIN WH_SAME_BITS_BEGIN WH_PUBLIC_BEGIN
#define WH_HEADER_END WH_PUBLIC_END WH_SAME_BITS_END
#endif

WH_HEADER_BEGIN

/* The version of the linked library, WH_VERSION at its build: a constant string. */
const char *wh_version(void) WH_SYMBOL(wh_version);

WH_HEADER_END

/* Invariants that the library relies on. A firmware may define its own macro before including any header,
 * or switch them on with -DWH_DEBUG; without either they cost nothing. */
#if !defined(WH_ASSERT)
#if defined(WH_DEBUG)
#include <assert.h>
#define WH_ASSERT(condition) assert(condition)
#else
#define WH_ASSERT(condition) ((void)0)
#endif
#endif

/* Asserts wh_grasp_is_consistent of a table, after each call that changes one. It is a separate macro,
 * because it costs a test of every wafer and gripper. -DWH_DEBUG_TABLE switches it on, or the firmware
 * defines it. */
#if !defined(WH_ASSERT_CONSISTENT)
#if defined(WH_DEBUG_TABLE)
#include <assert.h>
#define WH_ASSERT_CONSISTENT(table) assert(wh_grasp_is_consistent(table))
#else
#define WH_ASSERT_CONSISTENT(table) ((void)0)
#endif
#endif

/* Keeps a function's memory off its callers' stack, so that one part of a step does not carry what another
 * needs. It costs a call and changes no result. */
#if defined(__GNUC__)
#define WH_OUT_OF_LINE __attribute__((noinline))
#else
#define WH_OUT_OF_LINE
#endif

/* "No wafer", "no gripper": an index that nothing has. */
#define WH_NONE (-1)

/* True if `index` is one of 0 to count - 1. */
static inline bool wh_is_index(int32_t index, size_t count) {
    return index >= 0 && WH_CAST(size_t, index) < count;
}

/* An array by its address: null and 0 for one that is not there. Addresses are compared as numbers, for
 * pointers into different arrays have no order in C. */
typedef struct {
    const void *first;
    size_t bytes;
} wh_extent_t;

/* True if the two share a byte. */
static inline bool wh_extents_overlap(wh_extent_t a, wh_extent_t b) {
    const uintptr_t one = WH_ADDRESS(a.first);
    const uintptr_t other = WH_ADDRESS(b.first);
    return one <= other ? other - one < a.bytes && b.bytes > 0 : one - other < b.bytes && a.bytes > 0;
}

#endif
