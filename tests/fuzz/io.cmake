xorvox_fuzzer(ply SOURCES ply.cpp LINK xorvox::io)
xorvox_fuzzer(stl SOURCES stl.cpp LINK xorvox::io)
xorvox_fuzzer(obj SOURCES obj.cpp LINK xorvox::io)
xorvox_fuzzer(image SOURCES image.cpp LINK xorvox::io)
