/* Messages to the user on standard error. Thread-safe; a progress line that is on the terminal is cleared first. */
#ifndef TWINLIGHT_BASE_LOG_H
#define TWINLIGHT_BASE_LOG_H

#include "base/error.h"

/* Whether the stream is a terminal that understands ANSI's escape codes: one with TERM=dumb, or without TERM, does
 * not. */
bool stream_is_terminal(FILE *stream);

typedef enum LogLevel {
    LOG_WARNING, /* the picture may not be what the scene asks for */
    LOG_INFO /* something was understood in a way worth knowing */
} LogLevel;

/* Messages above `level` are dropped. Default LOG_INFO. */
void log_level_set(LogLevel level);

/* Drops all messages, uncounted, while `mute` holds: what is read a second time has been spoken of. */
void log_mute(bool mute);

/* "warning: ...", "info: ..." */
void log_message(LogLevel level, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* "file:line:column: warning: ..." */
void log_message_at(LogLevel level, SourcePlace place, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* One of several errors, with what to do; main prints the last. Not muted, and no warning. */
void log_error(const Error *error);

/* Number of warnings so far. */
unsigned long log_warning_count(void);

/* Redirects the text of every message to `sink` (NULL: standard error), for tests. */
void log_sink_set(void (*sink)(const char *line, void *context), void *context);

#endif
