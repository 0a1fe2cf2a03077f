// oneTBB shares the work; only this file knows it.
#include "host_tools/base/parallel/parallel.hpp"

#include <atomic>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <utility>

#include "host_tools/base/cancellation/cancellation.hpp"

#include "oneapi/tbb/blocked_range.h"
#include "oneapi/tbb/global_control.h"
#include "oneapi/tbb/parallel_for.h"
#include "oneapi/tbb/task_group.h"

namespace cusp::parallel {
namespace {

std::unique_ptr<tbb::global_control> limit;

// The exception of the lowest number.
class FirstFault {
public:
    void take(std::size_t number, std::exception_ptr fault)
    {
        const std::lock_guard lock{mutex_};
        if (!fault_ || number < number_) {
            number_ = number;
            fault_ = std::move(fault);
        }
    }

    void rethrow() const
    {
        if (fault_) {
            std::rethrow_exception(fault_);
        }
    }

private:
    std::mutex mutex_;
    std::size_t number_{};
    std::exception_ptr fault_;
};

using Body = std::function<void(std::size_t)>;

// The state that the calls of one loop share. oneTBB orders them all; ThreadSanitizer does not see
// inside it, but sees `done`.
struct Loop {
    const Body& body;
    FirstFault fault;
    std::atomic<std::size_t> done;
    cancellation::Part::Text part;  // of the thread that began the loop
};

void call(Loop& loop, std::size_t number)
{
    static_cast<void>(loop.done.load(std::memory_order_acquire));
    try {
        const cancellation::Part part{loop.part};
        loop.body(number);
    } catch (...) {
        loop.fault.take(number, std::current_exception());
    }
    loop.done.fetch_add(1, std::memory_order_acq_rel);
}

using Range = tbb::blocked_range<std::size_t>;

// A value that oneTBB copies from thread to thread: read before ThreadSanitizer sees an order.
struct LoopCall {
    Loop* loop;
    [[gnu::no_sanitize("thread")]] void operator()(const Range& numbers) const
    {
        for (std::size_t k = numbers.begin(); k != numbers.end(); ++k) {
            call(*loop, k);
        }
    }
};

// Others leave a thread that is long at one number with those that it was to call next.
constexpr std::size_t kMostTasks = 1024;

}  // namespace

void set_threads(int threads)
{
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
}

void for_each(std::size_t count, const std::function<void(std::size_t)>& body)
{
    Loop loop{body, {}, {}, cancellation::Part::current()};
    loop.done.store(0, std::memory_order_release);
    tbb::parallel_for(Range{0, count, 1 + count / kMostTasks}, LoopCall{&loop},
                      tbb::simple_partitioner{});
    static_cast<void>(loop.done.load(std::memory_order_acquire));
    loop.fault.rethrow();
}

void both(const std::function<void()>& first, const std::function<void()>& second)
{
    for_each(2, [&](std::size_t k) { (k == 0 ? first : second)(); });
}

class Tasks::Implementation {
public:
    ~Implementation() { finish(); }
    Implementation() = default;
    Implementation(const Implementation&) = delete;
    Implementation& operator=(const Implementation&) = delete;

    void add(std::function<void()> task)
    {
        std::function<void()>* place = nullptr;
        {
            const std::lock_guard lock{mutex_};
            place = &tasks_.emplace_back(std::move(task));
        }
        order_.fetch_add(1, std::memory_order_acq_rel);
        group_.run(Run{this, place});
    }

    void finish()
    {
        group_.wait();
        static_cast<void>(order_.load(std::memory_order_acquire));
    }

private:
    // As LoopCall.
    struct Run {
        Implementation* tasks;
        std::function<void()>* task;
        [[gnu::no_sanitize("thread")]] void operator()() const { tasks->run(*task); }
    };

    void run(std::function<void()>& place)
    {
        static_cast<void>(order_.load(std::memory_order_acquire));
        {
            const std::function<void()> task = std::exchange(place, nullptr);
            const cancellation::Part part{part_};
            task();
        }
        order_.fetch_add(1, std::memory_order_acq_rel);
    }

    std::mutex mutex_;
    std::deque<std::function<void()>> tasks_;  // stay where they are
    cancellation::Part::Text part_{cancellation::Part::current()};
    std::atomic<std::size_t> order_{0};  // as Loop::done
    tbb::task_group group_;
};

Tasks::Tasks() : implementation_{std::make_unique<Implementation>()} {}

Tasks::~Tasks() = default;

void Tasks::add(std::function<void()> task) { implementation_->add(std::move(task)); }

void Tasks::finish() { implementation_->finish(); }

class TaskQueue::Implementation {
public:
    explicit Implementation(std::size_t most) : most_{most} {}
    ~Implementation()
    {
        group_.wait();
        static_cast<void>(order_.load(std::memory_order_acquire));
    }
    Implementation(const Implementation&) = delete;
    Implementation& operator=(const Implementation&) = delete;

    void add(std::function<void()> task)
    {
        bool starts = false;
        bool full = false;
        {
            const std::lock_guard lock{mutex_};
            full = waiting_.size() >= most_;
            waiting_.push_back(std::move(task));
            starts = !std::exchange(running_, true);
        }
        if (starts) {
            order_.fetch_add(1, std::memory_order_acq_rel);
            group_.run(Run{this});
        }
        if (full) {
            group_.wait();
        }
    }

    void finish()
    {
        group_.wait();
        const std::lock_guard lock{mutex_};
        if (fault_) {
            std::rethrow_exception(std::exchange(fault_, nullptr));
        }
    }

private:
    // As LoopCall.
    struct Run {
        Implementation* queue;
        [[gnu::no_sanitize("thread")]] void operator()() const { queue->run(); }
    };

    // Runs tasks until the queue is empty.
    void run()
    {
        static_cast<void>(order_.load(std::memory_order_acquire));
        run_waiting();
        order_.fetch_add(1, std::memory_order_acq_rel);
    }

    void run_waiting()
    {
        while (const std::function<void()> task = next()) {
            try {
                task();
            } catch (...) {
                const std::lock_guard lock{mutex_};
                fault_ = std::current_exception();
            }
        }
    }

    std::function<void()> next()
    {
        const std::lock_guard lock{mutex_};
        if (fault_) {
            waiting_.clear();
        }
        if (waiting_.empty()) {
            running_ = false;
            return nullptr;
        }
        std::function<void()> task = std::move(waiting_.front());
        waiting_.pop_front();
        return task;
    }

    std::size_t most_;
    std::mutex mutex_;
    std::deque<std::function<void()>> waiting_;
    bool running_{false};
    std::exception_ptr fault_;
    std::atomic<std::size_t> order_{0};  // as Loop::done
    tbb::task_group group_;
};

TaskQueue::TaskQueue(std::size_t most) : implementation_{std::make_unique<Implementation>(most)} {}

TaskQueue::~TaskQueue() = default;

void TaskQueue::add(std::function<void()> task) { implementation_->add(std::move(task)); }

void TaskQueue::finish() { implementation_->finish(); }

}  // namespace cusp::parallel
