xorvox_fuzzer(timeline SOURCES timeline.cpp LINK xorvox::host)
