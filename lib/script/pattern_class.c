/* Which characters a class or a set of a pattern stands for (in the "C" locale). */
#include <ctype.h>

#include "pattern.h"

bool wh_pattern_in_class(int c, int letter) {
    static const struct {
        char letter;
        int (*contains)(int c);
    } classes[] = {{'a', isalpha}, {'c', iscntrl}, {'d', isdigit}, {'g', isgraph}, {'l', islower},
                   {'p', ispunct}, {'s', isspace}, {'u', isupper}, {'w', isalnum}, {'x', isxdigit}};
    for (size_t i = 0; i < sizeof classes / sizeof classes[0]; ++i) {
        if (classes[i].letter == tolower(letter)) {
            return (classes[i].contains(c) != 0) != (isupper(letter) != 0);
        }
    }
    return letter == c;
}

bool wh_pattern_in_set(int c, const char *p, const char *last) {
    bool inside = true;
    if (p[1] == '^') {
        inside = false;
        ++p;
    }
    while (++p < last) {
        if (*p == '%') {
            ++p;
            if (wh_pattern_in_class(c, (unsigned char)*p)) {
                return inside;
            }
        } else if (p[1] == '-' && p + 2 < last) {
            if ((unsigned char)p[0] <= c && c <= (unsigned char)p[2]) {
                return inside;
            }
            p += 2;
        } else if ((unsigned char)*p == c) {
            return inside;
        }
    }
    return !inside;
}
