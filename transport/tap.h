// Tap: wraps a link and shows what passes, without changing it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "transport/link.h"

namespace xorvox::transport {

/// Seen from the end that is wrapped.
enum class Passing : std::uint8_t { Sent, Received };

/// Is shown every packet that the link took or gave, in their order, when it did. Called on the link's thread.
using Listener = std::function<void(Passing passing, std::span<const std::byte> packet)>;

/// Takes over `inner`, which must be open. The result has its info(), and its thread rules.
UniqueLink with_tap(UniqueLink inner, Listener listener);

}  // namespace xorvox::transport
