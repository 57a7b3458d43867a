#include "live_files.h"

#include <stdio.h>
#include <stdlib.h>

#include "../report/page.h"
#include "../text/array.h"

/* Each with its template. */
static const struct {
    const char *path, *type, *name;
} files[WH_LIVE_FILES] = {
    {"/", "text/html; charset=utf-8", WH_PAGE_LIVE},
    {"/page.js", "text/javascript; charset=utf-8", WH_PAGE_SCRIPTS},
    {"/page.css", "text/css; charset=utf-8", WH_PAGE_STYLE},
    {"/foreign.js", "text/javascript; charset=utf-8", WH_PAGE_FOREIGN},
};

bool wh_live_files_make(wh_live_files_t *made, const char *title) {
    char message[WH_PAGE_MESSAGE_BYTES] = "";
    bool good = true;
    for (size_t i = 0; good && i < WH_LIVE_FILES; ++i) {
        size_t size = 0;
        FILE *out = wh_memory_need(open_memstream(&made->texts[i], &size));
        good = wh_page_write(out, files[i].name, title, "", 0, message);
        (void)fclose(out);
        made->files[i] = (wh_http_file_t){files[i].path, files[i].type, wh_memory_need(made->texts[i]), size};
    }
    if (!good) {
        (void)fprintf(stderr, "--page: %s\n", message);
    }
    return good;
}

void wh_live_files_free(wh_live_files_t *made) {
    for (size_t i = 0; i < WH_LIVE_FILES; ++i) {
        free(made->texts[i]);
    }
}
