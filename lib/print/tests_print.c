#include "tests_print.h"

#include <stdlib.h>
#include <string.h>

#include "../text/utf8.h"
#include "unlooked.h"

static const struct {
    const char *word;
    wh_ink_t ink;
    const char *element; /* of JUnit's XML; null: none */
} verdicts[WH_TEST_VERDICTS] = {
    [WH_TEST_OK] = {"ok", WH_INK_GOOD, NULL},
    [WH_TEST_FAILED] = {"failed", WH_INK_BAD, "failure"},
    [WH_TEST_BAD] = {"bad", WH_INK_BAD, "error"},
    [WH_TEST_ENDLESS] = {"no end", WH_INK_BAD, "error"},
    [WH_TEST_KILLED] = {"killed", WH_INK_BAD, "error"},
    [WH_TEST_PASSED_OVER] = {"passed over", WH_INK_WARN, "skipped"},
};

const char *wh_test_word(wh_test_verdict_t verdict) {
    return verdicts[verdict].word;
}

bool wh_test_is_bad(wh_test_verdict_t verdict) {
    return verdict != WH_TEST_OK && verdict != WH_TEST_PASSED_OVER;
}

/* --------------------------------------------------------------------------------------------- for people */

/* Calls `put` for each line of a text, without its end. */
static void each_line(const char *text, void (*put)(FILE *out, const char *line), FILE *out) {
    while (text && *text != '\0') {
        const size_t length = strcspn(text, "\n");
        char *line = strndup(text, length);
        put(out, line ? line : "");
        free(line);
        text += text[length] == '\n' ? length + 1 : length;
    }
}

static void put_indented(FILE *out, const char *line) {
    fputs("    ", out);
    wh_style_put(out, line);
    fputc('\n', out);
}

/* A reason may begin with the script's own path. */
static const char *without_path(const wh_test_result_t *result) {
    const size_t length = strlen(result->path);
    const bool begins = strncmp(result->reason, result->path, length) == 0;
    return begins && strncmp(result->reason + length, ": ", 2) == 0 ? result->reason + length + 2
                                                                    : result->reason;
}

/* The errors of a script that is ok, if there are any. */
static void put_caught(const wh_test_result_t *result, FILE *out, const char *before, const char *behind) {
    if (result->verdict == WH_TEST_OK && result->errors > 0) {
        fprintf(out, "%s%llu %s caught%s", before, (unsigned long long)result->errors,
                result->errors == 1 ? "error" : "errors", behind);
    }
}

/* The faults and errors that the script wanted to try, and did not. */
static void put_never_came(const wh_test_result_t *result, FILE *out, const char *before) {
    if (result->never_came) {
        fprintf(out, "%snever came, and so were not tried: %s\n", before, result->never_came);
    }
}

static void put_good(const wh_test_result_t *result, FILE *out) {
    fprintf(out, "%llu %s, ", (unsigned long long)result->expectations,
            result->expectations == 1 ? "expectation" : "expectations");
    if (result->simulated_s > 0) {
        fprintf(out, "%.3f s simulated", result->simulated_s);
    } else {
        fputs("nothing moved", out);
    }
    put_caught(result, out, ", ", "");
}

void wh_test_print(const wh_test_result_t *result, FILE *out, const wh_style_t *style) {
    wh_style_print(style, out, verdicts[result->verdict].ink, "%-11s", wh_test_word(result->verdict));
    fputs("  ", out);
    wh_style_put(out, result->path);
    fputs(": ", out);
    if (result->reason) {
        wh_style_put(out, without_path(result));
    } else {
        put_good(result, out);
    }
    fputc('\n', out);
    put_never_came(result, out, "    ! ");
    if (wh_test_is_bad(result->verdict)) {
        each_line(result->output, put_indented, out);
    }
}

/* Like those of a sweep: in how many scripts nobody looked for collisions, or a flow was cut. */
static void put_unlooked(const wh_test_result_t results[], size_t count, FILE *out, const char *before) {
    wh_print_unlooked_t unlooked = {before, "script", 0, 0, 0, 0};
    for (size_t i = 0; i < count; ++i) {
        unlooked.unchecked += results[i].is_unlooked && !results[i].is_timed ? 1 : 0;
        unlooked.timed += results[i].is_timed ? 1 : 0;
        unlooked.partly += results[i].has_timed ? 1 : 0;
        unlooked.cut += results[i].is_cut ? 1 : 0;
    }
    wh_print_unlooked(&unlooked, out);
}

void wh_test_print_sum(const wh_test_result_t results[], size_t count, FILE *out, const wh_style_t *style) {
    size_t counts[WH_TEST_VERDICTS] = {0};
    for (size_t i = 0; i < count; ++i) {
        ++counts[results[i].verdict];
    }
    const size_t passed_over = counts[WH_TEST_PASSED_OVER];
    const size_t scripts = count - passed_over;
    put_unlooked(results, count, out, "! ");
    fprintf(out, "%zu %s: ", scripts, scripts == 1 ? "script" : "scripts");
    wh_style_print(style, out, scripts > 0 && counts[WH_TEST_OK] == scripts ? WH_INK_GOOD : WH_INK_BAD,
                   "%zu ok", counts[WH_TEST_OK]);
    for (size_t verdict = WH_TEST_FAILED; verdict < WH_TEST_PASSED_OVER; ++verdict) {
        if (counts[verdict] > 0) {
            fprintf(out, ", %zu %s", counts[verdict], verdicts[verdict].word);
        }
    }
    if (passed_over > 0) {
        fprintf(out, "; %zu %s passed over", passed_over, passed_over == 1 ? "file" : "files");
    }
    fputc('\n', out);
}

