# What no tool reports: extensions of the language in the embedded library, names that are reserved, and suppressions, which
# belong into lib/DEVIATIONS.md.

function report(rule) {
    print FILENAME ":" FNR ":1: warning: " $0 " [" rule "]"
}

FILENAME ~ embedded && /__attribute__|__builtin|__extension__|__asm/ {
    report("misra-c2012-1.2")
}
/^(typedef .*|})[ *][a-z0-9_]*_t;/ && FILENAME ~ /^lib/ {
    report("posix-suffix")
}
/NOLINT|cppcheck-suppress|pragma +(GCC|clang)/ {
    report("inline-suppression")
}
