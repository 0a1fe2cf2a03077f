// The main loop of an image: polls, feeds the watchdog, sleeps.
#pragma once

#include <cstdint>

namespace cusp::boards {

// Feeds only while servo ticks come: without them no stop acts.
template <void (*kFeed)() noexcept, class Application>
[[noreturn]] void run_fed(Application& application) noexcept
{
    std::uint32_t fed_at = application.machine().motion().ticks() - 1;
    for (;;) {
        const std::uint32_t ticks = application.machine().motion().ticks();
        if (ticks != fed_at) {
            fed_at = ticks;
            kFeed();
        }
        if (!application.poll()) {
            __asm volatile("wfi");
        }
    }
}

}  // namespace cusp::boards
