/* A dialect: a Lua file that says how one controller talks to its host.
 *
 * lua/dialects/README.md says what the file may say. It runs in a sandbox of its own, with 16 MB and 1e5
 * instructions for each call. It never runs a command: it turns a frame into lines as they are typed at the
 * prompt, and their result into a frame. A mistake in it is a message that names its file and line.
 *
 * One thread at a time for each dialect. All texts are the dialect's own and live until the next call.
 */
#ifndef WH_HOST_DIALECT_H
#define WH_HOST_DIALECT_H

#include "../layout/layout.h"
#include "../math/status.h"
#include "../script/sandbox.h"
#include "chaos.h"
#include "framing.h"
#include "mechanism.h"
#include "port.h"
#include "words.h"

/* The limits of a dialect's memory and instructions. */
#define WH_DIALECT_MEMORY_BYTES ((size_t)16 << 20)
#define WH_DIALECT_INSTRUCTIONS 100000

/* Room for a name, a code of theirs, a sequence number, and for one of our lines. */
#define WH_DIALECT_NAME_BYTES 64
#define WH_DIALECT_LINE_BYTES 1001
/* The most lines that one of their commands may make, and the most of our words in one `does`. */
#define WH_DIALECT_LINES 16
#define WH_DIALECT_DOES 8
/* The most ports that share one dialect, and the clients of a port whose `second_client` is "share". */
#define WH_DIALECT_PORTS 4
#define WH_DIALECT_SHARERS 4
/* The most actions that wait behind one that runs. */
#define WH_DIALECT_QUEUE 16

/* The time of a command's answer. A query is answered at once or when its controller is idle, an action
 * when it begins ("at once") or at its end. */
typedef enum { WH_WHEN_AT_ONCE, WH_WHEN_IDLE, WH_WHEN_END } wh_when_t;

/* A client of a port. */
typedef struct {
    const char *port; /* its name in the dialect's `ports` */
    uint64_t number;  /* among the clients of the dialect, from 1 */
} wh_client_t;

/* A command of theirs. */
typedef struct {
    char name[WH_DIALECT_NAME_BYTES];
    wh_word_kind_t kind;
    const wh_word_t *does[WH_DIALECT_DOES]; /* all of that kind */
    size_t does_count;
    wh_when_t when;
    int queue;   /* how many such actions wait behind what runs; 0: they are refused as busy */
    bool closes; /* its client is closed behind the answer */
} wh_dialect_command_t;

/* The code and text that their host is told for one of our errors. */
typedef struct {
    wh_status_t number;
    char code[WH_DIALECT_NAME_BYTES];
} wh_dialect_code_t;

typedef enum {
    WH_ENCODE_ACKNOWLEDGE,    /* (request): an action has been taken on */
    WH_ENCODE_ANSWER,         /* (request, result): a request was answered at once */
    WH_ENCODE_COMPLETE,       /* (request, result): an action has ended, well or not */
    WH_ENCODE_REFUSE,         /* (request, failure): nothing was begun; the request may be empty */
    WH_ENCODE_BAD,            /* (reason): a bad frame, by wh_frame_kind_name */
    WH_ENCODE_EVENT,          /* (event): something befell a wafer */
    WH_ENCODE_UNACKNOWLEDGED, /* (): no ACKN has come in time */
    WH_ENCODERS
} wh_encoder_t;

/* Their names in a dialect's `encode`. */
extern const char *const wh_encoder_names[WH_ENCODERS];

/* How they measure and count. */
typedef struct {
    double length, angle; /* one of their units, in mm and degrees */
    double signs[4];      /* of theta, r, z, yaw: 1 or -1 */
    int first_slot;       /* how they count the first one */
} wh_dialect_units_t;

typedef struct {
    double ack_s;  /* the delay of an acknowledgement */
    double busy_s; /* how long an action waits for another port's */
    double ackn_s; /* how long a completion waits for its ACKN; 0: none is awaited */
    double idle_s; /* a client that is silent for so long is closed; 0: never */
    int64_t baud;  /* 0: as fast as possible */
} wh_dialect_timing_t;

/* The events that a dialect asks for in `events`; without that, those of wafers alone. */
typedef enum {
    WH_HOST_WAFER,     /* something befell a wafer */
    WH_HOST_SENSOR,    /* a gripper's vacuum sensor has changed */
    WH_HOST_VALVE,     /* a gripper's valve was switched */
    WH_HOST_HOLD,      /* a HOLD begins, or ends */
    WH_HOST_POSITION,  /* an action has ended well */
    WH_HOST_ERROR,     /* an action has failed */
    WH_HOST_DOOR,      /* a door has come to an end, or has left it */
    WH_HOST_MODE,      /* a robot's own controller has changed: its power, its mode, ... */
    WH_HOST_LOAD_PORT, /* a load port has reached a state, or begins a step; its carrier comes or goes */
    WH_HOST_GRIP,      /* the plunger of an edge grip sets out, or stands */
    WH_HOST_EVENTS
} wh_host_event_kind_t;
extern const char *const wh_host_event_names[WH_HOST_EVENTS + 1];

