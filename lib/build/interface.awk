# Reads waferhand.h, preprocessed, and writes a C file.
#   make=json     it holds the interface as JSON, as characters: sizes and offsets are whatever the compiler takes for them, so
#                 nothing has to run, and another processor's compiler gives that one's. lib/build/install.mk takes the text out.
#   make=inline   it gives each inline function a symbol of its own, for callers that are not C
# With also=HEADER it includes that header as well; with room=NAME only what that room's headers declare is taken.
# A line of the input that begins with # is a mark of the preprocessor: it names the file of the lines behind it.

function trim(text) {
    gsub(/[ \t\n]+/, " ", text)
    sub(/^ /, "", text)
    sub(/ $/, "", text)
    return text
}

# ------------------------------------------------------------------------------------------------ the JSON in C
# Each character is an item of one array; an expression becomes the digits of its value.
function chars(text,    i, c, line) {
    line = ""
    for (i = 1; i <= length(text); ++i) {
        c = substr(text, i, 1)
        line = line (c == "\n" ? "'\\n'" : c == "'" ? "'\\''" : c == "\\" ? "'\\\\'" : "'" c "'") ","
    }
    print line
}
function value(expression) { print "DIGITS((long)(" expression "))," }
function comma() {
    if (items++ > 0)
        chars(",\n")
}
function quoted(text) {
    gsub(/"/, "\\\"", text)
    return "\"" text "\""
}

