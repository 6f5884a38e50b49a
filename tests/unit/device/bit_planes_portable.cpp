#include "tests/unit/device/bit_planes_portable.h"

#undef __SSE2__
#define split_bit_planes split_bit_planes_portable
#include "driver/device/bit_planes.cpp"
