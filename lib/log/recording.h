/* A recording: the messages that a process hears and sends go into an LCM event log, as slices or one by
 * one.
 *
 * lcm_types/format.md describes its content. A separate thread ensures that the record reaches the file
 * within 100 ms, whatever the process does meanwhile. One other thread may call the functions. A recording
 * that fails says so at once and records no more. The process continues, and wh_recording_close tells of
 * the failure. Nothing here allocates for a slice.
 */
#ifndef WH_LOG_RECORDING_H
#define WH_LOG_RECORDING_H

#include <pthread.h>

#include "../link/node.h"
#include "../wire/slices.h"
#include "record_file.h"

/* The longest time that a recorded message may wait, us. */
#define WH_RECORDING_WAIT_US 100000
/* The number of commands that wait for their states; a free-running motion control may be this far
 * ahead. */
#define WH_RECORDING_COMMANDS 4096

typedef struct {
    const char *path;    /* null: do not record */
    const char *program; /* the program that records: run, sim or mcs */
    bool all;            /* every message, not slices */
    bool replaces;       /* replace an old file at the first slice; otherwise create a new one at once */
    double part_mb;      /* size at which a part ends, 10^6 bytes; 0: there is one part only */
} wh_recording_options_t;

/* The slice that was recorded last. */
typedef struct {
    int64_t run, seq, utime, missed;
    uint64_t layout_hash;
    int64_t command_check, state_check; /* checks of its messages; 0: not known */
} wh_recording_place_t;

/* It has 8 MB. Zero it and set the options. It must not be moved once opened. */
typedef struct {
    wh_recording_options_t options;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    pthread_t flusher;
    bool is_open, closes; /* from open to close; the flusher must end */
    wh_record_file_t file;
    char path[PATH_MAX]; /* path of the first part; later parts are named after it */
    int64_t id;
    int32_t part;
    int64_t events, slices; /* of this part */
    uint64_t digest;
    wh_recording_place_t last;
    bool is_interrupted; /* a command stands alone, or a state came back; the next slice is whole */
    int64_t since_state; /* slices since a whole state */
    wh_slices_t block;
    waferhand_command commands[WH_RECORDING_COMMANDS];
    size_t first_command, command_count;
    uint8_t cell[WH_LINK_DATAGRAM]; /* the last cell */
    size_t cell_size;
    uint8_t encoded[WH_SLICES_BYTES];
    uint8_t event[WH_LINK_DATAGRAM + 100];
} wh_recording_t;

/* The result of recording a slice. */
typedef enum {
    WH_RECORDED,       /* it is recorded */
    WH_RECORDED_STATE, /* it is recorded, and its state is due: wh_recording_state */
    WH_NOT_RECORDED    /* it does not fit: record both messages by wh_recording_message */
} wh_recorded_t;

/* Begins the recording. It creates the file. If it `replaces` an old one, it waits for the first slice and
 * only tests whether it could. Returns false, and standard error says why, if that was not possible; there
 * is then nothing to close. */
bool wh_recording_open(wh_recording_t *recording);

/* Records a message that was sent or received, of any kind. With slices it leaves the message out, or makes
 * it part of a block, if that loses nothing. */
void wh_recording_message(wh_recording_t *recording, const char *channel, const void *data, size_t size);

/* wh_node_open, with this recording as the node's recorder: it is opened, and records all messages sent and
 * received. Without a path nothing is recorded. */
bool wh_recording_open_node(wh_recording_t *recording, wh_node_t *node, const char *url);

/* Records a slice without its messages. `told` has the state's valve_told for each of the command's
 * grippers. `missed` and `hash` are the state's; the last argument tells whether it had events. It is only
 * for recordings of slices, not of all messages. */
wh_recorded_t wh_recording_slice(wh_recording_t *recording, const waferhand_command *command,
                                 const int32_t told[], int64_t missed, uint64_t hash, bool has_events);

/* Records the whole state of the last slice. */
void wh_recording_state(wh_recording_t *recording, const void *data, size_t size);

/* False if an open recording has failed so far; standard error has given the reason. */
bool wh_recording_is_sound(wh_recording_t *recording);

/* Completes the log and closes it. Returns false if the recording failed, or if no slice came to replace an
 * old file; standard error has told it. Returns true without a path, and for a recording that is not
 * open. */
bool wh_recording_close(wh_recording_t *recording);

#endif
