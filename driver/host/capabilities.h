// Capabilities: what a device says that it can do, held against what is to be sent. Internal to driver/host.
#pragma once

#include "driver/display/description.h"
#include "driver/wire/messages.h"
#include "transport/link.h"
#include "voxelizer/error.h"

namespace xorvox::host {

/// Whether frames for `display` may be sent to the device that said `hello`. The message names both sides and says what
/// to do. Nothing in `hello` is trusted before; wire::decode() has refused what no device can be.
Expected<void> check_capabilities(const wire::Hello& hello, const DisplayDescription& display);

/// What a link with no way back is assumed to lead to.
wire::Hello assumed_capabilities(const DisplayDescription& display, const LinkInfo& link);

}  // namespace xorvox::host
