xorvox_fuzzer(voxelizer SOURCES voxelizer.cpp ../unit/voxelizer/oracle.cpp LINK xorvox::voxelizer)
xorvox_fuzzer(transfer_function SOURCES transfer_function.cpp LINK xorvox::voxelizer)
