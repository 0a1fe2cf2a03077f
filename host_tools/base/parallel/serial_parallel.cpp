// Everything on the calling thread: for WebAssembly, and builds without oneTBB (CUSP_THREADS=OFF). Results are the same.
#include <deque>
#include <exception>
#include <utility>

#include "host_tools/base/parallel/parallel.hpp"

namespace cusp::parallel {

void set_threads(int /*threads*/) {}

void for_each(std::size_t count, const std::function<void(std::size_t)>& body)
{
    std::exception_ptr first;
    for (std::size_t k = 0; k < count; ++k) {
        try {
            body(k);
        } catch (...) {
            first = first ? first : std::current_exception();
        }
    }
    if (first) {
        std::rethrow_exception(first);
    }
}

void both(const std::function<void()>& first, const std::function<void()>& second)
{
    for_each(2, [&](std::size_t k) { (k == 0 ? first : second)(); });
}

// The last added is done first: tasks that add more are then few at a time.
class Tasks::Implementation {
public:
    void finish()
    {
        while (!tasks.empty()) {
            const std::function<void()> task = std::move(tasks.back());
            tasks.pop_back();
            task();
        }
    }
    std::deque<std::function<void()>> tasks;
};

Tasks::Tasks() : implementation_{std::make_unique<Implementation>()} {}

Tasks::~Tasks() { implementation_->finish(); }

void Tasks::add(std::function<void()> task) { implementation_->tasks.push_back(std::move(task)); }

void Tasks::finish() { implementation_->finish(); }

class TaskQueue::Implementation {
public:
    std::exception_ptr fault;
};

TaskQueue::TaskQueue(std::size_t /*most*/) : implementation_{std::make_unique<Implementation>()} {}

TaskQueue::~TaskQueue() = default;

void TaskQueue::add(std::function<void()> task)
{
    if (implementation_->fault) {
        return;
    }
    try {
        task();
    } catch (...) {
        implementation_->fault = std::current_exception();
    }
}

void TaskQueue::finish()
{
    if (implementation_->fault) {
        std::rethrow_exception(std::exchange(implementation_->fault, nullptr));
    }
}

}  // namespace cusp::parallel
