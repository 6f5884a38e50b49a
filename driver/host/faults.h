// Faults: why a device is dark, in words for its user.
#pragma once

#include "driver/wire/messages.h"

namespace xorvox::host {

/// What happened and what to do about it, as the rest of a sentence that names the device: "its rotor stands or turns
/// too slowly; …". Static storage, never null.
const char* describe(wire::Fault fault);

}  // namespace xorvox::host
