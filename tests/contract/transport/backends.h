// The backends that the contract suite runs on. A new backend is added to backends.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "transport/link.h"

namespace xorvox::transport {

/// Two ends of an open link, and what the suite must know about it.
struct Ends {
    std::string backend;         ///< Its name, for messages.
    std::shared_ptr<void> keep;  ///< What the ends use; goes last.
    UniqueLink near;
    UniqueLink far;    ///< Not open yet when !live.
    bool live = true;  ///< Both ends exist at the same time; false for recordings.
    /// After the last packet from `near`: makes `far` able to receive them.
    std::function<void(Ends&)> deliver = [](Ends&) {};
};

struct Backend {
    std::string name;
    std::function<Ends()> open;
    bool threads = false;  ///< Two threads may use the two ends at once.
};

const std::vector<Backend>& backends();

}  // namespace xorvox::transport
