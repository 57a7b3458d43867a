/* Many test programs in one: linking each by itself takes longer than compiling it. The build
 * defines WH_TESTS(X) as the list X(FUNCTION, "unit/ROOM/NAME_test") and so on, and links the
 * program under each of these names; the name that it is called by selects the test. */
#ifndef WH_TESTS_SUPPORT_TOGETHER_H
#define WH_TESTS_SUPPORT_TOGETHER_H

#include <stdio.h>
#include <string.h>

#define WH_TOGETHER_DECLARE(function, name) int function(void);
WH_TESTS(WH_TOGETHER_DECLARE)
#undef WH_TOGETHER_DECLARE

static const struct {
    const char *name;
    int (*run)(void);
} wh_together_tests[] = {
#define WH_TOGETHER_ROW(function, name) {name, function},
    WH_TESTS(WH_TOGETHER_ROW)
#undef WH_TOGETHER_ROW
};

static int wh_together_is(const char *path, const char *name) {
    const size_t length = strlen(path);
    const size_t end = strlen(name);
    return length >= end && strcmp(path + length - end, name) == 0;
}

int main(int argc, char **argv) {
    const size_t count = sizeof wh_together_tests / sizeof wh_together_tests[0];
    for (size_t i = 0; argc > 0 && i < count; ++i) {
        if (wh_together_is(argv[0], wh_together_tests[i].name)) {
            return wh_together_tests[i].run();
        }
    }
    fprintf(stderr, "call it by the name of one of its tests:\n");
    for (size_t i = 0; i < count; ++i) {
        fprintf(stderr, "  %s\n", wh_together_tests[i].name);
    }
    return 2;
}

#endif
