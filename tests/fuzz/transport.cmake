xorvox_fuzzer(framing SOURCES framing.cpp LINK xorvox::transport)
