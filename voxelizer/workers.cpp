#include "voxelizer/workers.h"

#include <utility>

namespace xorvox {

Workers::Workers(unsigned count) : count_(count) {
    threads_.reserve(count - 1);
    try {
        for (unsigned number = 1; number < count; ++number) threads_.emplace_back([this, number] { work(number); });
    } catch (...) {
        {
            const std::lock_guard lock(mutex_);
            ending_ = true;
        }
        wake_.notify_all();
        threads_.clear();
        throw;
    }
}

Workers::~Workers() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_all();
}

void Workers::run_any(Call call_job, const void* job) {
    if (count_ == 1) return call_job(job, 0);
    {
        const std::lock_guard lock(mutex_);
        call_ = call_job;
        job_ = job;
        busy_ = count_ - 1;
        ++round_;
    }
    wake_.notify_all();
    call(0);
    std::unique_lock lock(mutex_);
    finished_.wait(lock, [this] { return busy_ == 0; });
    job_ = nullptr;
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Workers::call(unsigned number) {
    try {
        call_(job_, number);
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
    }
}

void Workers::work(unsigned number) {
    std::size_t seen = 0;
    while (true) {
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return ending_ || round_ != seen; });
            if (ending_) return;
            seen = round_;
        }
        call(number);
        bool last = false;
        {
            const std::lock_guard lock(mutex_);
            last = --busy_ == 0;
        }
        if (last) finished_.notify_one();
    }
}

}  // namespace xorvox
