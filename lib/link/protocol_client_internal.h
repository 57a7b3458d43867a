/* What the files of the client share; nobody else includes it. */
#ifndef WH_LINK_PROTOCOL_CLIENT_INTERNAL_H
#define WH_LINK_PROTOCOL_CLIENT_INTERNAL_H

#include "protocol_client.h"

/* ---- client.c ---- */
/* A line for people. */
__attribute__((format(printf, 2, 3))) void wh_protocol_client_say(const wh_protocol_client_t *client,
                                                                  const char *format, ...);
bool wh_protocol_client_is_stopped(const wh_protocol_client_t *client);
/* From the second slice on; the first is in lockstep. */
bool wh_protocol_client_is_free_running(const wh_protocol_client_t *client);

/* ---- client_send.c ---- */
/* Sends the command. */
void wh_protocol_client_send(wh_protocol_client_t *client);
/* The same, and counts it as repeated. */
void wh_protocol_client_send_again(wh_protocol_client_t *client);
/* Sends the last state, then the command, if a simulator that was started anew has asked for it. */
void wh_protocol_client_restore(wh_protocol_client_t *client);

/* ---- client_receive.c ---- */
/* Takes what came on WAFERHAND_STATE; user is the client. */
void wh_protocol_client_on_state(void *user, const void *data, size_t size);

/* ---- client_wait.c ---- */
/* How long the first wait is before a command is sent again. */
#define WH_CLIENT_FIRST_RESEND_US 1200
/* Says so when nothing has been heard for long, neither since then nor before. */
void wh_protocol_client_notice_silence(wh_protocol_client_t *client, int64_t since_us);
/* Waits for the answer to the last command, sending it again and again. */
wh_status_t wh_protocol_client_await_answer(wh_protocol_client_t *client);
/* Free-running: waits until the next slice is due; a simulator that has fallen silent is waited for. */
wh_status_t wh_protocol_client_await_due_time(wh_protocol_client_t *client);

#endif
