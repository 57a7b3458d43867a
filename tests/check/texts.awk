# Finds what no tool reports: language extensions in the embedded library, reserved names, and suppressions, which belong into
# lib/DEVIATIONS.md. It also finds what the formatter leaves, which neither shortens nor mends a comment. Run with LC_ALL=C.

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

# These rules apply to files that match `tidy`. Continuation bytes of UTF-8 characters are not counted.
FNR == 1 {
    type_alone = 0
}
FILENAME ~ tidy {
    line = $0
    gsub(/[\200-\277]/, "", line)
    if (length(line) > 110) {
        report("line-length")
    }
    if (line ~ /^ *\/\* ----/ && line !~ /\*\/$/) {
        report("broken-banner")
    }
    # A type stands alone on a line and its member on the next: the comment behind the member was too long.
    if (type_alone && line ~ /^ +\**[a-z_0-9]+(\[.*\])*;/) {
        report("torn-member")
    }
    type_alone = line ~ /^ +(const )?[a-z_0-9]+_t$/
}
