// driver/host/shared_frames.h as a program in C has it: shared_frames_c.c is compiled as C11. What is passed as void is
// an xorvox_frames, which C and C++ lay out alike, as the tests check.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sizes and offsets of what both ends share, as C sees them: an array that ends with 0. */
extern const size_t xorvox_test_c_layout[];

int xorvox_test_c_connect(void* frames, const char* path);
int xorvox_test_c_publish(void* frames, uint32_t page, uint64_t tag);
uint32_t xorvox_test_c_begin(const void* frames);
void xorvox_test_c_end(void* frames, uint32_t page, uint64_t tag);
void xorvox_test_c_close(void* frames);

#ifdef __cplusplus
}
#endif
