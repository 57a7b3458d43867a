#include "words.h"

#include <string.h>
#include <strings.h>

#define ROBOT (1U << WH_MECHANISM_ROBOT)
#define ALIGNER (1U << WH_MECHANISM_ALIGNER)
#define LOAD_PORT (1U << WH_MECHANISM_LOAD_PORT)
#define ANY (ROBOT | ALIGNER | LOAD_PORT)

const char *const wh_mechanism_names[WH_MECHANISMS + 1] = {"cell", "robot", "aligner", "load_port", NULL};

/* The set is empty for words that only the whole cell's controller does. */
const wh_word_t wh_words[] = {{"GET", WH_WORD_ACTION, ROBOT, false},
                              {"PUT", WH_WORD_ACTION, ROBOT, false},
                              {"CONTINUE", WH_WORD_ACTION, ROBOT, false},
                              {"SWAP", WH_WORD_ACTION, ROBOT, false},
                              {"READY", WH_WORD_ACTION, ROBOT, false},
                              {"PATTERN", WH_WORD_ACTION, ROBOT, false},
                              {"MAP", WH_WORD_ACTION, ROBOT | LOAD_PORT, false},
                              {"TEACH", WH_WORD_ACTION, ROBOT, false},
                              {"SET_STATION", WH_WORD_ACTION, ROBOT, false},
                              {"HOME", WH_WORD_ACTION, ROBOT, false},
                              {"RECOVER", WH_WORD_ACTION, ROBOT, false},
                              {"STOP", WH_WORD_STOP, ANY, false},
                              {"RESET", WH_WORD_ACTION, 0, false},
                              {"SAVE", WH_WORD_ACTION, 0, false},
                              {"RESTORE", WH_WORD_ACTION, 0, false},
                              {"UNDO", WH_WORD_ACTION, 0, false},
                              {"STATUS", WH_WORD_ALWAYS, ANY, false},
                              {"VERSION", WH_WORD_ALWAYS, ANY, false},
                              {"ROTATE", WH_WORD_ACTION, ALIGNER, false},
                              {"EDGE_SCAN", WH_WORD_ACTION, ALIGNER, false},
                              {"ALIGN", WH_WORD_ACTION, ALIGNER, false},
                              {"CALIBRATE", WH_WORD_ACTION, ROBOT | ALIGNER, false},
                              {"LIFT", WH_WORD_ACTION, ALIGNER, false},
                              {"VALVE", WH_WORD_ACTION, ROBOT | ALIGNER, false},
                              {"MOVE", WH_WORD_ACTION, ROBOT, false},
                              {"FLIP", WH_WORD_ACTION, ROBOT | ALIGNER, false},
                              {"LINE", WH_WORD_ACTION, ROBOT, false},
                              {"CONTROLLER", WH_WORD_CONTROLLER, ROBOT, false},
                              {"WAIT", WH_WORD_ACTION, ANY, false},
                              {"WAIT_FOR", WH_WORD_ACTION, ROBOT | LOAD_PORT, false},
                              {"PUMP", WH_WORD_ACTION, ROBOT, false},
                              {"CARRIER", WH_WORD_ACTION, LOAD_PORT, false},
                              {"PORT", WH_WORD_ACTION, LOAD_PORT, false},
                              {"TAKE_AWAY", WH_WORD_ACTION, LOAD_PORT, false},
                              {"OPEN", WH_WORD_ACTION, ALIGNER | LOAD_PORT, false},
                              {"CLOSE", WH_WORD_ACTION, ALIGNER | LOAD_PORT, false},
                              {"FAULT", WH_WORD_ACTION, ANY, false},
                              {"CLEAR", WH_WORD_ACTION, ANY, false},
                              {"ALARM", WH_WORD_ACTION, ANY, false},
                              {"OFFSET", WH_WORD_QUERY, ANY, true},
                              {"HOLDER", WH_WORD_QUERY, ANY, true},
                              {"PROXIMITY", WH_WORD_QUERY, ANY, true},
                              {"MEASURE", WH_WORD_QUERY, ANY, true},
                              {"DISTANCE", WH_WORD_QUERY, ANY, true},
                              {"ANGLE", WH_WORD_QUERY, ANY, true},
                              {"WHERE", WH_WORD_QUERY, ANY, false},
                              {"AXES", WH_WORD_QUERY, ANY, false},
                              {"PORT_MAP", WH_WORD_QUERY, ROBOT | LOAD_PORT, false},
                              {"STATIONS", WH_WORD_QUERY, ANY, false},
                              {"STATION", WH_WORD_QUERY, ROBOT, false},
                              {"HELP", WH_WORD_QUERY, ANY, true},
                              {"HOLD", WH_WORD_HOLD, ANY, false},
                              {"RESUME", WH_WORD_RESUME, ANY, false},
                              {"RATE", WH_WORD_RATE, ANY, true},
                              {"TELL", WH_WORD_TELL, 0, true},
                              {"ACKN", WH_WORD_ACKN, ANY, false},
                              {"LOCAL", WH_WORD_LOCAL, ANY, false}};

const size_t wh_word_count = sizeof wh_words / sizeof wh_words[0];

const wh_word_t *wh_word_of(const char *line) {
    static const char blanks[] = " \t\n\v\f\r";
    const char *begin = line + strspn(line, blanks);
    const size_t length = strcspn(begin, blanks);
    for (size_t i = 0; i < wh_word_count; ++i) {
        if (strlen(wh_words[i].name) == length && strncasecmp(begin, wh_words[i].name, length) == 0) {
            return &wh_words[i];
        }
    }
    return NULL;
}
