/* Tells to which study a state belongs. */
#ifndef WH_STUDY_IDENTITY_H
#define WH_STUDY_IDENTITY_H

#include <jansson.h>

#include "study.h"

/* Version, parameters, seed, limits, hashes of the run without errors, of the script, and of each other file
 * that it read, by its path from the script's folder. It depends on the contents of the files, but not on how
 * the script's path was typed or where its folder lies. To be released. */
json_t *wh_study_identity(const wh_study_t *study);

/* True if it is this study's; else the message tells the first difference. */
bool wh_study_is_same(const json_t *found, const wh_study_t *study, char *message, size_t size);

#endif
