/* spin: a helix that turns, drawn on whatever display `xorvox share` drives. An example of shared frames in C.

       cc -std=c11 -O2 -I. examples/share/spin.c -o spin -lm
       xorvox share --display cube16-ws2812 --socket /tmp/cube --to tcp:127.0.0.1:7777 &
       ./spin /tmp/cube

   Usage: spin SOCKET [FRAMES [message|atomics]]: how many frames, 0 (as without it) for no end; and how they are
   published. It says how many pixels are lit in the last frame. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "driver/host/shared_frames.h"

enum { ROTATING_PANEL = 2, MONO1 = 1, MONO2 = 7, MONO4 = 8 };

/* Where the helix is at an angle, of 0 to 1 in a turn: one of `steps` heights. */
static uint32_t height_at(double angle, double turn, uint32_t steps) {
    const double height = angle + turn;
    return (uint32_t)((height - floor(height)) * steps) % steps;
}

/* A colour of the rainbow, from `part` 0 to 1; on displays of one colour, all of it. */
static uint32_t rainbow(uint32_t format, double part) {
    if (format == MONO1 || format == MONO2 || format == MONO4) return xorvox_frames_code(format, 255, 255, 255);
    const double r = fabs(6 * part - 3) - 1, g = 2 - fabs(6 * part - 2), b = 2 - fabs(6 * part - 4);
    return xorvox_frames_code(format, (uint8_t)(255 * fmax(0, fmin(1, r))), (uint8_t)(255 * fmax(0, fmin(1, g))),
                              (uint8_t)(255 * fmax(0, fmin(1, b))));
}

/* Draws the helix at `turn`, 0 to 1, into a page. The pixels that are lit. */
static unsigned long draw(const xorvox_frames *frames, uint32_t page, double turn) {
    const xorvox_frames_segment *const s = frames->segment;
    unsigned long lit = 0;
    memset(xorvox_frames_page(frames, page), 0, (size_t)s->frame_bytes);
    if (s->display_kind == ROTATING_PANEL) {
        /* A slice is an angle, a row a height; what is left of the axis stands half a turn further. */
        for (uint32_t slice = 0; slice < s->slices; ++slice) {
            for (uint32_t p = 0; p < s->panel_count; ++p) {
                for (uint32_t column = 0; column < s->panel[p].columns; ++column) {
                    const double angle = (double)slice / s->slices + (column < s->panel[p].columns / 2 ? 0.5 : 0.0);
                    const uint32_t row = height_at(angle, turn, s->panel[p].rows);
                    const uint32_t code = rainbow(s->pixel_format, (double)row / s->panel[p].rows);
                    xorvox_frames_put(frames, page, slice, p, row, column, code);
                    lit += code != 0;
                }
            }
        }
        return lit;
    }
    /* Slices lie one above the other. */
    for (uint32_t row = 0; row < s->panel[0].rows; ++row) {
        for (uint32_t column = 0; column < s->panel[0].columns; ++column) {
            const double x = column - (s->panel[0].columns - 1) / 2.0;
            const double y = row - (s->panel[0].rows - 1) / 2.0;
            const double angle = atan2(y, x) / (2 * 3.14159265358979324);
            const uint32_t slice = height_at(angle, turn, s->slices);
            const uint32_t code = rainbow(s->pixel_format, (double)slice / s->slices);
            xorvox_frames_put(frames, page, slice, 0, row, column, code);
            lit += code != 0;
        }
    }
    return lit;
}

int main(int argc, char **argv) {
    const unsigned long count = argc > 2 ? strtoul(argv[2], NULL, 10) : 0;
    const int by_atomics = argc > 3 && strcmp(argv[3], "atomics") == 0;
    unsigned long lit = 0;
    xorvox_frames frames;
    int status;
    if (argc < 2) {
        fprintf(stderr, "usage: spin SOCKET [FRAMES [message|atomics]]\n");
        return 2;
    }
    status = xorvox_frames_connect(&frames, argv[1]);
    if (status != XORVOX_FRAMES_OK) {
        fprintf(stderr, "spin: %s: %s (xorvox share must be running there)\n", argv[1], xorvox_frames_text(status));
        return 2;
    }
    printf("drawing on %s\n", frames.segment->display_name);
    for (unsigned long i = 0; status == XORVOX_FRAMES_OK && (count == 0 || i < count); ++i) {
        const struct timespec cycle = {(time_t)(frames.segment->cycle_ns / 1000000000),
                                       (long)(frames.segment->cycle_ns % 1000000000)};
        /* The helix turns once in four seconds. */
        const double turn = fmod((double)i * (double)frames.segment->cycle_ns * 0.25e-9, 1.0);
        const uint32_t page = by_atomics ? xorvox_frames_begin(&frames) : 0;
        if (page == XORVOX_FRAMES_NO_PAGE) break;
        lit = draw(&frames, page, turn);
        if (by_atomics) {
            xorvox_frames_end(&frames, page, i);
        } else {
            status = xorvox_frames_publish(&frames, page, i);
        }
        nanosleep(&cycle, NULL);
    }
    xorvox_frames_close(&frames);
    if (status != XORVOX_FRAMES_OK) {
        fprintf(stderr, "spin: %s\n", xorvox_frames_text(status));
        return 2;
    }
    printf("%lu pixels are lit in the last frame\n", lit);
    return 0;
}
