xorvox_fuzzer(calibration SOURCES calibration.cpp LINK xorvox::host)
