// A tree of shares: those given by one are its children.
#include "host_tools/cam/finishing/work_in_shares.hpp"

#include <algorithm>
#include <exception>
#include <memory>

#include "host_tools/base/parallel/parallel.hpp"

namespace cusp::finishing {

using Drops = ReachableHeight::Drops;

std::optional<std::size_t> OpenShare::next()
{
    return left() == 0 ? std::nullopt : std::optional{numbers_[done_++]};
}

void OpenShare::give_half(Drops known)
{
    const auto middle = numbers_.end() - static_cast<std::ptrdiff_t>(left() / 2);
    Share half{middle, numbers_.end()};
    numbers_.erase(middle, numbers_.end());
    give_(std::move(half), std::move(known));
}

namespace {

using Work = std::function<Drops(OpenShare&)>;

struct WorkedShare {
    Drops drops;
    std::exception_ptr fault;
    std::vector<std::unique_ptr<WorkedShare>> given;
};

// Adds the share to those that the parent gives.
std::function<void()> given(
    parallel::Tasks& tasks, const Work& work, WorkedShare& parent, Share share, Drops known)
{
    parent.given.push_back(std::make_unique<WorkedShare>());
    WorkedShare& here = *parent.given.back();
    const auto open = std::make_shared<OpenShare>(
        std::move(share), std::move(known), [&](Share half, Drops found) {
            tasks.add(given(tasks, work, here, std::move(half), std::move(found)));
        });
    return [&here, &work, open] {
        try {
            here.drops = work(*open);
        } catch (...) {
            here.fault = std::current_exception();
        }
    };
}

void collect(WorkedShare& share, std::vector<Drops>& out)
{
    if (share.fault) {
        std::rethrow_exception(share.fault);
    }
    out.push_back(std::move(share.drops));
    for (const std::unique_ptr<WorkedShare>& part : share.given) {
        collect(*part, out);
    }
}

}  // namespace

std::vector<Drops> work_in_shares(const std::vector<Share>& shares, const Work& work)
{
    WorkedShare all;
    parallel::Tasks tasks;
    std::vector<std::function<void()>> first;
    for (const Share& share : shares) {
        first.push_back(given(tasks, work, all, share, {}));
    }
    // A thread begins with what it has added last.
    std::for_each(first.rbegin(), first.rend(), [&](auto& task) { tasks.add(std::move(task)); });
    tasks.finish();
    std::vector<Drops> out;
    for (const std::unique_ptr<WorkedShare>& share : all.given) {
        collect(*share, out);
    }
    return out;
}

}  // namespace cusp::finishing
