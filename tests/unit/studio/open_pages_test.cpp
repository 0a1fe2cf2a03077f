// When the last page is known to have closed.
#include "host_tools/cli/studio/open_pages.hpp"

#include <chrono>
#include <future>

#include "CppUTest/TestHarness.h"

using cusp::studio::OpenPages;
using Seconds = std::chrono::duration<double>;

namespace {

// long beside what a loaded machine makes a thread wait
constexpr Seconds kLinger{0.4};
constexpr Seconds kLonger{0.9};

bool ended(const std::future<void>& wait, Seconds within)
{
    return wait.wait_for(within) == std::future_status::ready;
}

}  // namespace

TEST_GROUP(OpenPages)
{
    OpenPages pages;
    std::future<void> wait{
        std::async(std::launch::async, [this] { pages.wait_for_the_last(kLinger); })};

    void teardown() override
    {
        pages.end();
        wait.wait();
    }
};

TEST(OpenPages, APageThatNeverCameIsWaitedFor) { CHECK_FALSE(ended(wait, kLonger)); }

TEST(OpenPages, ItEndsAWhileAfterTheLastHasClosed)
{
    pages.opened();
    pages.opened();
    pages.closed();
    CHECK_FALSE(ended(wait, kLonger));
    pages.closed();
    CHECK(ended(wait, Seconds{20}));
}

TEST(OpenPages, APageThatIsLoadedAgainKeepsIt)
{
    pages.opened();
    for (int k = 0; k < 4; ++k) {
        pages.closed();
        pages.opened();
        CHECK_FALSE(ended(wait, kLinger * 2));
    }
}

TEST(OpenPages, TheEndOfTheServerEndsTheWait)
{
    pages.opened();
    pages.end();
    CHECK(ended(wait, Seconds{20}));
}
