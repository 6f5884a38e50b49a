#include <cmath>
#include <cstdlib>

#include "voxelizer/transfer_function.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto color = [](std::string_view text) -> xorvox::Expected<glm::dvec3> {
        if (text.size() > 1) return xorvox::fail("no such colour");
        return glm::dvec3(text.empty() ? 0.0 : 1.0, 0.5, 1.0);
    };
    const auto transfer = xorvox::TransferFunction::parse({reinterpret_cast<const char*>(data), size}, color);
    if (!transfer) return 0;
    for (const double value : {-1e300, -1.0, 0.0, 0.3, 1.0, 1e300}) {
        const glm::vec3 light = transfer->at(value);
        for (int c = 0; c < 3; ++c) {
            if (!(light[c] >= 0.0f && light[c] <= 1.0f)) std::abort();
        }
    }
    return 0;
}
