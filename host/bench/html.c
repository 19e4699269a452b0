#include "bench/html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DASH "\u2013"
#define MINUS "\u2212"

void html_text(FILE *stream, const char *text)
{
    for (; *text; ++text) {
        switch (*text) {
        case '&':
            fputs("&amp;", stream);
            break;
        case '<':
            fputs("&lt;", stream);
            break;
        case '>':
            fputs("&gt;", stream);
            break;
        case '"':
            fputs("&quot;", stream);
            break;
        default:
            fputc((unsigned char)*text < 0x20 || *text == 0x7f ? ' ' : *text, stream);
        }
    }
}

/* Base64 as in RFC 4648. */
void html_png(FILE *stream, const unsigned char *bytes, size_t size)
{
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    fputs("data:image/png;base64,", stream);
    for (size_t i = 0; i < size; i += 3) {
        unsigned word = (unsigned)bytes[i] << 16;
        word |= i + 1 < size ? (unsigned)bytes[i + 1] << 8 : 0u;
        word |= i + 2 < size ? (unsigned)bytes[i + 2] : 0u;
        fputc(DIGITS[word >> 18], stream);
        fputc(DIGITS[word >> 12 & 63], stream);
        fputc(i + 1 < size ? DIGITS[word >> 6 & 63] : '=', stream);
        fputc(i + 2 < size ? DIGITS[word & 63] : '=', stream);
    }
}

/* An exponent in superscript digits. */
static void superscript(char *text, size_t size, int number)
{
    static const char *const DIGITS[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    char plain[16];
    size_t used = (size_t)snprintf(text, size, "%s", number < 0 ? "\u207b" : "");
    snprintf(plain, sizeof plain, "%d", abs(number));
    for (const char *c = plain; *c; ++c)
        used += (size_t)snprintf(text + used, size - used, "%s", DIGITS[*c - '0']);
}

void html_number_text(char *text, size_t size, double value, int digits)
{
    char plain[32], power[40];
    if (!isfinite(value)) {
        snprintf(text, size, DASH);
        return;
    }
    snprintf(plain, sizeof plain, "%.*e", digits - 1, fabs(value));
    int exponent = (int)strtol(strchr(plain, 'e') + 1, NULL, 10);
    const char *sign = value < 0.0 ? MINUS : "";
    if (value != 0.0 && (exponent < -3 || exponent > 6)) {
        *strchr(plain, 'e') = '\0';
        superscript(power, sizeof power, exponent);
        snprintf(text, size, "%s%s\u00d710%s", sign, plain, power);
    } else {
        int decimals = digits - 1 - exponent;
        if (decimals < 0)
            value = round(value * pow(10.0, decimals)) * pow(10.0, -decimals);
        snprintf(text, size, "%s%.*f", sign, decimals > 0 && value != 0.0 ? decimals : 0, fabs(value));
    }
}

void html_number(FILE *stream, double value, int digits)
{
    char text[64];
    html_number_text(text, sizeof text, value, digits);
    fputs(text, stream);
}
