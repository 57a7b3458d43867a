/* Recordings: slices hold the data of all messages, also from a network that loses, doubles and
 * swaps. Files of others stay unchanged, parts and frames can be read alone, and failures are
 * reported. */
#include "support/support.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <zstd.h>

#include "link/protocol_client.h"
#include "link/sim_process.h"
#include "log/logfile.h"
#include "log/recording.h"
#include "mcs/script_run.h"
#include "text/output.h"

static wh_recording_t record;
static char folder[WH_TEST_PATH];
static char path[PATH_MAX];

static const char *in_folder(const char *name) {
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int set_up(void **state) {
    (void)state;
    return mkdtemp(wh_test_path(folder, "recording")) ? 0 : -1;
}

static int tear_down(void **state) {
    char command[WH_TEST_PATH + 20];
    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static bool begin(const char *name, bool all, bool replaces, double part_mb) {
    static char kept[PATH_MAX];
    snprintf(kept, sizeof kept, "%s", name[0] == '/' ? name : in_folder(name));
    memset(&record, 0, sizeof record);
    record.options = (wh_recording_options_t){
        .path = kept, .program = "test", .all = all, .replaces = replaces, .part_mb = part_mb};
    return wh_recording_open(&record);
}

/* --------------------------------------------------------------------------------------------------- input */

static wh_node_t node;
static wh_protocol_client_t client;
static wh_sim_process_t simulation;

static wh_link_t *connect(void *user, wh_mcs_t *mcs) {
    const wh_protocol_client_options_t options = {.rate = 0};
    (void)user;
    assert_int_equal(wh_sim_process_open(&simulation, &node, mcs->layout, true), WH_OK);
    assert_true(wh_protocol_client_open(&client, &node, mcs->layout, &options));
    return &client.link;
}

/* Records every message of a script into all.log. */
static void record_all(const char *script) {
    wh_script_run_options_t options = {.script = script, .limits = {.print_to = stderr}};
    wh_script_run_t run;
    (void)unlink(in_folder("all.log"));
    memset(&record, 0, sizeof record);
    record.options = (wh_recording_options_t){.path = in_folder("all.log"), .program = "test", .all = true};
    assert_true(wh_recording_open_node(&record, &node, "memq://"));
    options.partners.connect = connect;
    assert_int_not_equal(wh_script_run(&run, &options), WH_RUN_BAD_INPUT);
    wh_sim_process_close(&simulation);
    wh_node_close(&node);
    assert_true(wh_recording_close(&record));
    wh_script_run_close(&run);
}

/* ------------------------------------------------------------------------------------------------- reading */

#define MOST 30000

/* The contents of a log: checks of its commands, and its states, from blocks and from whole states. */
typedef struct {
    int64_t commands[MOST];
    struct {
        int64_t seq;
        uint64_t hash;
        int64_t check; /* 0: from a block */
    } states[MOST];
    size_t command_count, state_count, blocks, whole_commands;
    int64_t events, slices, longest; /* slices without a whole state */
    waferhand_recording first, last;
} content_t;

static content_t all, some;
static wh_log_t in;
static wh_slices_t block;

static void take_block(content_t *content) {
    uint8_t bytes[4000];
    waferhand_command command;
    int32_t told[WH_GRIPPERS];
    uint64_t hash;
    assert_true(wh_slices_decode(in.data, in.size, &block));
    ++content->blocks;
    content->longest += (int64_t)block.count;
    for (size_t i = 0; i < block.count; ++i) {
        wh_slices_get(&block, i, &command, told, &hash);
        const int size = waferhand_command_encode(bytes, 0, sizeof bytes, &command);
        wh_link_seal(bytes, (size_t)size);
        assert_int_equal(waferhand_command_decode(bytes, 0, size, &command), size);
        content->commands[content->command_count++] = command.check;
        content->states[content->state_count].seq = command.seq;
        content->states[content->state_count].check = 0;
        content->states[content->state_count++].hash = hash;
        assert_true(content->state_count < MOST && content->command_count < MOST);
    }
}

static void take_state(content_t *content) {
    waferhand_state message;
    if (wh_link_decode_state(in.data, in.size, &message)) {
        assert_true(content->longest <= WH_SLICES_MOST);
        content->longest = 0;
        content->states[content->state_count].seq = message.seq;
        content->states[content->state_count].hash = (uint64_t)message.hash;
        content->states[content->state_count++].check = message.check;
        assert_true(content->state_count < MOST);
        (void)waferhand_state_decode_cleanup(&message);
    }
}

static void take_event(content_t *content) {
    waferhand_command command;
    waferhand_recording recording;
    if (strcmp(in.channel, WH_CHANNEL_SLICES) == 0) {
        take_block(content);
    } else if (strcmp(in.channel, WH_CHANNEL_STATE) == 0) {
        take_state(content);
    } else if (strcmp(in.channel, WH_CHANNEL_COMMAND) == 0 &&
               wh_link_decode_command(in.data, in.size, &command)) {
        assert_true(content->command_count < MOST);
        content->commands[content->command_count++] = command.check;
        ++content->whole_commands;
    } else if (strcmp(in.channel, WH_CHANNEL_RECORDING) == 0) {
        assert_true(wh_link_decode_recording(in.data, in.size, &recording));
        assert_int_equal(recording.version, WH_RECORDING_VERSION);
        assert_string_equal(recording.program, "test");
        *(recording.closed ? &content->last : &content->first) = recording;
        (void)waferhand_recording_decode_cleanup(&recording);
    }
}

static const char *fault; /* the fault of a log that cannot be opened */

/* Reads a whole log that was closed. */
static void read_log(const char *name, content_t *content) {
    FILE *file = wh_log_file(in_folder(name), &fault);
    assert_non_null(file);
    memset(content, 0, sizeof *content);
    wh_log_open(&in, file);
    wh_log_result_t result = wh_log_next(&in);
    assert_string_equal(in.channel, WH_CHANNEL_RECORDING);
    for (; result == WH_LOG_EVENT; result = wh_log_next(&in)) {
        take_event(content);
        ++content->events;
    }
    assert_int_equal(result, WH_LOG_END);
    assert_string_equal(in.channel, WH_CHANNEL_RECORDING);
    assert_int_not_equal(content->last.closed, 0);
    assert_int_equal(content->last.events, content->events - 1);
    assert_int_equal(content->last.id, content->first.id);
    (void)fclose(file);
}

/* Hands all.log's messages to the open record. */
static void feed_all(void) {
    char name[PATH_MAX];
    snprintf(name, sizeof name, "%s/all.log", folder);
    FILE *file = wh_log_file(name, &fault);
    wh_log_open(&in, file);
    while (wh_log_next(&in) == WH_LOG_EVENT) {
        wh_recording_message(&record, in.channel, in.data, in.size);
    }
    (void)fclose(file);
}

/* On a busy machine commands are repeated, some after the next one was sent; slices leave the repeats out. */
static bool is_among_the_last(const content_t *content, size_t end, int64_t check) {
    for (size_t i = end > 3 ? end - 3 : 0; i < end; ++i) {
        if (content->commands[i] == check) {
            return true;
        }
    }
    return false;
}

static void slices_hold_what_all_messages_hold(void **state) {
    static const char *const scripts[] = {"lua/examples/01_transfer.lua", "lua/examples/03_missed_pick.lua",
                                          "lua/examples/05_leak.lua", "lua/examples/06_cross_slotted.lua",
                                          "lua/examples/08_corrections.lua"};
    (void)state;
    for (size_t i = 0; i<sizeof scripts / sizeof scripts[0]; i += WH_TEST_SHARE> 1 ? 4 : 1) {
        record_all(scripts[i]);
        read_log("all.log", &all);
        (void)unlink(in_folder("some.log"));
        assert_true(begin("some.log", false, false, 0));
        feed_all();
        assert_true(wh_recording_close(&record));
        read_log("some.log", &some);
        size_t at = 0;
        for (size_t k = 0; k < all.command_count; ++k) {
            at += at < some.command_count && some.commands[at] == all.commands[k] ? 1 : 0;
            assert_true(is_among_the_last(&some, at, all.commands[k]));
        }
        assert_int_equal(at, some.command_count);
        at = 0;
        for (size_t k = 0; k < all.state_count; ++k) {
            for (; all.states[k].seq > some.states[at].seq; ++at) {
                assert_true(at + 1 < some.state_count);
            }
            assert_true(all.states[k].seq < some.states[at].seq ||
                        all.states[k].hash == some.states[at].hash);
        }
        assert_int_equal(some.last.slices, some.last.seq);
        /* The slices in which a fault begins or ends stand by themselves. */
        assert_true(some.whole_commands <= 2);
    }
}

/* ----------------------------------------------------------------------------------------- a poor network */

typedef struct {
    char channel[WH_LOG_CHANNEL_BYTES];
    size_t size;
    uint8_t data[4000];
} message_t;

#define FED 4000
static message_t fed[FED];
static size_t fed_count;

static void put_fed(const message_t *message) {
    if (fed_count < FED) {
        fed[fed_count++] = *message;
    }
}

/* At random a message is lost, damaged, doubled, or swapped with one of the last. */
static void put_by_luck(message_t *message) {
    const uint32_t luck = wh_test_below(100);
    if (luck == 0) {
        return;
    }
    if (luck == 1) {
        message->data[wh_test_below((uint32_t)message->size)] ^= 1;
    }
    put_fed(message);
    if (luck == 2 || luck == 3) {
        put_fed(message);
    }
    if (luck >= 4 && luck < 7 && fed_count > 8) {
        const size_t other = fed_count - 2 - wh_test_below(6);
        const message_t swapped = fed[other];
        fed[other] = fed[fed_count - 1];
        fed[fed_count - 1] = swapped;
    }
}

/* The first messages of all.log, as they arrive over a poor network. */
static void make_poor(void) {
    static message_t message;
    FILE *file = wh_log_file(in_folder("all.log"), &fault);
    wh_log_open(&in, file);
    fed_count = 0;
    while (fed_count < FED && wh_log_next(&in) == WH_LOG_EVENT) {
        if (in.size <= sizeof message.data && strcmp(in.channel, WH_CHANNEL_RECORDING) != 0) {
            memcpy(message.channel, in.channel, sizeof message.channel);
            message.size = in.size;
            memcpy(message.data, in.data, in.size);
            put_by_luck(&message);
        }
    }
    (void)fclose(file);
}

static bool has_command(const content_t *content, int64_t check) {
    for (size_t i = 0; i < content->command_count; ++i) {
        if (content->commands[i] == check) {
            return true;
        }
    }
    return false;
}

static bool has_state(const content_t *content, int64_t seq, uint64_t hash, int64_t check) {
    for (size_t i = 0; i < content->state_count; ++i) {
        if (content->states[i].seq == seq && content->states[i].hash == hash &&
            (content->states[i].check == 0 || content->states[i].check == check)) {
            return true;
        }
    }
    return false;
}

static void assert_recorded(const message_t *message) {
    waferhand_command command;
    waferhand_state state;
    if (strcmp(message->channel, WH_CHANNEL_COMMAND) == 0 &&
        wh_link_decode_command(message->data, message->size, &command)) {
        assert_true(has_command(&some, command.check));
    } else if (strcmp(message->channel, WH_CHANNEL_STATE) == 0 &&
               wh_link_decode_state(message->data, message->size, &state)) {
        assert_true(has_state(&some, state.seq, (uint64_t)state.hash, state.check));
        (void)waferhand_state_decode_cleanup(&state);
    }
}

static void nothing_is_lost_that_came_over_a_poor_network(void **state) {
    (void)state;
    wh_test_seed();
    record_all("lua/examples/05_leak.lua");
    for (int round = 0; round < 10; ++round) {
        make_poor();
        (void)unlink(in_folder("some.log"));
        assert_true(begin("some.log", false, false, 0));
        for (size_t i = 0; i < fed_count; ++i) {
            wh_recording_message(&record, fed[i].channel, fed[i].data, fed[i].size);
        }
        assert_true(wh_recording_close(&record));
        read_log("some.log", &some);
        assert_true(some.blocks > 0);
        for (size_t i = 0; i < fed_count; ++i) {
            assert_recorded(&fed[i]);
        }
    }
}

/* ------------------------------------------------------------------------------------------ parts, frames */

static void each_part_can_be_read_alone(void **state) {
    (void)state;
    record_all("lua/examples/01_transfer.lua");
    (void)unlink(in_folder("parts.log"));
    assert_true(begin("parts.log", false, false, 0.02));
    for (int round = 0; round < 3; ++round) {
        /* Only bytes that have reached the file count. */
        feed_all();
        usleep(2 * WH_RECORDING_WAIT_US);
    }
    const int32_t parts = record.part;
    assert_true(parts > 1);
    assert_true(wh_recording_close(&record));
    int64_t id = 0;
    for (int32_t part = 1; part <= parts; ++part) {
        char name[40];
        snprintf(name, sizeof name, part == 1 ? "parts.log" : "parts.part%d.log", (int)part);
        read_log(name, &some);
        assert_int_equal(some.first.part, part);
        assert_int_equal(some.last.closed, part == parts ? WH_RECORDING_ENDS : WH_RECORDING_GOES_ON);
        assert_true(part == 1 || id == some.first.id);
        id = some.first.id;
        /* A whole state comes before the first block, which continues from there. */
        assert_true(part == 1 || (some.states[0].check != 0 && some.states[0].seq == some.first.seq));
    }
}

/* Each frame consists of whole events. */
static void assert_events(const uint8_t *bytes, size_t size) {
    FILE *file = fmemopen(wh_link_borrowed((const char *)bytes), size, "rb");
    wh_log_open(&in, file);
    wh_log_result_t result;
    do {
        result = wh_log_next(&in);
    } while (result == WH_LOG_EVENT);
    assert_int_equal(result, WH_LOG_END);
    (void)fclose(file);
}

static void a_compressed_log_is_frames_of_whole_events(void **state) {
    static uint8_t packed[4 << 20];
    static uint8_t plain[4 << 20];
    (void)state;
    record_all("lua/examples/01_transfer.lua");
    (void)unlink(in_folder("run.log.zst"));
    assert_true(begin("run.log.zst", true, false, 0));
    feed_all();
    assert_true(wh_recording_close(&record));
    FILE *file = fopen(in_folder("run.log.zst"), "rb");
    const size_t size = fread(packed, 1, sizeof packed, file);
    (void)fclose(file);
    size_t frames = 0;
    for (size_t at = 0; at < size; ++frames) {
        const size_t length = ZSTD_findFrameCompressedSize(packed + at, size - at);
        assert_false(ZSTD_isError(length));
        const size_t count = ZSTD_decompress(plain, sizeof plain, packed + at, length);
        assert_false(ZSTD_isError(count));
        assert_events(plain, count);
        at += length;
    }
    assert_true(frames > 10);
}

/* --------------------------------------------------------------------------------------------------- files */

static void endings_stay_at_the_end(void **state) {
    static const char *const names[][2] = {{"run.log", "run.1.log"},         {"a.b/run", "a.b/run.1"},
                                           {"run.log.zst", "run.1.log.zst"}, {"a/.zst", "a/.zst.1"},
                                           {"run.zst", "run.1.zst"},         {".log", ".log.1"},
                                           {"x.y.log", "x.y.1.log"}};
    char name[PATH_MAX];
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        assert_true(wh_record_file_name(names[i][0], "1", name));
        assert_string_equal(name, names[i][1]);
    }
}

static void put_text(const char *name, const char *text) {
    FILE *file = fopen(in_folder(name), "w");
    fputs(text, file);
    (void)fclose(file);
}

static bool has_text(const char *name, const char *text) {
    char got[100] = "";
    FILE *file = fopen(in_folder(name), "r");
    (void)fgets(got, sizeof got, file);
    (void)fclose(file);
    return strcmp(got, text) == 0;
}

static void a_new_record_leaves_what_is_there(void **state) {
    (void)state;
    put_text("kept.log", "old");
    put_text("kept.1.log", "older");
    assert_true(begin("kept.log", false, false, 0));
    assert_true(wh_recording_close(&record));
    assert_true(has_text("kept.log", "old") && has_text("kept.1.log", "older"));
    read_log("kept.2.log", &some);
}

static void send_slice(int64_t seq) {
    uint8_t bytes[4000];
    waferhand_command command = {.utime = 1000 * seq, .seq = seq, .run = 5, .gripper_count = 1};
    const int32_t told[WH_GRIPPERS] = {0};
    command.gripper_position[0][0] = (double)seq;
    if (wh_recording_slice(&record, &command, told, 0, (uint64_t)seq, false) == WH_NOT_RECORDED) {
        const int size = waferhand_command_encode(bytes, 0, sizeof bytes, &command);
        wh_recording_message(&record, WH_CHANNEL_COMMAND, bytes, (size_t)size);
    }
}

static void a_run_replaces_a_log_with_its_first_slice(void **state) {
    (void)state;
    put_text("run.log", "old");
    assert_true(begin("run.log", false, true, 0));
    wh_recording_message(&record, WH_CHANNEL_REQUEST, "none", 4);
    assert_false(wh_recording_close(&record));
    assert_true(has_text("run.log", "old"));
    assert_true(begin("run.log", false, true, 0));
    send_slice(1);
    assert_true(wh_recording_close(&record));
    read_log("run.log", &some);
    assert_int_equal(some.state_count, 1);
}

/* An old recording in parts is never mixed with a new one. */
static void a_record_never_stands_beside_parts_of_another(void **state) {
    (void)state;
    for (int replaces = 0; replaces < 2; ++replaces) {
        put_text("st.log", "old");
        put_text("st.part2.log", "older");
        assert_true(begin("st.log", false, replaces, 0));
        send_slice(1);
        assert_true(wh_recording_close(&record));
        assert_true(has_text("st.log", "old") && has_text("st.part2.log", "older"));
        (void)unlink(in_folder("st.log"));
        assert_true(begin("st.log", false, replaces, 0));
        send_slice(1);
        assert_true(wh_recording_close(&record));
        assert_int_not_equal(access(in_folder("st.log"), F_OK), 0);
        assert_true(has_text("st.part2.log", "older"));
    }
    for (int i = 1; i <= 4; ++i) {
        char name[20];
        snprintf(name, sizeof name, "st.%d.log", i);
        read_log(name, &some);
        assert_int_equal(some.state_count, 1);
    }
}

/* run.1.log is continued in run.1.part2.log. */
static void parts_are_named_after_the_first_one(void **state) {
    (void)state;
    record_all("lua/examples/01_transfer.lua");
    put_text("named.log", "old");
    assert_true(begin("named.log", false, false, 0.05));
    feed_all();
    assert_true(wh_recording_close(&record));
    assert_true(has_text("named.log", "old"));
    read_log("named.1.log", &some);
    const int64_t id = some.first.id;
    read_log("named.1.part2.log", &some);
    assert_int_equal(some.first.part, 2);
    assert_true(some.first.id == id);
    assert_int_not_equal(access(in_folder("named.part2.log"), F_OK), 0);
}

static void a_run_spares_inputs_and_the_records_of_others(void **state) {
    (void)state;
    put_text("script.lua", "old");
    assert_true(begin("script.lua", false, true, 0));
    char input[PATH_MAX];
    snprintf(input, sizeof input, "%s/../%s/script.lua", folder, strrchr(folder, '/') + 1);
    wh_output_keep(input);
    send_slice(1);
    assert_false(wh_recording_close(&record));
    assert_true(has_text("script.lua", "old"));

    put_text("busy.log", "old");
    int fd = open(in_folder("busy.log"), O_WRONLY);
    assert_int_equal(flock(fd, LOCK_EX | LOCK_NB), 0);
    assert_false(begin("busy.log", false, true, 0));
    (void)close(fd);
    assert_true(begin("busy.log", false, true, 0));
    fd = open(in_folder("busy.log"), O_WRONLY);
    assert_int_equal(flock(fd, LOCK_EX | LOCK_NB), 0);
    send_slice(1);
    assert_false(wh_recording_close(&record));
    assert_true(has_text("busy.log", "old"));
    (void)close(fd);
    assert_false(begin("no/where.log", false, true, 0));
}

static void the_file_is_locked_while_it_is_written(void **state) {
    (void)state;
    assert_true(begin("locked.log", false, false, 0));
    const int fd = open(in_folder("locked.log"), O_RDONLY);
    assert_int_not_equal(flock(fd, LOCK_SH | LOCK_NB), 0);
    assert_true(wh_recording_close(&record));
    assert_int_equal(flock(fd, LOCK_SH | LOCK_NB), 0);
    (void)close(fd);
}

static void what_was_recorded_reaches_the_file_though_nothing_comes(void **state) {
    struct stat before;
    struct stat after;
    (void)state;
    assert_true(begin("slow.log", false, false, 0));
    usleep(2 * WH_RECORDING_WAIT_US);
    assert_int_equal(stat(in_folder("slow.log"), &before), 0);
    send_slice(1);
    usleep(2 * WH_RECORDING_WAIT_US);
    assert_int_equal(stat(in_folder("slow.log"), &after), 0);
    assert_true(before.st_size > 0 && after.st_size > before.st_size);
    assert_true(wh_recording_close(&record));
}

/* ------------------------------------------------------------------------------------------------- killed */

/* The child's recorded slices over time, as the parent sees them. */
#define MOMENTS 100000
typedef struct {
    volatile size_t count;
    int64_t us[MOMENTS];
    int64_t seq[MOMENTS];
} moments_t;

static int64_t now_us(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

static void record_for_ever(const char *name, moments_t *moments) {
    const bool is_open = begin(name, false, false, 0);
    for (int64_t seq = 1; is_open && moments->count < MOMENTS; ++seq) {
        send_slice(seq);
        if (seq % 16 == 0) {
            moments->us[moments->count] = now_us();
            moments->seq[moments->count] = seq;
            ++moments->count;
            usleep(100);
        }
    }
    _exit(1);
}

/* The last slice in the log, which is cut off somewhere. */
static int64_t find_last_seq(FILE *file) {
    int64_t last = 0;
    assert_non_null(file);
    wh_log_open(&in, file);
    while (wh_log_next(&in) == WH_LOG_EVENT) {
        if (strcmp(in.channel, WH_CHANNEL_SLICES) == 0) {
            assert_true(wh_slices_decode(in.data, in.size, &block));
            assert_int_equal(block.first, last + 1);
            last += (int64_t)block.count;
        }
    }
    (void)fclose(file);
    return last;
}

/* Kills a recording after this time; returns by how many us its log ends before that. */
static int64_t kill_after(const char *name, int64_t us, moments_t *moments) {
    char command[3 * PATH_MAX];
    int status;
    moments->count = 0;
    (void)unlink(in_folder(name));
    const pid_t child = fork();
    if (child == 0) {
        record_for_ever(name, moments);
    }
    usleep((useconds_t)us);
    (void)kill(child, SIGKILL);
    assert_int_equal(waitpid(child, &status, 0), child);
    const int64_t killed = moments->us[moments->count - 1];
    snprintf(command, sizeof command, "zstd -dqcf %s >%s/cut.log 2>/dev/null", in_folder(name), folder);
    (void)!system(command);
    const int64_t last = find_last_seq(wh_log_file(in_folder("cut.log"), &fault));
    size_t i = 0;
    while (i < moments->count && moments->seq[i] <= last) {
        ++i;
    }
    return i < moments->count ? killed - moments->us[i] : 0;
}

static void killed_at_any_moment_a_record_has_all_of_a_tenth_of_a_second_before(void **state) {
    moments_t *moments =
        mmap(NULL, sizeof *moments, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int64_t most = 0;
    (void)state;
    wh_test_seed();
    for (int i = 0; i < 20; ++i) {
        const int64_t lost =
            kill_after(i % 2 == 0 ? "killed.log" : "killed.log.zst", 150000 + wh_test_below(200000), moments);
        most = lost > most ? lost : most;
    }
    print_message("at most the last %lld ms were lost\n", (long long)most / 1000);
    /* Twice the time, for a busy machine. */
    assert_true(most < 2 * WH_RECORDING_WAIT_US);
    (void)munmap(moments, sizeof *moments);
}

static void a_record_that_fails_is_told(void **state) {
    (void)state;
    assert_false(begin("missing/run.log", false, false, 0));
    assert_true(begin("/dev/full", false, false, 0));
    assert_false(wh_recording_close(&record));

    assert_true(begin("removed.log", false, false, 0));
    (void)unlink(in_folder("removed.log"));
    send_slice(1);
    assert_false(wh_recording_close(&record));

    assert_true(begin("truncated.log", false, false, 0));
    usleep(2 * WH_RECORDING_WAIT_US);
    assert_int_equal(truncate(in_folder("truncated.log"), 5), 0);
    send_slice(1);
    usleep(2 * WH_RECORDING_WAIT_US);
    send_slice(2);
    assert_false(wh_recording_close(&record));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_hold_what_all_messages_hold),
        cmocka_unit_test(nothing_is_lost_that_came_over_a_poor_network),
        cmocka_unit_test(each_part_can_be_read_alone),
        cmocka_unit_test(a_compressed_log_is_frames_of_whole_events),
        cmocka_unit_test(endings_stay_at_the_end),
        cmocka_unit_test(a_new_record_leaves_what_is_there),
        cmocka_unit_test(a_run_replaces_a_log_with_its_first_slice),
        cmocka_unit_test(a_record_never_stands_beside_parts_of_another),
        cmocka_unit_test(parts_are_named_after_the_first_one),
        cmocka_unit_test(a_run_spares_inputs_and_the_records_of_others),
        cmocka_unit_test(the_file_is_locked_while_it_is_written),
        cmocka_unit_test(what_was_recorded_reaches_the_file_though_nothing_comes),
        cmocka_unit_test(a_record_that_fails_is_told),
        cmocka_unit_test(killed_at_any_moment_a_record_has_all_of_a_tenth_of_a_second_before),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
