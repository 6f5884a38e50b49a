// Status: what an operation of the core, the device half or a link answers.
//
// Freestanding: no allocation, no exceptions, usable from an interrupt handler. Every module may include it.
#pragma once

#include <cstdint>

namespace xorvox {

/// The answer of an operation that can fail without a message of its own. Unless a function says otherwise, everything
/// but `Ok` leaves its outputs untouched.
enum class [[nodiscard]] Status : std::uint8_t{
    Ok = 0,
    InvalidArgument,  ///< The call itself is wrong: a null buffer, a size of zero, shapes that do not match.
    OutOfRange,       ///< A number does not fit: a vertex beyond the snapping grid, a lattice over 4096 a side.
    OutOfMemory,      ///< A buffer of the caller is too small, or the heap of a hosted part is exhausted.
    Unsupported,      ///< The optional operation, feature or codec is not there.
    WouldBlock,       ///< Nothing was done because it would have to wait; try again.
    Closed,           ///< The peer or the device is gone, and stays gone for this object.
    Corrupt,          ///< The bytes do not say what they should: bad magic, checksum, length or code.
    Timeout,          ///< The time allowed has passed.
    Refused,          ///< The peer is there and says no.
    Cancelled,        ///< The caller asked to stop; outputs are incomplete.
};

/// The name of `status`, as written above. Never null; static storage.
constexpr const char* to_string(Status status) {
    switch (status) {
        case Status::Ok: return "Ok";
        case Status::InvalidArgument: return "InvalidArgument";
        case Status::OutOfRange: return "OutOfRange";
        case Status::OutOfMemory: return "OutOfMemory";
        case Status::Unsupported: return "Unsupported";
        case Status::WouldBlock: return "WouldBlock";
        case Status::Closed: return "Closed";
        case Status::Corrupt: return "Corrupt";
        case Status::Timeout: return "Timeout";
        case Status::Refused: return "Refused";
        case Status::Cancelled: return "Cancelled";
    }
    return "unknown status";
}

}  // namespace xorvox
