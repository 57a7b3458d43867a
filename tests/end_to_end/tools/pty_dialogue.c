/* pty_dialogue PROGRAM ARGUMENT... <DIALOGUE: talks to a program at a terminal of its own, as a person would.
 *
 * Each line of the dialogue is one of
 *   send TEXT     with \t \n \e \\ and \xNN
 *   expect TEXT   waits until it was printed after the text of the last expect; at most 20 s
 *   pause MS
 *   signal NUMBER
 *   exit STATUS   waits until the program has ended; the terminal must be as it was
 * Prints the program's whole output. Exit: 0 if everything came as expected. */
#include <poll.h>
#include <pty.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>
#include <utmp.h>

static int terminal;
static pid_t child;
static struct termios at_start;
static char output[1 << 20];
static size_t length, seen;

static void fail(const char *what, const char *text) {
    printf("\n%s: %s\n", what, text);
    kill(child, SIGKILL);
    exit(1);
}

/* Reads the output of the next ms; false if there was none or the program closed its terminal. */
static bool listen_for(int milliseconds) {
    struct pollfd polled = {terminal, POLLIN, 0};
    if (poll(&polled, 1, milliseconds) <= 0) {
        return false;
    }
    const ssize_t bytes = read(terminal, output + length, sizeof output - 1 - length);
    if (bytes <= 0) {
        return false;
    }
    fwrite(output + length, 1, (size_t)bytes, stdout);
    fflush(stdout);
    length += (size_t)bytes;
    return true;
}

static void expect(const char *text) {
    const time_t end = time(NULL) + 20;
    for (;;) {
        output[length] = '\0';
        const char *found = strstr(output + seen, text);
        if (found) {
            seen = (size_t)(found - output) + strlen(text);
            return;
        }
        if (time(NULL) > end) {
            fail("did not come", text);
        }
        listen_for(100);
    }
}

static void send_text(const char *text) {
    char bytes[5000];
    size_t count = 0;
    for (; *text && count < sizeof bytes; ++text) {
        char byte = *text;
        if (byte == '\\') {
            ++text;
            byte = *text == 't' ? '\t' : *text == 'n' ? '\n' : *text == 'e' ? '\033' : *text;
            if (*text == 'x') {
                const char digits[] = {text[1], text[2], '\0'};
                byte = (char)strtol(digits, NULL, 16);
                text += 2;
            }
        }
        bytes[count++] = byte;
    }
    if (write(terminal, bytes, count) != (ssize_t)count) {
        fail("could not be sent", text);
    }
}

static void expect_exit(int wanted) {
    struct termios at_end;
    int status = 0;
    const time_t end = time(NULL) + 20;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (time(NULL) > end) {
            fail("did not end", "the program");
        }
        listen_for(100);
    }
    while (listen_for(0)) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != wanted) {
        printf("\nwait status %#x, expected exit status %d\n", (unsigned)status, wanted);
        exit(1);
    }
    if (tcgetattr(terminal, &at_end) != 0 || at_end.c_lflag != at_start.c_lflag ||
        at_end.c_iflag != at_start.c_iflag) {
        printf("\nthe terminal was left in another state\n");
        exit(1);
    }
}

static void perform(char *line) {
    char *text = strchr(line, ' ');
    line[strcspn(line, "\n")] = '\0';
    text = text ? text + 1 : line + strlen(line);
    if (strncmp(line, "send ", 5) == 0) {
        send_text(text);
    } else if (strncmp(line, "expect ", 7) == 0) {
        expect(text);
    } else if (strncmp(line, "pause ", 6) == 0) {
        for (int left = atoi(text); left > 0; left -= 10) {
            listen_for(0);
            usleep(10000);
        }
    } else if (strncmp(line, "signal ", 7) == 0) {
        kill(child, atoi(text));
    } else if (strncmp(line, "exit ", 5) == 0) {
        expect_exit(atoi(text));
    } else {
        fail("no such line in a dialogue", line);
    }
}

int main(int argc, char **argv) {
    char line[5000];
    const struct winsize size = {24, 80, 0, 0};
    int slave = -1;
    if (argc < 2 || openpty(&terminal, &slave, NULL, NULL, &size) != 0 || tcgetattr(slave, &at_start) != 0) {
        perror("pty_dialogue");
        return 1;
    }
    child = fork();
    if (child == 0) {
        close(terminal);
        login_tty(slave);
        execvp(argv[1], argv + 1);
        _exit(127);
    }
    /* The other end stays open here: its state can be checked when the program has ended. */
    while (fgets(line, sizeof line, stdin)) {
        perform(line);
    }
    return 0;
}
