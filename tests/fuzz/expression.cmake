xorvox_fuzzer(expression SOURCES expression.cpp LINK xorvox::voxelizer)
