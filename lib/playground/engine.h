/* The engine of the playground: Waferhand within a web page. JavaScript calls it; its files are in memory.
 *
 * An instance plays one script and is thrown away, so that nothing of a run reaches the next one. Texts are
 * UTF-8 and belong to the engine, until its next call of the same name. It ends the instance if out of
 * memory.
 */
#ifndef WH_PLAYGROUND_ENGINE_H
#define WH_PLAYGROUND_ENGINE_H

#include <stddef.h>

/* Plays a script. The request is { script (a path), parameters [NAME=VALUE], budget (steps) }. The answer is
 *   outcome   "met", "failed" or "bad_input", the exit statuses 0, 1 and 2 of `waferhand run`
 *   message   what standard error would have said, or null
 *   hash      16 hex digits, or null: nothing was played
 *   layout    the layout's path, or null
 *   inputs    [path]: all files that were read or looked for
 *   tables    what was printed: the script's own lines, then the tables
 *   shown     why there is no document, or null: there is one
 *   flow      true: the document is that of a flow by times alone, which another page shows
 *   unmet     [{ line, text }]: expectations that were not met
 *   others    [subcommand]: those beside `run` for which the layout has something; a page has none of them
 * A request that is none ends with outcome "bad_input". */
const char *wh_playground_run(const char *request);

/* The text that `--json` prints of the run; null: nothing was played. */
const char *wh_playground_json(void);

/* The document of the run that was played: what its page shows. Null: there is none. */
const char *wh_playground_document(void);

/* The report of that run, byte by byte that of `--report`; null if it cannot be made. */
const char *wh_playground_report(void);

/* The page of a report or of a flow, by its template's name, with an empty document. */
const char *wh_playground_page(const char *name);

/* The fields and words of layouts and scripts: the text of `waferhand definitions`. */
const char *wh_playground_definitions(void);

/* Why the last call that returned null did so. */
const char *wh_playground_reason(void);

#endif