# ------------------------------------------------------------------------------------------------------ structs
# "const double x[2], *y;" gives each declarator with the words before all of them.
function put_members(struct, body,    count, parts, i, depth, member, word) {
    items = 0
    member = ""
    depth = 0
    count = split(body, parts, ";")
    for (i = 1; i < count; ++i) {
        member = member parts[i]
        word = parts[i]
        depth += gsub(/{/, "", word) - gsub(/}/, "", word)
        if (depth > 0) {
            member = member ";"
            continue
        }
        put_member(struct, trim(member))
        member = ""
    }
}
function put_member(struct, member,    type, count, names, i) {
    if (member ~ /^(union|struct) ?{/) {
        sub(/ ?{.*}/, "", member)
        split(member, names, " ")
        put_one(struct, names[1], names[2])
    } else if (member ~ /\(\*/) {
        match(member, /\(\*[a-z_0-9]+\)/)
        put_one(struct, substr(member, 1, RSTART) "*" substr(member, RSTART + RLENGTH - 1), substr(member, RSTART + 2, RLENGTH - 3))
    } else {
        count = split(member, names, /, */)
        type = names[1]
        sub(/[ *]*[a-z_A-Z0-9]+ ?(\[.*)?$/, "", type)
        for (i = 1; i <= count; ++i)
            put_declarator(struct, type, i == 1 ? substr(names[1], length(type) + 1) : names[i])
    }
}
function put_declarator(struct, type, declarator) {
    declarator = trim(declarator)
    while (sub(/^\* ?/, "", declarator))
        type = type (type ~ /\*$/ ? "*" : " *")
    while (sub(/^const /, "", declarator))
        type = type " const"
    while (sub(/^\* ?/, "", declarator))
        type = type "*"
    put_one(struct, type, declarator)
}
function put_one(struct, type, declarator,    name, first) {
    type = type == "unsigned" ? "unsigned int" : type
    name = declarator
    sub(/ ?\[.*/, "", name)
    first = declarator
    gsub(/\[[^]]*\]/, "[0]", first)
    first = "(((" struct " *)0)->" first ")"
    comma()
    chars("      {\"name\": " quoted(name) ", \"type\": " quoted(trim(type)) ", \"offset\": ")
    value("offsetof(" struct ", " name ")")
    chars(", \"size\": ")
    value("sizeof(((" struct " *)0)->" name ")")
    if (declarator ~ /\[/) {
        chars(", \"count\": ")
        value("sizeof(((" struct " *)0)->" name ") / sizeof" first)
    }
    chars("}")
}

# ------------------------------------------------------------------------------------------------- enumerations
function put_values(body,    count, parts, i) {
    items = 0
    count = split(body, parts, ",")
    for (i = 1; i <= count; ++i) {
        sub(/=.*/, "", parts[i])
        if (trim(parts[i]) == "")
            continue
        if (items++ > 0)
            chars(", ")
        chars(quoted(trim(parts[i])) ": ")
        value(trim(parts[i]))
    }
}

# ---------------------------------------------------------------------------------------------------- functions
# Sets `called`, `returned`, `taken` (the parameters between the outer brackets) and `symbol`. Returns 0 for something else.
function take_function(statement,    rest) {
    symbol = ""
    rest = statement
    if (sub(/.*__asm__ ?\(/, "", rest))
        while (match(rest, /"[^"]*"/)) {
            symbol = symbol substr(rest, RSTART + 1, RLENGTH - 2)
            rest = substr(rest, RSTART + RLENGTH)
        }
    sub(/.*wh_/, "wh_", symbol)
    sub(/ ?__asm__.*/, "", statement)
    sub(/ ?{.*/, "", statement)
    sub(/^(static |inline |extern |__inline__ |__inline )+/, "", statement)
    if (!match(statement, /wh_[a-z0-9_]+ ?\(/))
        return 0
    called = substr(statement, RSTART, RLENGTH - 1)
    sub(/ $/, "", called)
    returned = trim(substr(statement, 1, RSTART - 1))
    taken = substr(statement, RSTART + RLENGTH)
    sub(/\)[^)]*$/, "", taken)
    taken = trim(taken)
    if (symbol != "")
        ending = substr(symbol, length(called) + 1)
    else
        symbol = called ending
    return 1
}
function arguments(taken,    count, parts, i, list) {
    list = ""
    count = taken == "void" ? 0 : split(taken, parts, /, */)
    for (i = 1; i <= count; ++i) {
        sub(/ ?\[.*/, "", parts[i])
        match(parts[i], /[a-z_A-Z0-9]+ ?$/)
        list = list (i > 1 ? ", " : "") trim(substr(parts[i], RSTART))
    }
    return list
}
function put_function(statement,    count, parts, k, text) {
    take_function(statement)
    comma()
    chars("    {\"name\": " quoted(called) ", \"symbol\": " quoted(symbol) ", \"returns\": " quoted(returned) ", \"takes\": [")
    count = taken == "void" ? 0 : split(taken, parts, /, */)
    for (k = 1; k <= count; ++k) {
        text = parts[k]
        if (text ~ /\[/)
            sub(/[a-z_A-Z0-9]+ ?\[.*/, "*", text)
        else
            sub(/[a-z_A-Z0-9]+$/, "", text)
        chars((k > 1 ? ", " : "") quoted(trim(text)))
    }
    chars("]}")
}
# Only the statement that it is given has this name.
function put_inline(statement,    list, types) {
    take_function(statement)
    list = arguments(taken)
    types = returned " wh_symbol_of_" called "(" taken ")"
    print types " __asm__(\"" symbol "\");"
    print types " {"
    print "    " (returned == "void" ? "" : "return ") called "(" list ");"
    print "}"
}

# ------------------------------------------------------------------------------------------------- statements
function take_typedef(statement,    body, name) {
    body = statement
    if (!sub(/^[^{]*{/, "", body))
        return
    name = trim(substr(body, match(body, /}[^}]*$/) + 1))
    sub(/}[^}]*$/, "", body)
    sub(/;$/, "", name)
    name = trim(name)
    if (name !~ /^wh_[a-z0-9_]+$/ || name ~ /_sample_t$/ || name == "wh_unpacked_t")
        return
    bodies[++types] = body
    names[types] = name
    is_enum[types] = statement ~ /^typedef enum/
}
# "struct wh_link { ... };" has its name before its body.
function take_struct(statement,    body, name) {
    name = statement
    if (statement !~ /^struct wh_[a-z0-9_]+ ?{/)
        return
    sub(/^struct /, "", name)
    sub(/ ?{.*/, "", name)
    body = statement
    sub(/^[^{]*{/, "", body)
    sub(/}[^}]*$/, "", body)
    bodies[++types] = body
    names[types] = name "_t"
    is_enum[types] = 0
}
function take(statement) {
    statement = trim(statement)
    gsub(/_Bool/, "bool", statement)
    if (statement ~ /^typedef/)
        take_typedef(statement)
    else if (statement ~ /^struct/)
        take_struct(statement)
    else if (statement ~ /^enum ?{/ && statement ~ /WH_/)
        constants = constants (constants == "" ? "" : ",") substr(statement, index(statement, "{") + 1, index(statement, "}") - index(statement, "{") - 1)
    else if (statement ~ /(^| )inline /) {
        if (statement ~ /[ *]wh_[a-z0-9_]+ ?\(/ && statement !~ /wh_refuse_fast_math/)
            inlines[++inline_count] = statement
    } else if (statement !~ /^__asm__/ && take_function(statement))
        functions[++function_count] = statement
}

/^[ \t]*#/ {
    if (match($0, /"[^"]*"/))
        is_apart = room != "" && substr($0, RSTART + 1, RLENGTH - 2) !~ ("(^|/)" room "/[a-z_]+\\.h$")
    next
}
is_apart { next }
{
    text = text " " $0
    while (match(text, /[{};]/)) {
        c = substr(text, RSTART, 1)
        whole = whole substr(text, 1, RSTART)
        text = substr(text, RSTART + 1)
        depth += c == "{" ? 1 : c == "}" ? -1 : 0
        if (depth == 0 && (c == ";" || (c == "}" && whole ~ /(^| )inline /))) {
            take(whole)
            whole = ""
        }
    }
}

function put_types(wanted,    i, first) {
    first = 1
    for (i = 1; i <= types; ++i)
        if (is_enum[i] == wanted) {
            chars((first ? "" : ",\n") "    " quoted(names[i]) ": {")
            first = 0
            if (wanted) {
                put_values(bodies[i])
                chars("}")
            } else {
                chars("\"size\": ")
                value("sizeof(" names[i] ")")
                chars(", \"members\": [\n")
                put_members(names[i], bodies[i])
                chars("]}")
            }
        }
}
END {
    macros = (also ? "WH_CONVEX_POINTS,WH_WORLD_GRIPPERS,WH_WORLD_ARMS,WH_WORLD_NO_ARM,WH_WORLD_DOORS,WH_WORLD_MOVING,WH_CURVE_BINS," : "") "WH_OK,WH_NONE,WH_AXES,WH_GRIPPERS,WH_EVENTS_PER_GRIPPER,WH_EVENT_KINDS,WH_EVENT_TEXT_SIZE,WH_SLICE_EVENTS,WH_FAULTS,WH_COMMAND_FAULTS,WH_DOORS"
    print "/* Written by lib/build/interface.awk. */"
    print "#include <stddef.h>"
    print "#include \"waferhand.h\""
    if (also)
        print "#include \"" also "\""
    print "#if defined(__GNUC__)\n#pragma GCC visibility push(default)\n#endif"
    if (make == "inline") {
        for (i = 1; i <= inline_count; ++i)
            put_inline(inlines[i])
        exit
    }
    print "#define DIGIT(n, unit) ((n) >= (unit) || ((n) < 0 && -(n) >= (unit)) ? (char)('0' + ((n) < 0 ? -(n) : (n)) / (unit) % 10) : ' ')"
    print "#define DIGITS(n) (n) < 0 ? '-' : ' ', DIGIT(n, 10000000), DIGIT(n, 1000000), DIGIT(n, 100000), DIGIT(n, 10000), \\"
    print "    DIGIT(n, 1000), DIGIT(n, 100), DIGIT(n, 10), (char)('0' + ((n) < 0 ? -(n) : (n)) % 10)"
    print "const char waferhand_interface[] = {"
    chars("\n@begin\n{\"format\": 1, \"version\": " quoted(version) ", \"abi\": ")
    value("WH_ABI")
    chars(", \"real\": " quoted(real) ", \"pointer\": ")
    value("sizeof(void *)")
    chars(",\n  \"structs\": {\n")
    put_types(0)
    chars("},\n  \"enumerations\": {\n")
    put_types(1)
    chars("},\n  \"constants\": {")
    put_values(constants "," macros)
    chars("},\n  \"functions\": [\n")
    items = 0
    for (i = 1; i <= function_count; ++i)
        put_function(functions[i])
    for (i = 1; i <= inline_count; ++i)
        put_function(inlines[i])
    chars("]}\n@end\n")
    print "0};"
}
