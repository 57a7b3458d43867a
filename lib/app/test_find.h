/* Finds the scripts of given files and folders. */
#ifndef WH_APP_TEST_FIND_H
#define WH_APP_TEST_FIND_H

#include "../text/options.h"
#include "test_jobs.h"

/* Zero it to begin with. */
typedef struct {
    wh_test_job_t *jobs;
    char **paths; /* of the same */
    size_t count, capacity, path_capacity;
} wh_test_found_t;

/* Adds one more; the path is copied. */
void wh_test_found_add(wh_test_found_t *found, const char *path, bool was_found);

/* Adds each file, and each *.lua of a folder and of the folders in it, in the order of their names' bytes.
 * Hidden files and links to folders are left out. False, and standard error says why, if a path is not there
 * or a folder cannot be read. */
bool wh_test_find(const wh_option_list_t *paths, wh_test_found_t *found);

void wh_test_found_free(wh_test_found_t *found);

#endif
