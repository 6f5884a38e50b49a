// Workers: threads that wait, and do one job together each time they are asked. Hosted; internal to the voxelizer.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace xorvox {

class Workers {
public:
    /// `count` at least 1; the thread that calls run() is one of them.
    explicit Workers(unsigned count);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    unsigned count() const { return count_; }

    /// Calls job(0) in this thread and job(1) … job(count - 1) in the others, and returns when all are done. An
    /// exception of one of them is thrown here then. Allocates nothing.
    template <class Job>
    void run(const Job& job) {
        run_any([](const void* any, unsigned number) { (*static_cast<const Job*>(any))(number); }, &job);
    }

private:
    using Call = void (*)(const void* job, unsigned number);

    void run_any(Call call, const void* job);
    void work(unsigned number);
    void call(unsigned number);

    unsigned count_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable finished_;
    Call call_ = nullptr;
    const void* job_ = nullptr;
    std::size_t round_ = 0;
    unsigned busy_ = 0;
    bool ending_ = false;
    std::exception_ptr failure_;
    std::vector<std::jthread> threads_;
};

}  // namespace xorvox
