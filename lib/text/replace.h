/* A small file written as a whole: whoever reads it meanwhile sees the old one or the new one. */
#ifndef WH_TEXT_REPLACE_H
#define WH_TEXT_REPLACE_H

#include <stddef.h>

/* Writes `size` bytes into a new file in the same folder, which is then renamed. What a symbolic link points
 * to is replaced; a link that points nowhere is itself replaced. An existing file keeps its permissions, a
 * new one gets 0666 less the umask. Returns 0 or an errno: EISDIR for a directory, EINVAL for what else is no
 * file. Then nothing has changed and no temporary file is left; only a kill leaves one, ".waferhand-PID-N".
 * Nothing is synced to the disk. */
int wh_replace(const char *path, const void *bytes, size_t size);

#endif