/* ---------------------------------------------------------------------------------------------------- TAP */

static void put_comment(FILE *out, const char *line) {
    fputs("#   ", out);
    wh_style_put(out, line);
    fputc('\n', out);
}

/* A number sign would begin a directive. */
static void put_tap_name(FILE *out, const char *path) {
    char *name = wh_style_printable(path);
    for (const char *c = name; *c != '\0'; ++c) {
        if (*c == '#') {
            fputc('\\', out);
        }
        fputc((unsigned char)*c, out);
    }
    free(name);
}

void wh_test_print_tap(const wh_test_result_t *result, size_t number, FILE *out) {
    const bool is_bad = wh_test_is_bad(result->verdict);
    if (result->verdict == WH_TEST_PASSED_OVER) {
        fputs("# passed over: ", out);
        wh_style_put(out, result->path);
        fputs(": ", out);
        wh_style_put(out, without_path(result));
        fputc('\n', out);
        return;
    }
    fprintf(out, "%sok %zu - ", is_bad ? "not " : "", number);
    put_tap_name(out, result->path);
    fputc('\n', out);
    put_caught(result, out, "# ", "\n");
    put_never_came(result, out, "# ");
    if (is_bad) {
        fprintf(out, "# %s: ", wh_test_word(result->verdict));
        wh_style_put(out, without_path(result));
        fputc('\n', out);
        each_line(result->output, put_comment, out);
    }
}

void wh_test_print_plan(const wh_test_result_t results[], size_t count, size_t scripts, FILE *out) {
    put_unlooked(results, count, out, "# ");
    fprintf(out, "1..%zu%s\n", scripts, scripts == 0 ? " # no scripts found" : "");
}

/* -------------------------------------------------------------------------------------------------- JUnit */

/* The number of bytes of a character that XML 1.0 does not allow: controls except tab and line ends, U+FFFE
 * and U+FFFF. 0: it is allowed. */
static size_t forbidden_bytes(const char *text) {
    const unsigned char first = (unsigned char)text[0];
    if (first < 0x20 && !strchr("\t\n\r", first)) {
        return 1;
    }
    return memcmp(text, "\xEF\xBF\xBE", 3) == 0 || memcmp(text, "\xEF\xBF\xBF", 3) == 0 ? 3 : 0;
}

static void put_xml_byte(FILE *out, char byte) {
    switch (byte) {
    case '&':
        fputs("&amp;", out);
        break;
    case '<':
        fputs("&lt;", out);
        break;
    case '>':
        fputs("&gt;", out);
        break;
    case '"':
        fputs("&quot;", out);
        break;
    case '\t':
    case '\n':
    case '\r':
        fprintf(out, "&#%d;", byte); /* a reader would make a blank of it in an attribute */
        break;
    default:
        fputc((unsigned char)byte, out);
        break;
    }
}

static void put_xml(FILE *out, const char *text) {
    char *repaired = wh_utf8_repaired(text);
    const char *c = repaired;
    while (*c != '\0') {
        const size_t bad = strnlen(c, 3) < 3 && (unsigned char)*c >= 0x20 ? 0 : forbidden_bytes(c);
        if (bad > 0) {
            fputs("\xEF\xBF\xBD", out);
            c += bad;
        } else {
            put_xml_byte(out, *c++);
        }
    }
    free(repaired);
}

static void put_attribute(FILE *out, const char *name, const char *value) {
    fprintf(out, " %s=\"", name);
    put_xml(out, value);
    fputc('"', out);
}

static void put_case(FILE *out, const wh_test_result_t *result) {
    const char *element = verdicts[result->verdict].element;
    fputs("    <testcase classname=\"waferhand\"", out);
    put_attribute(out, "name", result->path);
    fprintf(out, " time=\"%.3f\">\n", result->wall_s);
    if (element) {
        fprintf(out, "      <%s", element);
        put_attribute(out, "message", without_path(result));
        if (result->verdict != WH_TEST_PASSED_OVER) {
            put_attribute(out, "type", wh_test_word(result->verdict));
        }
        fputs("/>\n", out);
    }
    const bool has_caught = result->verdict == WH_TEST_OK && result->errors > 0;
    if (result->output || has_caught || result->never_came) {
        fputs("      <system-out>", out);
        put_caught(result, out, "", "\n");
        put_never_came(result, out, "");
        put_xml(out, result->output ? result->output : "");
        fputs("</system-out>\n", out);
    }
    fputs("    </testcase>\n", out);
}

bool wh_test_print_junit(const wh_test_result_t results[], size_t count, FILE *out) {
    size_t failures = 0;
    size_t skipped = 0;
    size_t bad = 0;
    double wall_s = 0;
    for (size_t i = 0; i < count; ++i) {
        failures += results[i].verdict == WH_TEST_FAILED ? 1 : 0;
        skipped += results[i].verdict == WH_TEST_PASSED_OVER ? 1 : 0;
        bad += wh_test_is_bad(results[i].verdict) ? 1 : 0;
        wall_s += results[i].wall_s;
    }
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n", out);
    fprintf(out,
            "  <testsuite name=\"waferhand\" tests=\"%zu\" failures=\"%zu\" errors=\"%zu\" skipped=\"%zu\" "
            "time=\"%.3f\">\n",
            count, failures, bad - failures, skipped, wall_s);
    for (size_t i = 0; i < count; ++i) {
        put_case(out, &results[i]);
    }
    fputs("  </testsuite>\n</testsuites>\n", out);
    return fflush(out) == 0 && !ferror(out);
}
