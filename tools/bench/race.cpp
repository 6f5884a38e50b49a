#include "tools/bench/race.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace xorvox::tools {
namespace {

double wall_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void run_once(Runner& runner) {
    const double cpu_start_ms = processor_ms();
    const double start_ms = wall_ms();
    runner.work();
    runner.runs_ms.push_back(wall_ms() - start_ms);
    runner.cpu_ms.push_back(processor_ms() - cpu_start_ms);
}

double time_ms(const std::function<void()>& work) {
    const double start_ms = wall_ms();
    work();
    return wall_ms() - start_ms;
}

/// How often a work is to run, by how long it takes when it is warm.
std::size_t planned_runs(const std::function<void()>& work, const Pace& pace) {
    double warm_ms = time_ms(work);
    if (10.0 * warm_ms < pace.budget_ms) warm_ms = time_ms(work);
    const double fitting = std::min(pace.budget_ms / std::max(warm_ms, 1e-6), static_cast<double>(pace.most_runs));
    return std::max(pace.least_runs, static_cast<std::size_t>(fitting));
}

}  // namespace

double processor_ms() {
    timespec used = {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) * 1e3 + static_cast<double>(used.tv_nsec) * 1e-6;
}

double median(std::vector<double> numbers) {
    if (numbers.empty()) return 0.0;
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::nth_element(numbers.begin(), middle, numbers.end());
    if (numbers.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(numbers.begin(), middle)) / 2.0;
}

void race(std::span<Runner> runners, const Pace& pace) {
    std::vector<std::size_t> planned;
    for (const Runner& runner : runners) planned.push_back(planned_runs(runner.work, pace));
    const std::size_t rounds = planned.empty() ? 0 : *std::ranges::min_element(planned);
    for (std::size_t round = 1; round <= rounds; ++round) {
        for (std::size_t i = 0; i < runners.size(); ++i) {
            Runner& runner = runners[i];
            while (runner.runs_ms.size() < planned[i] * round / rounds) run_once(runner);
        }
    }
}

}  // namespace xorvox::tools
