/* Messages to the user on standard error. Thread-safe; clears a progress line on the terminal first. */
#ifndef TWINLIGHT_BASE_LOG_H
#define TWINLIGHT_BASE_LOG_H

#include "base/error.h"

/* Whether the stream is a terminal that understands ANSI escape codes. False with TERM=dumb or without TERM. */
bool stream_is_terminal(FILE *stream);

typedef enum LogLevel {
    LOG_WARNING, /* the image may differ from what the scene asks for */
    LOG_INFO /* an interpretation of the input worth knowing */
} LogLevel;

/* Messages above `level` are dropped. Default LOG_INFO. */
void log_level_set(LogLevel level);

/* While `mute` is true, drops warnings and infos without counting them: for input that is read a second time. */
void log_mute(bool mute);

/* "warning: ...", "info: ..." */
void log_message(LogLevel level, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* "file:line:column: warning: ..." */
void log_message_at(LogLevel level, SourcePlace place, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Prints one of several errors with its fix; main prints the last. Not affected by log_mute, not counted as a
 * warning. */
void log_error(const Error *error);

/* Number of warnings so far. */
unsigned long log_warning_count(void);

/* Redirects all messages to `sink` (NULL: standard error), for tests. */
void log_sink_set(void (*sink)(const char *line, void *context), void *context);

#endif
