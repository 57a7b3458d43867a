/* A recording: what a process hears and says goes into an LCM event log, as slices or message by message.
 *
 * lcm_types/README.md says what stands in it. A thread of its own sees to it that what was recorded
 * reaches the file within 100 ms, whatever the process does meanwhile; the functions may be called by one
 * other thread. A recording that fails says so at once and takes nothing more: the process goes on, and
 * wh_recording_close tells. Nothing here allocates for a slice.
 */
#ifndef WH_LINK_RECORDING_H
#define WH_LINK_RECORDING_H

#include <pthread.h>

#include "record_file.h"
#include "slices.h"

/* How long something recorded may wait, us. */
#define WH_RECORDING_WAIT_US 100000
/* Commands that wait for their states: a free-running motion control may be so far ahead. */
#define WH_RECORDING_COMMANDS 4096

typedef struct {
    const char *path;    /* null: nothing is to be recorded */
    const char *program; /* who records: run, sim or mcs */
    bool all;            /* every message, not slices */
    bool
        replaces; /* an old file is replaced, when the first slice comes; else a new one is created at once */
    double part_mb; /* a part ends when it is so large, 10^6 bytes; 0: there is one part only */
} wh_recording_options_t;

/* The slice that was recorded last. */
typedef struct {
    int64_t run, seq, utime, missed;
    uint64_t layout_hash;
    int64_t command_check, state_check; /* of its messages; 0: not known */
} wh_recording_place_t;

/* 8 MB. Zero it and set the options. Must not be moved once opened. */
typedef struct {
    wh_recording_options_t options;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    pthread_t flusher;
    bool is_open, closes; /* from open to close; the flusher is to end */
    wh_record_file_t file;
    char path[PATH_MAX]; /* of the first part: those that follow are named after it */
    int64_t id;
    int32_t part;
    int64_t events, slices; /* of the part */
    uint64_t digest;
    wh_recording_place_t last;
    bool is_interrupted; /* a command stands alone, or a state came back: the next slice stands whole */
    int64_t since_state; /* slices since a whole state */
    wh_slices_t block;
    waferhand_command commands[WH_RECORDING_COMMANDS];
    size_t first_command, command_count;
    uint8_t cell[WH_LINK_DATAGRAM]; /* the last one */
    size_t cell_size;
    uint8_t encoded[WH_SLICES_BYTES];
    uint8_t event[WH_LINK_DATAGRAM + 100];
} wh_recording_t;

/* What became of a slice. */
typedef enum {
    WH_RECORDED,       /* it is recorded */
    WH_RECORDED_STATE, /* so it is, and its state is due: wh_recording_state */
    WH_NOT_RECORDED    /* it does not fit: both messages are to be recorded, by wh_recording_message */
} wh_recorded_t;

/* Begins. Creates the file, or if it `replaces` an old one, which waits for the first slice, tries if it
 * could. False, and standard error says why, if that was not possible: there is then nothing to close. */
bool wh_recording_open(wh_recording_t *recording);

/* Records a message that was sent or came, whatever it is. With slices it is left out or becomes part of
 * a block where that loses nothing. */
void wh_recording_message(wh_recording_t *recording, const char *channel, const void *data, size_t size);

/* Records a slice without its messages. `told` has the state's valve_told for each of the command's grippers,
 * `missed` and `hash` are the state's, and it had events or not. For slices only, not for all messages. */
wh_recorded_t wh_recording_slice(wh_recording_t *recording, const waferhand_command *command,
                                 const int32_t told[], int64_t missed, uint64_t hash, bool has_events);

/* Records the whole state of the last slice. */
void wh_recording_state(wh_recording_t *recording, const void *data, size_t size);

/* False if a recording that is open has failed so far; standard error has said how. */
bool wh_recording_is_sound(wh_recording_t *recording);

/* Completes the log and closes it. False if the recording failed, or no slice came to replace an old file
 * with; standard error has said so. True without a path, and of a recording that is not open. */
bool wh_recording_close(wh_recording_t *recording);

#endif
