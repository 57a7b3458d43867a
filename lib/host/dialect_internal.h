/* Shared by the files of a dialect: how it is read, and what its functions are given. */
#ifndef WH_HOST_DIALECT_INTERNAL_H
#define WH_HOST_DIALECT_INTERNAL_H

#include "../script/embedded.h"
#include "../script/reader.h"
#include "dialect.h"

/* Runs protected, with the dialect as its argument: reads the table that its file has returned. */
int wh_dialect_read(lua_State *L);

/* Reads the field `framing` of the dialect's table. */
void wh_dialect_read_framing(wh_reader_t *reader, wh_dialect_t *dialect);

/* The starts of a framing, such as "!", "$" with their quotes; none: there is none. Returns the text. */
#define WH_DIALECT_STARTS_BYTES (WH_FRAMING_MARKS * (4 * WH_FRAMING_MARK + 4) + 1)
const char *wh_dialect_list_starts(const wh_framing_t *framing, char text[WH_DIALECT_STARTS_BYTES]);

/* Takes the lines of CONTROLLER on top of the stack: a text, a list of texts, or nil. Raises if there is
 * anything else; `function` names it. */
void wh_dialect_take_conditions(lua_State *L, const wh_dialect_t *dialect, const char *function,
                                wh_lines_t *lines);

/* True for the tester's own dialect: built in, or the file that it is made of. */
bool wh_dialect_is_testers(const char *path);

/* The tester's own dialect as it is built in; null: the path is a file's. */
const wh_embedded_t *wh_dialect_find_embedded(const char *path);

/* A call of one function, and its result. */
typedef struct {
    wh_dialect_t *dialect;
    const wh_client_t *client;
    const char *frame;
    size_t size;
    const wh_framing_mark_t *end; /* null: the frame has none */
    char *unit;
    bool *stops;
    wh_now_t *ask;
    void *user;
    wh_request_t *request;
    wh_lines_t *lines;
    wh_encoder_t encoder;
    const wh_told_t *told;
} wh_dialect_call_t;

/* Calls with a fresh budget. False: it raised, and the dialect's `message` says what. */
bool wh_dialect_call(wh_dialect_t *dialect, lua_CFunction function, wh_dialect_call_t *argument);

/* The outcome of a call: a request, or refused, or a mistake. */
wh_decoded_t wh_dialect_outcome(wh_dialect_t *dialect, bool done, wh_failure_t *failure);

/* Pushes { port = , number = }. */
void wh_dialect_push_client(lua_State *L, const wh_client_t *client);

/* Makes the dialect's text of the value at index 2; nil: none. `function` names it in messages. */
void wh_dialect_take_text(lua_State *L, const wh_dialect_call_t *it, const char *function);
void wh_dialect_drop_text(wh_dialect_t *dialect);

/* Sets the global table `known` of the dialect of a tester: `kinds` of events and names of `errors`, both in
 * their order, and meant(word, names), which returns "; did you mean NAME?", or "". */
void wh_dialect_open_tester(lua_State *L);

/* Pushes a field of the dialect's table and of the table in it; `within` may be null. */
void wh_dialect_push(lua_State *L, const char *field, const char *within);

/* Sets ok, number, name, code and text of an error, or of none, in the table on top of the stack. */
void wh_dialect_set_error(lua_State *L, const wh_dialect_t *dialect, wh_status_t number, const char *code);

/* Pushes the result of a request, without its `reply`; `now` of a request: what STATUS tells. */
void wh_dialect_push_result(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result);
void wh_dialect_push_now(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *now);

#endif
