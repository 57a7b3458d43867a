/* Finds the scripts of given files and folders. */
#ifndef WH_APP_TEST_FIND_H
#define WH_APP_TEST_FIND_H

#include "../text/options.h"
#include "test_jobs.h"

/* Zero it to begin with. */
typedef struct {
    wh_test_job_t *jobs;
    size_t count, capacity;
    char **paths, **own; /* of all that were added; their own places, by which a script is the same */
    size_t path_count, path_capacity, own_capacity;
    size_t named; /* how many were to be added, those that were there already too */
} wh_test_found_t;

/* Adds one more, unless it is there already; the path is copied. */
void wh_test_found_add(wh_test_found_t *found, const char *path, bool was_found);

/* Adds each file, and each *.lua of a folder and of the folders in it, in the order of their names' bytes.
 * Hidden files and links to folders are left out. A script that is named or found again is played once, and
 * standard error says how many are. False, and standard error says why, if a path is not there
 * or a folder cannot be read. */
bool wh_test_find(const wh_option_list_t *paths, wh_test_found_t *found);

void wh_test_found_free(wh_test_found_t *found);

#endif
