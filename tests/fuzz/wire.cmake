xorvox_fuzzer(packet SOURCES packet.cpp LINK xorvox::wire)
xorvox_fuzzer(lz4 SOURCES lz4.cpp LINK xorvox::device PkgConfig::LZ4)
xorvox_fuzzer(device SOURCES device.cpp LINK xorvox::device xorvox::wire)
xorvox_fuzzer(scan_control SOURCES scan_control.cpp LINK xorvox::device xorvox::wire)
