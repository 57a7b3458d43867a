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

/* Refuses a request for a mistake of the dialect, whose message names its file and line. */
void wh_controller_tell_mistake(wh_controller_t *controller, const wh_request_t *request);

/* An event of this slice. */
void wh_controller_event(wh_controller_t *controller, const wh_event_t *event, double seconds);

/* A gripper's sensor or valve has changed. */
void wh_host_tell_change(wh_host_t *host, wh_host_event_kind_t kind, size_t gripper, int value);

/* A door is open, shut (1, 0), or neither (-1). */
void wh_host_tell_door(wh_host_t *host, size_t door, int value);

/* Tells which robots' own controllers have changed since they were told last. */
void wh_host_tell_modes(wh_host_t *host);

/* This controller's action has ended, or its HOLD begins or ends: told at its own ports and to testers. */
void wh_controller_tell_others(const wh_controller_t *controller, wh_host_event_kind_t kind, int value);

#endif
