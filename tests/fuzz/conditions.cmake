xorvox_fuzzer(conditions SOURCES conditions.cpp LINK xorvox::sim)
