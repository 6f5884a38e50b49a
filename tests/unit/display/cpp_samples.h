// Display files that use every key, for the tests of to_cpp(): one compiles them, the other compares.
#pragma once

namespace xorvox::test {

inline constexpr const char* kCppSamples[] = {
    R"(name = 'Kreisel "ä" \'
kind = "rotating-panel"
format = "rgb565"
slices = 90
cycles_per_second = 25.1
clockwise = true
[[panel]]
columns = 10
rows = 8
column_pitch_mm = 0.1
row_pitch_mm = 1e-4
shift_mm = 0.75
offset_mm = 4.000000000000001
lift_mm = -1e5
angle_deg = 1.1
tilt_deg = -3.3
skew_mm = 0.3
mirrored = true
turned = 3
connector = 7
chain_position = 0
[[panel]]
columns = 20
rows = 8
column_pitch_mm = 0.75
row_pitch_mm = 2.5
connector = 7
chain_position = 1
[sync]
index = "encoder"
index_pulses = 1024
index_phase = 0.1
slowest_cycles_per_second = 20.5
fastest_cycles_per_second = 30.5
[scan]
driver = "hub75"
pixel_clock_hz = 20000000
latch_ns = 11
min_on_ns = 112
rise_ns = 13
fall_ns = 14
row_groups = 4
bit_planes = 3
bit_order = "lsb-first"
color_order = "gbr"
[light]
response = "gamma"
gamma = 1.85
[power]
led_ma = 1.5
max_duty = 0.3
limit_ma = 123.456
)",
    R"(name = "half"
kind = "rotating-panel"
format = "mono2"
slices = 90
cycles_per_second = 25
sweep_deg = 180
[[panel]]
columns = 10
rows = 8
column_pitch_mm = 0.1
row_pitch_mm = 0.2
)",
    R"(name = "swept"
kind = "swept-plane"
format = "mono1"
slices = 10
cycles_per_second = 15
[motion]
stroke_mm = 80.5
profile = "table"
both_ways = true
dead_zone = 0.05
table = [0, 0.1, 0.30000000000000004, 1]
[[panel]]
columns = 10
rows = 8
column_pitch_mm = 0.1
row_pitch_mm = 0.2
[scan]
driver = "dlp"
planes_per_frame = 24
[light]
response = "cie1931"
)",
    R"(name = "helix"
kind = "helix"
format = "rgb555"
slices = 10
cycles_per_second = 15
blades = 2
clockwise = true
motion.stroke_mm = 80
[[panel]]
columns = 10
rows = 8
column_pitch_mm = 0.1
row_pitch_mm = 0.2
)",
    R"(name = "uneven"
kind = "stacked-planes"
format = "mono4"
slices = 3
cycles_per_second = 15
plane_heights_mm = [-10, 0.1, 12]
[[panel]]
columns = 10
rows = 8
column_pitch_mm = 0.1
row_pitch_mm = 0.2
[scan]
driver = "74hc595"
register_order = "layers-first"
)",
    R"(name = "--"
kind = "free-points"
format = "rgb888"
cycles_per_second = 60
points = [[0, 0, 0], [0.1, -2, 3e-5], [1, 1, 1], [2, 2, 2]]
[[panel]]
columns = 2
rows = 2
[scan]
driver = "apa102"
strings = 2
serpentine = true
)",
};

}  // namespace xorvox::test
