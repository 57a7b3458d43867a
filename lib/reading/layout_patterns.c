/* The file of patterns that a layout names. Motion control runs it; here only its text counts, since a cell
 * with another text is another cell. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "../math/hash.h"
#include "../text/output.h"
#include "layout_internal.h"

#define PATH_BYTES 1024

/* The reason why the file cannot be read; null: `hash` is that of its text. */
static const char *hash_file(const char *path, uint64_t *hash) {
    struct stat status;
    if (stat(path, &status) != 0) {
        return strerror(errno);
    }
    if (!S_ISREG(status.st_mode)) {
        return "it is no regular file";
    }
    FILE *file = fopen(path, "rb");
    if (!file) {
        return strerror(errno);
    }
    *hash = WH_HASH_START;
    for (int c = fgetc(file); c != EOF; c = fgetc(file)) {
        *hash = wh_hash_word(*hash, (uint64_t)c);
    }
    const bool failed = ferror(file) != 0;
    (void)fclose(file);
    return failed ? strerror(errno) : NULL;
}

void wh_layout_read_patterns(wh_reader_t *reader, wh_layout_t *layout) {
    char name[512];
    if (!wh_reader_has(reader, "patterns")) {
        return;
    }
    char *path = wh_layout_memory(reader->L, PATH_BYTES, 1);
    wh_reader_text(reader, "patterns", NULL, name, sizeof name);
    wh_layout_path(path, PATH_BYTES, layout->path, name);
    wh_output_note_input(path);
    const char *why = hash_file(path, &layout->patterns_hash);
    if (why) {
        wh_reader_refuse(reader, "patterns", name, "a Lua file: %s: %s", path, why);
    }
    wh_output_keep(path);
    layout->patterns = path;
}
