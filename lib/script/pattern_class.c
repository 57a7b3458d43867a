/* Which characters a class or a set of a pattern stands for (in the "C" locale). */
#include <ctype.h>

#include "script/pattern.h"

bool wh_pattern_in_class(int c, int letter) {
    int is = 0;
    switch (tolower(letter)) {
    case 'a':
        is = isalpha(c);
        break;
    case 'c':
        is = iscntrl(c);
        break;
    case 'd':
        is = isdigit(c);
        break;
    case 'g':
        is = isgraph(c);
        break;
    case 'l':
        is = islower(c);
        break;
    case 'p':
        is = ispunct(c);
        break;
    case 's':
        is = isspace(c);
        break;
    case 'u':
        is = isupper(c);
        break;
    case 'w':
        is = isalnum(c);
        break;
    case 'x':
        is = isxdigit(c);
        break;
    default:
        return letter == c;
    }
    return isupper(letter) ? is == 0 : is != 0;
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
