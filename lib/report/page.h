/* The page of a report, of a study or of a flow by times alone is one HTML file with everything that it
 * needs, because it is read from disk, without a network. The page of a live cell is several files, which
 * its server hands out: so the browser can be told to run nothing else.
 *
 * A page is a template such as lib/report/page/report.html.in, built into the program. A name between two @
 * in it stands for a file: another one of lib/report/page, which may be a template too, or JavaScript that
 * others wrote (three.min.js, OrbitControls.js, GLTFLoader.js, dygraph.min.js, dygraph.min.css). The
 * program reads the latter when it makes the page, from where the distribution puts them:
 * /usr/share/javascript, unless the program was built with another JAVASCRIPT= or the environment has
 * WAFERHAND_JAVASCRIPT. @title@ is the page's title. @document@ is the object of report/document.h or
 * report/study_document.h, packed (text/packed.h): an hour's run shrinks to a seventh. @policy@ and @rerun@
 * are empty but in a page that plays its run again, which has @cell@ and @engine@ as well.
 */
#ifndef WH_REPORT_PAGE_H
#define WH_REPORT_PAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define WH_PAGE_MESSAGE_BYTES 600

#define WH_PAGE_REPORT "report.html.in"
#define WH_PAGE_STUDY "study.html.in"
#define WH_PAGE_FLOW "flow.html.in"
/* A live cell's page, and what it asks for: /page.js, /page.css and /foreign.js. */
#define WH_PAGE_LIVE "live.html.in"
#define WH_PAGE_SCRIPTS "live.js.in"
#define WH_PAGE_STYLE "style.css.in"
#define WH_PAGE_FOREIGN "foreign.js.in"

/* Writes the page of this name. `document` is text of `size` bytes, as wh_document_write or
 * wh_study_document_write makes it. Returns false, and the reason in `message`, when a file is missing. The
 * owner of `out` asks whether it took all. */
bool wh_page_write(FILE *out, const char *name, const char *title, const char *document, size_t size,
                   char message[WH_PAGE_MESSAGE_BYTES]);

/* All that a page can hold. With `cell` and `engine` that of a report or of a flow plays its run again
 * (play/reel.h has both); null: it does not. */
typedef struct {
    const char *title, *document;
    size_t document_size;
    const char *cell, *engine;
} wh_page_content_t;

/* Likewise, with all of it. */
bool wh_page_write_content(FILE *out, const char *name, const wh_page_content_t *content,
                           char message[WH_PAGE_MESSAGE_BYTES]);

#endif
