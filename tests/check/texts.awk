# Finds what no tool reports: language extensions in the embedded library, reserved names, and suppressions, which belong into
# lib/DEVIATIONS.md. It also finds what the formatter leaves, which neither shortens nor mends a comment, and large structs. Run with
# LC_ALL=C.

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

# A struct or a union has at most 25 members, so that it has one subject. Each member ends with a semicolon or a comma; those of
# a nested struct count there. The finding stands at the closing line. C alone: classes of C++ have functions.
function bare(line) {
    gsub(/'\\?.'/, "", line)
    gsub(/"([^"\\]|\\.)*"/, "", line)
    if (in_comment && !sub(/^.*\*\//, "", line)) {
        return ""
    }
    gsub(/\/\*([^*]|\*+[^*\/])*\*+\//, "", line)
    in_comment = sub(/\/\*.*/, "", line)
    return line
}
function count_members(line) {
    if (line ~ /^ *\}/) {
        if (members[depth] > 25) {
            report("struct-members")
        }
        --depth
    } else if (line ~ /\{/ && line !~ /\}/) {
        members[++depth] = 0
        return
    }
    line = begun line
    while (gsub(/\([^()]*\)|\{[^{}]*\}/, "", line)) {
    }
    # A function's arguments go on in the next line.
    begun = line ~ /\(/ ? line : ""
    members[depth] += begun == "" ? gsub(/[;,]/, "", line) : 0
}
FNR == 1 {
    depth = in_comment = 0
    begun = ""
}
FILENAME !~ /[.][ch]$/ {
    next
}
{
    line = bare($0)
}
depth > 0 || (line ~ /(^|[ (])(struct|union)( [A-Za-z_0-9]+)* *\{/ && line !~ /\}/) {
    count_members(line)
}
