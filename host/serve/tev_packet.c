#include "serve/tev_packet.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define CHANNELS 3

/* Operations that a packet begins with, after its length. */
enum { TEV_CREATE_IMAGE = 4, TEV_UPDATE_IMAGE_V3 = 6 };

/* What is not data or name: length, operation, focus, the name's end, number of channels, their names, the rectangle,
 * and offsets and strides. */
#define HEADER_BYTES (4 + 1 + 1 + 1 + 4 + CHANNELS * 2 + 4 * 4 + CHANNELS * 2 * 8)

/* A packet being written. */
typedef struct Packet {
    unsigned char *start, *next;
} Packet;

static void put(Packet *packet, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; ++i)
        *packet->next++ = (unsigned char)(value >> (8 * i));
}

static void put_text(Packet *packet, const char *text)
{
    size_t size = strlen(text) + 1;
    memcpy(packet->next, text, size);
    packet->next += size;
}

static void put_channels(Packet *packet)
{
    static const char *const NAMES[CHANNELS] = {"R", "G", "B"};
    for (int c = 0; c < CHANNELS; ++c)
        put_text(packet, NAMES[c]);
}

/* The length is set at the end. */
static Packet packet_begin(unsigned char *out, int operation, bool focus, const char *image)
{
    Packet packet = {out, out + 4};
    put(&packet, (uint64_t)operation, 1);
    put(&packet, focus, 1);
    put_text(&packet, image);
    return packet;
}

static size_t packet_end(Packet *packet)
{
    size_t bytes = (size_t)(packet->next - packet->start);
    packet->next = packet->start;
    put(packet, bytes, 4);
    return bytes;
}

size_t tev_packet_bytes(const char *image, size_t values)
{
    return HEADER_BYTES + strlen(image) + values * sizeof(float);
}

size_t tev_packet_create(unsigned char *out, const char *image, int width, int height)
{
    Packet packet = packet_begin(out, TEV_CREATE_IMAGE, true, image);
    put(&packet, (uint64_t)width, 4);
    put(&packet, (uint64_t)height, 4);
    put(&packet, CHANNELS, 4);
    put_channels(&packet);
    return packet_end(&packet);
}

size_t tev_packet_update(unsigned char *out, const char *image, int y, int width, int rows, const float *rgb)
{
    Packet packet = packet_begin(out, TEV_UPDATE_IMAGE_V3, false, image);
    put(&packet, CHANNELS, 4);
    put_channels(&packet);
    const int rectangle[4] = {0, y, width, rows};
    for (int i = 0; i < 4; ++i)
        put(&packet, (uint64_t)rectangle[i], 4);
    for (int c = 0; c < CHANNELS; ++c)
        put(&packet, (uint64_t)c, 8); /* offsets in the data */
    for (int c = 0; c < CHANNELS; ++c)
        put(&packet, CHANNELS, 8); /* strides */
    size_t values = CHANNELS * (size_t)width * (size_t)rows;
    for (size_t i = 0; i < values; ++i) {
        uint32_t bits;
        memcpy(&bits, &rgb[i], sizeof bits);
        put(&packet, bits, 4);
    }
    return packet_end(&packet);
}
