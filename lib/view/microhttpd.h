/* libmicrohttpd, loaded when a page is to be served: with all that it needs itself it is nine shared
 * libraries, without which every other run starts. */
#ifndef WH_VIEW_MICROHTTPD_H
#define WH_VIEW_MICROHTTPD_H

#include <microhttpd.h>

#define WH_MICROHTTPD_CALL(name) __typeof__(&(name)) name

/* Its functions, by their own names. */
typedef struct {
    WH_MICROHTTPD_CALL(MHD_add_response_header);
    WH_MICROHTTPD_CALL(MHD_create_response_from_buffer);
    WH_MICROHTTPD_CALL(MHD_create_response_from_callback);
    WH_MICROHTTPD_CALL(MHD_destroy_response);
    WH_MICROHTTPD_CALL(MHD_get_connection_info);
    WH_MICROHTTPD_CALL(MHD_get_daemon_info);
    WH_MICROHTTPD_CALL(MHD_get_timeout);
    WH_MICROHTTPD_CALL(MHD_lookup_connection_value);
    WH_MICROHTTPD_CALL(MHD_queue_response);
    WH_MICROHTTPD_CALL(MHD_resume_connection);
    WH_MICROHTTPD_CALL(MHD_run);
    WH_MICROHTTPD_CALL(MHD_start_daemon);
    WH_MICROHTTPD_CALL(MHD_stop_daemon);
    WH_MICROHTTPD_CALL(MHD_suspend_connection);
} wh_microhttpd_t;

/* Null: it is not there, or lacks one of them. Loads it once; one thread asks. */
const wh_microhttpd_t *wh_microhttpd(void);

#endif
