#include "base/log.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static pthread_mutex_t log_mutex = PTHREAD_MUTEX_INITIALIZER;
static LogLevel log_level = LOG_INFO;
static bool log_muted;
static unsigned long log_warnings;
static void (*log_sink)(const char *line, void *context);
static void *log_sink_context;

static const char *const LEVEL_NAMES[] = {"warning", "info"};

bool stream_is_terminal(FILE *stream)
{
    const char *kind = getenv("TERM");
    return isatty(fileno(stream)) == 1 && kind && kind[0] && strcmp(kind, "dumb") != 0;
}

void log_level_set(LogLevel level)
{
    pthread_mutex_lock(&log_mutex);
    log_level = level;
    pthread_mutex_unlock(&log_mutex);
}

void log_mute(bool mute)
{
    pthread_mutex_lock(&log_mutex);
    log_muted = mute;
    pthread_mutex_unlock(&log_mutex);
}

void log_sink_set(void (*sink)(const char *line, void *context), void *context)
{
    pthread_mutex_lock(&log_mutex);
    log_sink = sink;
    log_sink_context = context;
    pthread_mutex_unlock(&log_mutex);
}

unsigned long log_warning_count(void)
{
    pthread_mutex_lock(&log_mutex);
    unsigned long count = log_warnings;
    pthread_mutex_unlock(&log_mutex);
    return count;
}

/* The caller holds the mutex. */
static void line_write(const char *line)
{
    if (log_sink)
        log_sink(line, log_sink_context);
    else
        fprintf(stderr, "%s%s\n", stream_is_terminal(stderr) ? "\r\033[K" : "", line);
}

static void log_write(LogLevel level, const char *where, const char *text)
{
    char line[2304]; /* 512 for the place, 1536 for the text */
    snprintf(line, sizeof line, "%s%s: %s", where, LEVEL_NAMES[level], text);
    text_make_printable(line);
    pthread_mutex_lock(&log_mutex);
    if (level == LOG_WARNING && !log_muted)
        ++log_warnings;
    if (level <= log_level && !log_muted)
        line_write(line);
    pthread_mutex_unlock(&log_mutex);
}

void log_error(const Error *error)
{
    char fix[sizeof error->fix + 16];
    snprintf(fix, sizeof fix, "  fix: %.*s", (int)sizeof error->fix - 1, error->fix);
    pthread_mutex_lock(&log_mutex);
    line_write(error->message);
    if (error->fix[0])
        line_write(fix);
    pthread_mutex_unlock(&log_mutex);
}

void log_message(LogLevel level, const char *format, ...)
{
    char text[1536];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    log_write(level, "", text);
}

void log_message_at(LogLevel level, SourcePlace place, const char *format, ...)
{
    char text[1536];
    char where[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    place_print(where, sizeof where, place);
    log_write(level, where, text);
}
