#if defined(WH_MICROHTTPD)

#include "microhttpd.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#define CALL(name)                                                                                           \
    { #name, offsetof(wh_microhttpd_t, name) }

static const struct {
    const char *name;
    size_t offset;
} members[] = {CALL(MHD_add_response_header),
               CALL(MHD_create_response_from_buffer),
               CALL(MHD_create_response_from_callback),
               CALL(MHD_destroy_response),
               CALL(MHD_get_connection_info),
               CALL(MHD_get_daemon_info),
               CALL(MHD_get_timeout),
               CALL(MHD_lookup_connection_value),
               CALL(MHD_queue_response),
               CALL(MHD_resume_connection),
               CALL(MHD_run),
               CALL(MHD_start_daemon),
               CALL(MHD_stop_daemon),
               CALL(MHD_suspend_connection)};

static wh_microhttpd_t calls;
static bool is_there;

/* ISO C has no cast from an object's pointer to a function's. */
static bool find_all(void *library) {
    bool found = true;
    for (size_t i = 0; i < sizeof members / sizeof members[0]; ++i) {
        void *const call = dlsym(library, members[i].name);
        memcpy((char *)&calls + members[i].offset, &call, sizeof call);
        found = found && call;
    }
    return found;
}

const wh_microhttpd_t *wh_microhttpd(void) {
    void *const library = is_there ? NULL : dlopen(WH_MICROHTTPD, RTLD_NOW | RTLD_LOCAL);
    is_there = is_there || (library && find_all(library));
    return is_there ? &calls : NULL;
}

#else

/* C99 has no empty files. */
typedef int wh_microhttpd_is_absent_t;

#endif
