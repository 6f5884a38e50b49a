xorvox_fuzzer(shared_frames SOURCES shared_frames.cpp LINK xorvox::host)
