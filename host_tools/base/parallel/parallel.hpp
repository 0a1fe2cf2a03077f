// Loops on all cores, whose results do not depend on the number of threads.
//
//     parallel::set_threads(4);                        // default: one a core
//     std::vector<double> heights(cells.size());
//     parallel::for_each(cells.size(), [&](std::size_t k) { heights[k] = height_of(cells[k]); });
//     const double highest = *std::max_element(heights.begin(), heights.end());  // in order
//
// A body writes to its own place only. Sums and choices are made afterwards, in the order of the
// numbers, so results are the same to the last bit for any number of threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace cusp::parallel {

// threads  >= 1: how many run at once from now on, this one included. For one thread at a time.
void set_threads(int threads);

// Calls body(k) once for each k from 0 to count - 1, several at once in any order, and returns when
// all are done. If bodies throw, all others are called, then the exception of the lowest k is
// thrown. Bodies may call for_each() themselves. The cancellation::Part of the caller is theirs too.
void for_each(std::size_t count, const std::function<void(std::size_t)>& body);

// Calls first() and second() at once, as for_each() does.
void both(const std::function<void()>& first, const std::function<void()>& second);

// Tasks that run at once, in any order, and may add more. The cancellation::Part of the thread that
// made this is theirs too.
class Tasks {
public:
    Tasks();
    // Waits for all.
    ~Tasks();
    Tasks(const Tasks&) = delete;
    Tasks& operator=(const Tasks&) = delete;

    // task  throws nothing
    void add(std::function<void()> task);

    // Returns when all tasks are done, those added meanwhile too.
    void finish();

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

// Tasks that run one after the other, in the order of add(), while the caller continues: the later
// stage of work that comes in pieces. With one thread they run in add() and finish().
class TaskQueue {
public:
    // most  >= 1: tasks that may wait
    explicit TaskQueue(std::size_t most);
    // Waits for all tasks; an exception that finish() has not thrown is lost.
    ~TaskQueue();
    TaskQueue(const TaskQueue&) = delete;
    TaskQueue& operator=(const TaskQueue&) = delete;

    // Returns at once unless `most` tasks wait already.
    void add(std::function<void()> task);

    // Returns when all tasks are done. Throws the exception of the first that threw; those after it
    // were left out.
    void finish();

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace cusp::parallel
