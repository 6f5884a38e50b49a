// The kernel of --kernel.
#pragma once

#include <string>

#include "voxelizer/error.h"
#include "voxelizer/kernels/kernel.h"

namespace xorvox::tools {

/// The kernel called `name`, or the best one when it is empty. Fails, and lists what there is, when there is no such
/// kernel or this machine cannot run it.
Expected<Kernel> choose_kernel(const std::string& name);

}  // namespace xorvox::tools