/* Whom it talks to, and how. */
typedef struct {
    wh_port_second_t second;
    bool completes_to_next; /* the end of a command is told to whoever is there; else only to the client that
                             * asked */
    bool in_order;          /* the next frame of a port is read once all before it are answered */
    bool hears_testers;     /* it has the function `tester` */
    bool greets, heeds_going; /* the dialect has the functions `connected` and `gone` */
    bool knows_units;         /* it has the function `unit_of`: a line may carry several of its units */
    unsigned events;          /* it is told these: bits, 1 << WH_HOST_WAFER */
    size_t port_count;        /* at least 1 */
    char ports[WH_DIALECT_PORTS][WH_DIALECT_NAME_BYTES]; /* their names; empty: it has one */
} wh_dialect_clients_t;

/* Our lines for a request, or for a LOCAL one its answer as the only line. */
typedef struct {
    char lines[WH_DIALECT_LINES][WH_DIALECT_LINE_BYTES];
    size_t count;
} wh_lines_t;

/* Where its controller is: the caller's texts. */
typedef struct {
    const char *unit;       /* its address on its line; null: none was given */
    const char *stands_for; /* the name of its mechanism in the layout, set once it is known; null: several */
} wh_dialect_place_t;

/* Read-only for others. Must not be moved while it is open. */
typedef struct {
    wh_sandbox_t *sandbox;
    const char *path; /* the caller's */
    wh_dialect_place_t place;
    char name[WH_DIALECT_NAME_BYTES];
    wh_mechanism_t mechanism;
    wh_framing_t framing; /* for the bytes that the host sends */
    wh_framing_t replies; /* for the bytes that it is sent: the same, but for the starts and ends */
    wh_dialect_units_t units;
    wh_dialect_timing_t timing;
    wh_chaos_t chaos;
    wh_dialect_clients_t clients;
    bool encodes[WH_ENCODERS];
    wh_dialect_command_t *commands;
    size_t command_count, command_capacity;
    wh_dialect_code_t *codes;
    size_t code_count, code_capacity;
    char other_code[WH_DIALECT_NAME_BYTES]; /* of errors that are not in the table */
    wh_lines_t begins;                      /* CONTROLLER, of its robot at the start */
    bool states[3];                         /* if it has a word of its own for idle, running, held */
    char message[WH_SANDBOX_MESSAGE_BYTES]; /* of the last call that failed */
    char *text; /* of the last frames that were encoded, with a byte 0 between two; null: none */
    size_t text_size;
    size_t text_start; /* the one of `replies` before it */
} wh_dialect_t;

/* The path of the dialect of a tester beside the hosts, which is built in. */
#define WH_DIALECT_CONTROL ":control"

/* Reads the file. False, with the reason in `message`, if it cannot be read or says something wrong: file,
 * field, value, and what was expected. To be closed either way. `unit` is its address on its line, which
 * host.unit returns; null: it was given none. */
bool wh_dialect_open(wh_dialect_t *dialect, const char *path, const char *unit);
void wh_dialect_close(wh_dialect_t *dialect);

/* Makes this text the `message`: one line that names the file, if the text does not begin with it. Control
 * characters are shown. */
void wh_dialect_note(wh_dialect_t *dialect, const char *text);

/* True if the layout has everything that `stations`, `arms` and `doors` name. Else `message` tells file,
 * field, value, and the names that there are. */
bool wh_dialect_fits(wh_dialect_t *dialect, const wh_layout_t *layout);

/* ------------------------------------------------------------------------------------------------ a frame */

typedef enum {
    WH_DECODED_REQUEST,
    WH_DECODED_NOTHING, /* not to be answered */
    WH_DECODED_REFUSED, /* by the dialect: see the failure */
    WH_DECODED_MISTAKE  /* in the dialect: see `message` */
} wh_decoded_t;

/* Why nothing was begun. */
typedef struct {
    wh_status_t number;               /* ours; BAD_ARGUMENT where only theirs was given */
    char code[WH_DIALECT_NAME_BYTES]; /* theirs */
    char detail[WH_SANDBOX_MESSAGE_BYTES];
} wh_failure_t;

/* The request of a frame. */
typedef struct {
    int reference; /* of the dialect's table; LUA_NOREF: none */
    const wh_dialect_command_t *command;
    char sequence[WH_DIALECT_NAME_BYTES]; /* empty: it has none */
} wh_request_t;

/* Calls decode(frame, client, ended_by) for a good frame. It always makes a request, which must go to
 * wh_dialect_forget. */
