#include "tests/unit/host/shared_frames_c.h"

#include "driver/host/shared_frames.h"

#define FIELD(type, member) offsetof(xorvox_frames##type, member), sizeof(((xorvox_frames##type *)0)->member)

const size_t xorvox_test_c_layout[] = {
    sizeof(xorvox_frames),
    FIELD(, segment),
    FIELD(, socket),
    FIELD(, taken),
    FIELD(_segment, page_stride_bytes),
    FIELD(_segment, display_name),
    FIELD(_segment, panel),
    FIELD(_segment, tag),
    FIELD(_segment, latest),
    FIELD(_segment, released),
    sizeof(xorvox_frames_segment),
    FIELD(_hello, pixel_format),
    FIELD(_request, tag),
    FIELD(_reply, sequence),
    0,
};

int xorvox_test_c_connect(void *frames, const char *path) {
    return xorvox_frames_connect((xorvox_frames *)frames, path);
}
int xorvox_test_c_publish(void *frames, uint32_t page, uint64_t tag) {
    return xorvox_frames_publish((xorvox_frames *)frames, page, tag);
}
uint32_t xorvox_test_c_begin(const void *frames) {
    return xorvox_frames_begin((const xorvox_frames *)frames);
}
void xorvox_test_c_end(void *frames, uint32_t page, uint64_t tag) {
    xorvox_frames_end((xorvox_frames *)frames, page, tag);
}
void xorvox_test_c_close(void *frames) {
    xorvox_frames_close((xorvox_frames *)frames);
}
