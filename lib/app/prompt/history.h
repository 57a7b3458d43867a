/* The prompt's history: a file of the lines that were typed, oldest first, for the next time.
 *
 * It is where wh_output_state_path puts "history", readable by its owner alone; without such a place the path
 * is empty. Each line is appended as it is typed, so that a killed program and two prompts at a time lose
 * nothing; a file that has grown long is cut when it is read. If anything fails with the file, the prompt
 * works without it.
 */
#ifndef WH_APP_PROMPT_HISTORY_H
#define WH_APP_PROMPT_HISTORY_H

/* The last lines are kept. A file of twice as many lines, or of this number of bytes, is cut to them. */
#define WH_HISTORY_LINES 500
#define WH_HISTORY_BYTES 1048576

/* Calls `line` for each of the last WH_HISTORY_LINES lines. Takes nothing but a regular file; lines with
 * control characters and lines longer than a session takes are left out. */
void wh_history_load(const char *path, void (*line)(void *user, const char *text), void *user);

/* Appends a line; makes the file and its folders where there are none. */
void wh_history_append(const char *path, const char *line);

#endif