wh_decoded_t wh_dialect_decode(wh_dialect_t *dialect, const wh_client_t *client, const wh_frame_t *frame,
                               wh_request_t *request, wh_failure_t *failure);
void wh_dialect_forget(wh_dialect_t *dialect, wh_request_t *request);

/* Calls unit_of(frame): the address of the unit that the frame is for, or an empty text. False: a mistake,
 * see `message`. */
bool wh_dialect_unit_of(wh_dialect_t *dialect, const char *frame, size_t size,
                        char unit[WH_DIALECT_NAME_BYTES]);

/* ------------------------------------------------------------------------------------------------ a reply */

/* The result of a request. */
typedef struct {
    wh_status_t number;                   /* 0: it went well */
    const char *answer;                   /* as at the prompt, of the last line */
    const char *status;                   /* as STATUS tells it, without its OK */
    double seconds;                       /* simulated time that it took */
    bool is_held;                         /* a HOLD stands */
    const wh_layout_t *layout;            /* whose robots and grippers these are; null: none */
    const wh_port_mechanism_t *mechanism; /* what the port stands for; null with no layout */
    uint32_t sensors;       /* what the vacuum sensors of its grippers say: bit g of gripper g */
    const wh_pose_t *poses; /* of the grippers, base_from_gripper; null: none */
    const char *controller; /* what its robot's own controller has, name=value pairs; null: unknown */
} wh_result_t;

/* An event that concerns a wafer. */
typedef struct {
    const char *kind;  /* wh_event_name */
    bool is_complaint; /* of the cell: such as slot_occupied */
    const char *wafer, *gripper;
    double seconds;        /* simulated, since the run's beginning */
    int value;             /* a sensor or valve is on, a HOLD begins: 0 or 1; an error's number; -1: none */
    const char *at;        /* the controller whose action or HOLD it is; null: none's */
    const char *door;      /* null: none */
    const char *state;     /* of a robot's own controller, name=value pairs; null: none */
    const char *load_port; /* what it does, name=value pairs; null: none */
    const wh_grip_state_t *grip; /* what a plunger does; null: none */
    wh_client_t client;          /* to whom it is told */
} wh_host_event_t;

/* Calls the command's run(request, now). `now` is asked for a result of WH_OK only if that function takes it.
 * A line that begins with none of the words that its `does` names is a mistake. */
typedef void wh_now_t(void *user, wh_result_t *now);
wh_decoded_t wh_dialect_run(wh_dialect_t *dialect, const wh_request_t *request, wh_now_t *ask, void *user,
                            wh_lines_t *lines, wh_failure_t *failure);

/* The arguments of an encoder besides its kind; those that it does not take are null. */
typedef struct {
    const wh_request_t *request;
    const wh_result_t *result;
    const wh_failure_t *failure;
    const wh_host_event_t *event;
    const char *reason;
} wh_told_t;

/* Makes text, text_size and text_start: bodies, without start, sum and end. False: a mistake, see `message`.
 * Without text (null) nothing is sent. An encoder that the dialect does not have makes none. */
bool wh_dialect_encode(wh_dialect_t *dialect, wh_encoder_t encoder, const wh_told_t *told);

/* Calls connected(client) or gone(client), if the dialect has them: `text` is then a greeting, `lines` are
 * lines of CONTROLLER. False: a mistake, see `message`. */
bool wh_dialect_welcome(wh_dialect_t *dialect, const wh_client_t *client);
bool wh_dialect_part(wh_dialect_t *dialect, const wh_client_t *client, wh_lines_t *lines);

/* Calls tester(text): a tester tells the controller something that only hands can do, such as to press an
 * emergency stop. It is a request, or nothing without such a function, or refused, or a mistake. `stops`: the
 * function returned true, and what runs stops; or it returned `lines` of CONTROLLER. */
wh_decoded_t wh_dialect_tell(wh_dialect_t *dialect, const char *text, bool *stops, wh_lines_t *lines,
                             wh_failure_t *failure);

/* True if the last call failed because the dialect refused by host.refuse: then `failure` says why. An
 * `answer` may refuse so, too. */
bool wh_dialect_refused(const wh_dialect_t *dialect, wh_failure_t *failure);

/* Their code for an error of ours. */
const char *wh_dialect_code(const wh_dialect_t *dialect, wh_status_t number);

/* True if the table of errors has it. */
bool wh_dialect_speaks(const wh_dialect_t *dialect, wh_status_t number);

/* The layout that host.nearest and host.pose look at; null: none. It must outlive the dialect, or the next
 * call. */
void wh_dialect_show(wh_dialect_t *dialect, const wh_layout_t *layout);

/* Registry keys of the dialect's table, of the layout, and of the wh_dialect_t; for lib/host alone. */
extern char wh_dialect_key;
extern char wh_dialect_layout_key;
extern char wh_dialect_self_key;
int wh_dialect_open_host(lua_State *L);

#endif
