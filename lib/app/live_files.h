/* The files that the server of a live page gives. */
#ifndef WH_APP_LIVE_FILES_H
#define WH_APP_LIVE_FILES_H

#include "../view/http.h"

enum { WH_LIVE_FILES = 4 };

/* Zero it to begin with. */
typedef struct {
    wh_http_file_t files[WH_LIVE_FILES];
    char *texts[WH_LIVE_FILES]; /* theirs */
} wh_live_files_t;

/* Makes them; false, with the reason on standard error: this program was built without the page. To be freed
 * in either case. */
bool wh_live_files_make(wh_live_files_t *made, const char *title);
void wh_live_files_free(wh_live_files_t *made);

#endif
