xorvox_fuzzer(display SOURCES display.cpp LINK xorvox::driver)
