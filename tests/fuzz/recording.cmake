xorvox_fuzzer(recording SOURCES recording.cpp LINK xorvox::recording)
