// Part of the firmware's test: the scan-out of a cube behind 74HC595, over lines that are a table written by hand.
#pragma once

#include <cstdint>

#include "driver/device/device.h"
#include "driver/device/scan_control.h"

/// Scans the page of `device` (8 × 8 × 8 of mono1) out for two cycles from `now_ns` on, which goes on meanwhile, by a
/// control that it initializes. What is wrong, or null.
const char* scan_out(xorvox::device::Device& device, xorvox::device::ScanControl& control, std::uint64_t& now_ns);
