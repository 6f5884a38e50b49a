// control: how a distant display is, and what it is told.
#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/host/faults.h"
#include "driver/host/session.h"
#include "tools/clock.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/stop.h"
#include "transport/address.h"
#include "transport/tcp.h"

namespace xorvox::tools {
namespace {

void print_text(const std::string& address, const wire::Hello& hello, const wire::DeviceStatus& status) {
    fmt::print("{} at {}, serial {}\n", hello.display.view(), address, hello.serial.view());
    if (status.has_frame != 0) {
        fmt::print("  shows frame {}{}\n", status.shown_frame, status.blank != 0 ? ", but is dark" : "");
    } else {
        fmt::print("  shows no frame yet{}\n", status.blank != 0 ? ", and is dark" : "");
    }
    fmt::print("  brightness {} of 255\n", status.brightness);
    fmt::print("  watchdog {}\n", status.watchdog_ms == 0 ? "off" : fmt::format("{} ms", status.watchdog_ms));
    fmt::print("  frames accepted {}, dropped {}; packets bad {}\n", thousands(status.frames_accepted),
               thousands(status.frames_dropped), thousands(status.packets_bad));
    if (status.faults == 0) fmt::print("  no fault\n");
    for (unsigned fault = 1; fault <= static_cast<unsigned>(wire::kHighestFault); ++fault) {
        const auto known = static_cast<wire::Fault>(fault);
        if ((status.faults & wire::fault_bit(known)) != 0) fmt::print("  fault {}: {}\n", fault, host::describe(known));
    }
}

void print_json(const std::string& address, const wire::Hello& hello, const wire::DeviceStatus& status) {
    std::string faults;
    for (unsigned fault = 1; fault <= static_cast<unsigned>(wire::kHighestFault); ++fault) {
        if ((status.faults & wire::fault_bit(static_cast<wire::Fault>(fault))) == 0) continue;
        faults += fmt::format("{}{}", faults.empty() ? "" : ", ", fault);
    }
    fmt::print(
        "{{\"display\": {}, \"serial\": {}, \"address\": {}, \"frame\": {}, \"blank\": {}, \"brightness\": {}, "
        "\"watchdog_ms\": {}, \"frames_accepted\": {}, \"frames_dropped\": {}, \"packets_bad\": {}, \"faults\": "
        "[{}]}}\n",
        json_string(hello.display.view()), json_string(hello.serial.view()), json_string(address),
        status.has_frame != 0 ? fmt::format("{}", status.shown_frame) : "null", status.blank != 0, status.brightness,
        status.watchdog_ms, status.frames_accepted, status.frames_dropped, status.packets_bad, faults);
}

/// Lets the session work until `done`.
template <class Done>
Expected<void> run(host::Session& session, Link link, const std::string& address, const Done& done) {
    while (!done()) {
        const Status moved = session.poll(clock_ns());
        if (session.state() == host::SessionState::Failed) {
            return fail(fmt::format("{}: {}", address, session.error().message));
        }
        if (asked_to_stop()) return fail(address + ": interrupted");
        if (moved == Status::WouldBlock) (void)link.wait(session.events(), 20'000'000);
    }
    return {};
}

}  // namespace

Expected<void> control(const ControlOptions& options) {
    const Expected<transport::Address> address = transport::parse_address(options.to);
    if (!address) return fail("--to: " + address.error().message);
    if (address->kind != transport::AddressKind::Tcp) {
        return fail(fmt::format("--to {}: only a display at the other end of a tcp link answers; use tcp:HOST:PORT",
                                options.to));
    }
    if (options.clear_fault == 0)
        return fail("--clear-fault 0: faults are numbered 1 to 7; without it they are listed");
    const auto display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    const Expected<UniqueLink> link = transport::connect_tcp(address->host, address->port);
    if (!link) return tl::unexpected(link.error());

    stop_on_signals();
    host::SessionOptions session_of = session_options(true, *display, {});
    // Who only asks leaves a display dark that nobody was there for; who wants it lit or dark is somebody.
    session_of.clears_silence = options.blank.has_value();
    host::Session session(link->get(), *display, session_of);
    const auto tell = [&](wire::ControlOperation operation, const std::optional<std::uint32_t>& value) {
        if (value) (void)session.control(operation, *value);
    };
    tell(wire::ControlOperation::ClearFault, options.clear_fault);
    tell(wire::ControlOperation::Brightness, options.brightness);
    tell(wire::ControlOperation::Watchdog, options.watchdog_ms);
    if (options.blank) tell(wire::ControlOperation::Blank, *options.blank ? 1u : 0u);
    // Nothing asked for: a status all the same. It is what answers every control, too.
    (void)session.control(wire::ControlOperation::Status, 0);
    const auto told = run(session, link->get(), options.to,
                          [&] { return session.state() == host::SessionState::Ready && session.idle(); });
    if (!told) return told;
    const wire::DeviceStatus& status = session.device_status();
    (options.json ? print_json : print_text)(options.to, session.device(), status);
    if (session.statistics().controls_lost > 0) {
        return fail(options.to + ": the display did not confirm everything it was told; it is as printed");
    }
    return {};
}

}  // namespace xorvox::tools
