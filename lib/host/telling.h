/* Frames to the host: what an encoder of the dialect makes, or its refusal. */
#ifndef WH_HOST_TELLING_H
#define WH_HOST_TELLING_H

#include "state.h"

/* Encodes and sends. `is_reply`: a reply to the request that has just come, delayed as its timing says. */
void wh_controller_tell(wh_controller_t *controller, wh_encoder_t encoder, const wh_told_t *told,
                        bool is_reply);

/* Sends the bytes of an earlier reply again. */
void wh_controller_tell_again(wh_controller_t *controller, const wh_reply_t *reply);

/* Refuses a request; by our error's number, or for the failure that the dialect gave. */
void wh_controller_refuse(wh_controller_t *controller, const wh_request_t *request, wh_status_t number,
                          const char *detail);
void wh_controller_refuse_as(wh_controller_t *controller, const wh_request_t *request,
                             const wh_failure_t *failure);

/* Tells the end of a request, with the controller's status. */
void wh_controller_tell_result(wh_controller_t *controller, wh_encoder_t encoder, const wh_request_t *request,
                               wh_status_t number, const char *answer, double seconds);

/* Fills in all that STATUS tells now, for a wh_controller_t: a wh_now_t. */
void wh_controller_tell_now(void *user, wh_result_t *now);

/* A client has come, or gone: the dialect's `connected` and `gone`. */
void wh_controller_greet(wh_controller_t *controller);
void wh_controller_part(wh_controller_t *controller);

/* Counts a mistake of the dialect and says its message on standard error. */
void wh_controller_say_mistake(wh_controller_t *controller);

/* Refuses a request for a mistake of the dialect, whose message names its file and line. */
void wh_controller_tell_mistake(wh_controller_t *controller, const wh_request_t *request);

#endif
