// Loops: every number once, the exception of the lowest number, loops in loops. Tasks: every one once, those
// that tasks add too. Queues: tasks in order.
#include "host_tools/base/parallel/parallel.hpp"

#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;

TEST_GROUP(Parallel){void setup() override{parallel::set_threads(4);
}
}
;

TEST(Parallel, CallsEachNumberOnce)
{
    std::vector<int> calls(10000);
    parallel::for_each(calls.size(), [&](std::size_t k) { ++calls[k]; });
    CHECK(calls == std::vector<int>(calls.size(), 1));
    parallel::for_each(0, [](std::size_t) { FAIL("there is no number"); });
}

TEST(Parallel, ThrowsTheExceptionOfTheLowestNumberAfterAllAreDone)
{
    for (const int threads : {1, 2, 4}) {
        parallel::set_threads(threads);
        std::vector<int> calls(500);
        std::string first;
        try {
            parallel::for_each(calls.size(), [&](std::size_t k) {
                ++calls[k];
                if (k % 100 == 37) {
                    throw std::runtime_error(std::to_string(k));
                }
            });
        } catch (const std::runtime_error& error) {
            first = error.what();
        }
        STRCMP_EQUAL("37", first.c_str());
        LONGS_EQUAL(500, std::accumulate(calls.begin(), calls.end(), 0));
    }
}

TEST(Parallel, RunsLoopsInLoops)
{
    std::vector<std::vector<int>> calls(20, std::vector<int>(50));
    parallel::for_each(calls.size(), [&](std::size_t i) {
        parallel::for_each(calls[i].size(), [&](std::size_t k) { ++calls[i][k]; });
    });
    CHECK(calls == std::vector<std::vector<int>>(20, std::vector<int>(50, 1)));
}

TEST(Parallel, RunsTwoTasks)
{
    int first = 0;
    int second = 0;
    parallel::both([&] { first = 1; }, [&] { second = 2; });
    LONGS_EQUAL(1, first);
    LONGS_EQUAL(2, second);
}

TEST(Parallel, RunsTasksThatAddTasks)
{
    for (const int threads : {1, 2, 4}) {
        parallel::set_threads(threads);
        constexpr std::size_t kTasks = 1023;  // the task k adds 2 k + 1 and 2 k + 2
        std::vector<int> calls(kTasks);
        parallel::Tasks tasks;
        std::function<void(std::size_t)> add;
        add = [&](std::size_t k) {
            tasks.add([&, k] {
                ++calls[k];
                if (2 * k + 2 < kTasks) {
                    add(2 * k + 1);
                    add(2 * k + 2);
                }
            });
        };
        add(0);
        tasks.finish();
        CHECK(calls == std::vector<int>(kTasks, 1));
        add(kTasks - 1);  // may go on
        tasks.finish();
        LONGS_EQUAL(2, calls.back());
    }
}

TEST(Parallel, QueueRunsTasksInOrderBesideTheCaller)
{
    for (const int threads : {1, 2, 4}) {
        parallel::set_threads(threads);
        std::vector<int> order;
        parallel::TaskQueue queue{3};
        for (int task = 0; task < 1000; ++task) {
            queue.add([&order, task] { order.push_back(task); });
        }
        queue.finish();
        std::vector<int> expected(1000);
        std::iota(expected.begin(), expected.end(), 0);
        CHECK(order == expected);
        queue.add([&order] { order.clear(); });
        queue.finish();
        CHECK(order.empty());
    }
}

TEST(Parallel, QueueThrowsTheFirstExceptionAndLeavesOutTheRest)
{
    for (const int threads : {1, 2, 4}) {
        parallel::set_threads(threads);
        std::vector<int> done;
        std::string said;
        parallel::TaskQueue queue{100};
        for (int task = 0; task < 50; ++task) {
            queue.add([&done, task] {
                if (task >= 7) {
                    throw std::runtime_error(std::to_string(task));
                }
                done.push_back(task);
            });
        }
        try {
            queue.finish();
        } catch (const std::runtime_error& error) {
            said = error.what();
        }
        STRCMP_EQUAL("7", said.c_str());
        LONGS_EQUAL(7, static_cast<long>(done.size()));
        queue.finish();
    }
}

TEST(Parallel, QueueWaitsForItsTasksAtItsEnd)
{
    int done = 0;
    {
        parallel::TaskQueue queue{1};
        for (int task = 0; task < 10; ++task) {
            queue.add([&done] { ++done; });
        }
    }
    LONGS_EQUAL(10, done);
}
