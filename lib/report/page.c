#include "page.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../script/embedded.h"
#include "../text/packed.h"

#if !defined(WH_JAVASCRIPT)
#define WH_JAVASCRIPT "/usr/share/javascript"
#endif

/* The longest name between two @. */
#define NAME_BYTES 64

/* JavaScript that others wrote: its path below WH_JAVASCRIPT, and the Debian package that contains it. */
static const struct {
    const char *name, *path, *package;
} foreign[] = {
    {"three.min.js", "three/three.min.js", "libjs-three"},
    {"OrbitControls.js", "three/examples/js/controls/OrbitControls.js", "libjs-three"},
    {"GLTFLoader.js", "three/examples/js/loaders/GLTFLoader.js", "libjs-three"},
    {"dygraph.min.js", "dygraphs/dygraph.min.js", "libjs-dygraphs"},
    {"dygraph.min.css", "dygraphs/dygraph.min.css", "libjs-dygraphs"},
};

typedef struct {
    FILE *out;
    const wh_page_content_t *content;
    char *message;
} page_t;

static const wh_embedded_t *find_ours(const char *name) {
    for (size_t i = 0; i < wh_embedded_page_count; ++i) {
        if (strcmp(wh_embedded_page[i].name, name) == 0) {
            return &wh_embedded_page[i];
        }
    }
    return NULL;
}

/* ----------------------------------------------------------------------------------------------- inlining */

/* True if an HTML parser would take this within a script or a style for markup. A backslash after the '<'
 * prevents that; JavaScript's strings and CSS ignore it. */
static bool is_markup(const char *text, size_t size) {
    static const char *const ends[] = {"/script", "/style", "!--"};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; ++i) {
        const size_t length = strlen(ends[i]);
        if (size > length && strncasecmp(text + 1, ends[i], length) == 0) {
            return true;
        }
    }
    return false;
}

static void write_inlined(FILE *out, const char *text, size_t size) {
    while (size > 0) {
        const char *found = memchr(text, '<', size);
        const size_t plain = found ? (size_t)(found - text) + 1 : size;
        fwrite(text, 1, plain, out);
        if (found && is_markup(found, size - plain + 1)) {
            fputc('\\', out);
        }
        text += plain;
        size -= plain;
    }
}

static void write_title(FILE *out, const char *title) {
    for (const char *c = title; *c; ++c) {
        if (*c == '<' || *c == '&') {
            fputs(*c == '<' ? "&lt;" : "&amp;", out);
        } else {
            fputc((unsigned char)*c, out);
        }
    }
}

static bool write_foreign(const page_t *page, size_t i) {
    const char *folder = getenv("WAFERHAND_JAVASCRIPT");
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/%s", folder ? folder : WH_JAVASCRIPT, foreign[i].path);
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    size_t size = 0;
    const ssize_t read = file ? getdelim(&text, &size, EOF, file) : -1;
    if (read < 0) {
        (void)snprintf(page->message, WH_PAGE_MESSAGE_BYTES,
                       "%.400s: %s (expected the JavaScript of Debian's package %s: apt-get install %s)",
                       path, file ? "empty" : strerror(errno), foreign[i].package, foreign[i].package);
    } else {
        write_inlined(page->out, text, (size_t)read);
    }
    if (file) {
        (void)fclose(file);
    }
    free(text);
    return read >= 0;
}

/* -------------------------------------------------------------------------------------------------- names */

static bool is_template(const char *name) {
    const size_t length = strlen(name);
    return length > 3 && strcmp(name + length - 3, ".in") == 0;
}

static bool write_template(const page_t *page, const char *text);

/* True if the name stands for something of this page's content. */
static bool write_content(const page_t *page, const char *name) {
    const wh_page_content_t *content = page->content;
    if (strcmp(name, "title") == 0) {
        write_title(page->out, content->title);
    } else if (strcmp(name, "document") == 0) {
        char *packed = wh_packed_text(content->document, content->document_size);
        fputs(packed, page->out);
        free(packed);
    } else if (strcmp(name, "policy") == 0) {
        fputs(content->cell ? " 'wasm-unsafe-eval' blob:; worker-src blob:" : "", page->out);
    } else if (content->cell && (strcmp(name, "cell") == 0 || strcmp(name, "engine") == 0)) {
        fputs(name[0] == 'c' ? content->cell : content->engine, page->out);
    } else {
        return false;
    }
    return true;
}

static bool write_ours(const page_t *page, const wh_embedded_t *ours) {
    if (is_template(ours->name)) {
        return write_template(page, (const char *)ours->text);
    }
    write_inlined(page->out, (const char *)ours->text, ours->size);
    return true;
}

static bool write_named(const page_t *page, const char *name) {
    const wh_embedded_t *ours = find_ours(name);
    if (ours) {
        return write_ours(page, ours);
    }
    if (write_content(page, name)) {
        return true;
    }
    if (strcmp(name, "rerun") == 0) {
        return !page->content->cell || write_named(page, "rerun.html.in");
    }
    for (size_t i = 0; i < sizeof foreign / sizeof foreign[0]; ++i) {
        if (strcmp(foreign[i].name, name) == 0) {
            return write_foreign(page, i);
        }
    }
    (void)snprintf(page->message, WH_PAGE_MESSAGE_BYTES,
                   "the page asks for %s, which the program was built without", name);
    return false;
}

/* The length of the name that ends with an @, or 0. */
static size_t name_length(const char *text) {
    const size_t length = strspn(text, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-");
    return length < NAME_BYTES && text[length] == '@' ? length : 0;
}

/* A template may name another one; none names itself. */
static bool write_template(const page_t *page, const char *text) {
    const char *from = text;
    for (const char *at = strchr(from, '@'); at; at = strchr(at, '@')) {
        const size_t length = name_length(at + 1);
        char part[NAME_BYTES];
        if (length == 0) {
            ++at;
            continue;
        }
        fwrite(from, 1, (size_t)(at - from), page->out);
        (void)snprintf(part, sizeof part, "%.*s", (int)length, at + 1);
        if (!write_named(page, part)) {
            return false;
        }
        from = at = at + length + 2;
    }
    fputs(from, page->out);
    return true;
}

bool wh_page_write(FILE *out, const char *name, const char *title, const char *document, size_t size,
                   char message[WH_PAGE_MESSAGE_BYTES]) {
    const wh_page_content_t content = {.title = title, .document = document, .document_size = size};
    return wh_page_write_content(out, name, &content, message);
}

bool wh_page_write_content(FILE *out, const char *name, const wh_page_content_t *content,
                           char message[WH_PAGE_MESSAGE_BYTES]) {
    const page_t page = {out, content, message};
    const wh_embedded_t *template = find_ours(name);
    if (!template) {
        (void)snprintf(message, WH_PAGE_MESSAGE_BYTES, "the program was built without its page");
        return false;
    }
    return write_template(&page, (const char *)template->text);
}
