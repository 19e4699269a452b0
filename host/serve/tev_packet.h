/* Packets for tev, an image viewer (https://github.com/Tom94/tev): numbers are little-endian, and the first is the
 * number of bytes of the whole packet, itself included. */
#ifndef TWINLIGHT_SERVE_TEV_PACKET_H
#define TWINLIGHT_SERVE_TEV_PACKET_H

#include <stddef.h>

/* Bytes of a packet with `values` floats of an image of this name. */
size_t tev_packet_bytes(const char *image, size_t values);

/* Writes a packet that makes an empty image with channels R, G and B and brings it to the front; returns its bytes.
 * out[tev_packet_bytes(image, 0)]. */
size_t tev_packet_create(unsigned char *out, const char *image, int width, int height);

/* Writes a packet that replaces rows y ... y + rows - 1 of the image by rgb[3 * width * rows]; returns its bytes.
 * out[tev_packet_bytes(image, 3 * width * rows)]. */
size_t tev_packet_update(unsigned char *out, const char *image, int y, int width, int rows, const float *rgb);

#endif
