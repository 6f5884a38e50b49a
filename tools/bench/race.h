// Race: works that are timed in turns, so that a machine whose speed changes is as fast for one as for another.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace xorvox::tools {

/// The middle one of `numbers`, or the mean of the two middle ones; 0 when there are none.
double median(std::vector<double> numbers);

/// What all threads of this program have taken of the processors so far.
double processor_ms();

/// A work that is timed again and again, and how long it took each time.
struct Runner {
    explicit Runner(std::function<void()> the_work) : work(std::move(the_work)) {}
    double median_ms() const { return median(runs_ms); }
    double median_cpu_ms() const { return median(cpu_ms); }

    std::function<void()> work;
    std::vector<double> runs_ms;  ///< By the clock on the wall.
    /// Of the processors, all threads together. Less than the other, for one thread, where other programs have taken
    /// turns. It includes about a microsecond of its own.
    std::vector<double> cpu_ms;
};

/// How often a runner runs: as often as fits into `budget_ms`, but at least and at most so many times.
struct Pace {
    std::size_t least_runs = 5;
    std::size_t most_runs = 2000;
    double budget_ms = 500.0;
};

/// Runs each runner as a warm-up, then all of them in rounds, in their order: as many rounds as the slowest has runs,
/// and in each round an equal share of everyone's runs. What a work throws is passed on. One thread: the works may use
/// more.
void race(std::span<Runner> runners, const Pace& pace);

}  // namespace xorvox::tools
