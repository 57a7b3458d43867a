/* A page that plays its run again with other parameters carries a reel: the script, the files that were read,
 * and the engine of `make playground`.
 *
 * Host code: it ends the program if out of memory.
 */
#ifndef WH_PLAY_REEL_H
#define WH_PLAY_REEL_H

#include "../mcs/script_run.h"
#include "../report/page.h"

/* Zero it at the beginning. */
typedef struct {
    char **paths; /* of the files that were read, or looked for; each once */
    size_t count, capacity;
    char *engine; /* HTML */
    char *cell;   /* packed JSON */
} wh_reel_t;

/* Reads the engine: report_engine.html in the folder `playground` beside the program, or where `make install`
 * puts it. False, with the reason in `message`, if it is not there or of another version. */
bool wh_reel_open(wh_reel_t *reel, char message[WH_PAGE_MESSAGE_BYTES]);

/* From here on it takes notice of each file that is read as an input, in place of any other listener. */
void wh_reel_hear(wh_reel_t *reel);

/* Packs the cell once the run is over: { script, parameters: [NAME=VALUE], budget, files: { PATH: text or
 * { base64 } } }. Files that are gone, and what is no plain file, are left out. */
void wh_reel_pack(wh_reel_t *reel, const wh_script_run_options_t *run);

/* From here on it hears nothing. A reel that is all zero stays so. */
void wh_reel_close(wh_reel_t *reel);

#endif
