#pragma once

#include <atomic>
#include <exception>
#include <utility>

namespace lbm {

/// Keeps the first exception of a team of threads until they are together again: one that leaves a parallel region ends the program.
class FirstException {
public:
    /// Does nothing any more once an action has thrown: what it left half done is not touched again.
    template <class Action>
    void keep(Action&& action) noexcept
    {
        if (thrown_) return;
        try {
            std::forward<Action>(action)();
        } catch (...) {
            if (!thrown_.exchange(true)) first_ = std::current_exception();
        }
    }

    /// Once all threads of the team have called this: whether none of their actions threw.
    template <class Action>
    bool all_succeed(Action&& action) noexcept
    {
        keep(std::forward<Action>(action));
#pragma omp barrier
        return !thrown_;
    }

    /// After the parallel region.
    void rethrow() const
    {
        if (first_) std::rethrow_exception(first_);
    }

private:
    std::atomic<bool> thrown_{false};
    std::exception_ptr first_;
};

}  // namespace lbm
