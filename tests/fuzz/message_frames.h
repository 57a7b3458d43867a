/* A sequence of datagrams in the bytes of an input, and what a fuzzer cannot guess put right in them. */
#ifndef WH_TESTS_FUZZ_MESSAGE_FRAMES_H
#define WH_TESTS_FUZZ_MESSAGE_FRAMES_H

#include "link/messages.h"

/* Each begins with four bytes: channel, what to put right, and the length, big-endian. */
typedef struct {
    const char *channel;
    uint8_t *bytes; /* in memory of the frame's own, free for use until the next */
    size_t size;
} fuzz_frame_t;

typedef struct {
    const uint8_t *at;
    size_t left;
    const wh_link_identity_t *identity; /* whose run and layout a message is made to belong to */
    int64_t next_seq;                   /* likewise */
} fuzz_frames_t;

/* The next one; false when there is none. */
bool fuzz_next_frame(fuzz_frames_t *frames, fuzz_frame_t *frame);

/* Whatever its channel's decoder takes, LCM encodes to the same bytes. True when it was taken. */
bool fuzz_check_decoding(const fuzz_frame_t *frame);

/* wh_grasp_hash of what a state message says, in its own terms; 0 when it cannot be. */
uint64_t fuzz_hash_of(const waferhand_state *message);

#endif
