#include "logfile.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#define HEADER 28
#define SYNC UINT32_C(0xeda1da01)
/* No event of any program is longer. */
#define LONGEST INT32_C(0x10000000)

FILE *wh_log_file(const char *path) {
    struct stat status;
    FILE *file = fopen(path, "rb");
    if (file && fstat(fileno(file), &status) == 0 && S_ISDIR(status.st_mode)) {
        (void)fclose(file);
        errno = EISDIR;
        return NULL;
    }
    return file;
}

void wh_log_open(wh_log_t *log, FILE *file) {
    memset(log, 0, sizeof *log);
    log->file = file;
}

static uint64_t big_endian(const uint8_t *bytes, size_t count) {
    uint64_t value = 0;
    for (size_t i = 0; i < count; ++i) {
        value = value << 8 | bytes[i];
    }
    return value;
}

static bool pass_over(FILE *file, size_t size) {
    uint8_t waste[4096];
    while (size > 0) {
        const size_t part = size < sizeof waste ? size : sizeof waste;
        if (fread(waste, 1, part, file) != part) {
            return false;
        }
        size -= part;
    }
    return true;
}

static bool read_channel(wh_log_t *log, size_t length) {
    if (length >= sizeof log->channel) {
        log->channel[0] = '\0';
        return pass_over(log->file, length);
    }
    log->channel[length] = '\0';
    return fread(log->channel, 1, length, log->file) == length;
}

static bool read_data(wh_log_t *log, size_t length) {
    log->size = length <= sizeof log->data ? length : 0;
    if (length > sizeof log->data) {
        return pass_over(log->file, length);
    }
    return fread(log->data, 1, length, log->file) == length;
}

static wh_log_result_t read_header(wh_log_t *log, uint8_t header[HEADER]) {
    const size_t got = fread(header, 1, HEADER, log->file);
    if (got == 0) {
        return WH_LOG_END;
    }
    if (got >= 4 && big_endian(header, 4) != SYNC) {
        return WH_LOG_DAMAGED;
    }
    return got < HEADER ? WH_LOG_CUT : WH_LOG_EVENT;
}

wh_log_result_t wh_log_next(wh_log_t *log) {
    uint8_t header[HEADER];
    log->offset = log->next;
    const wh_log_result_t result = read_header(log, header);
    if (result != WH_LOG_EVENT) {
        return result;
    }
    const uint64_t channel = big_endian(header + 20, 4);
    const uint64_t data = big_endian(header + 24, 4);
    if (channel == 0 || channel > 1000 || data > LONGEST) {
        return WH_LOG_DAMAGED;
    }
    log->timestamp_us = (int64_t)big_endian(header + 12, 8);
    if (!read_channel(log, (size_t)channel) || !read_data(log, (size_t)data)) {
        return WH_LOG_CUT;
    }
    log->next = log->offset + HEADER + channel + data;
    ++log->count;
    return WH_LOG_EVENT;
}
