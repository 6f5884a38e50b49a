xorvox_fuzzer(voxelizer SOURCES voxelizer.cpp ../unit/voxelizer/oracle.cpp LINK xorvox::voxelizer)
