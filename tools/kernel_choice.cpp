#include "tools/kernel_choice.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace xorvox::tools {

Expected<Kernel> choose_kernel(const std::string& name) {
    if (name.empty()) return best_kernel();
    const auto available = available_kernels();
    const std::optional<Kernel> kernel = kernel_named(name);
    if (kernel && std::ranges::find(available, *kernel) != available.end()) return *kernel;
    std::vector<std::string> names;
    for (const Kernel one : available) names.emplace_back(to_string(one));
    const std::string what = kernel ? fmt::format("this machine cannot run '{}'; it", name)
                                    : fmt::format("there is no '{}'; this machine", name);
    return fail(fmt::format("--kernel: {} can run {}", what, fmt::join(names, ", ")));
}

}  // namespace xorvox::tools
