// StartupLines: the lines of $N0 and $N1, which run after a reset and after homing of all axes.
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware/machine/stored_state.hpp"

namespace cusp::machine {

// Context: main loop.
class StartupLines {
public:
    // `stored` must outlive this.
    explicit StartupLines(StoredState& stored) noexcept : stored_{stored} {}

    // All of them run: after a reset.
    void run() noexcept { next_ = 0; }
    // The answer to `$H` waits until they have run; `all`: they do run.
    void run_before_answer(bool all) noexcept
    {
        answer_waits_ = true;
        next_ = all ? 0 : kStartupLineCount;
    }
    // None of them runs any more.
    void forget() noexcept
    {
        next_ = kStartupLineCount;
        answer_waits_ = false;
    }
    // True if none is left, and no answer either.
    bool over() const noexcept { return all_run() && !answer_waits_; }
    bool all_run() const noexcept { return next_ == kStartupLineCount; }
    bool answer_waits() const noexcept { return answer_waits_; }
    // The answer is given. Precondition: all_run().
    void answered() noexcept { answer_waits_ = false; }
    // The next of them, which may be empty: text(). Precondition: !all_run().
    void advance() noexcept { text_ = stored_.startup[next_++].view(); }

    // A line that is kept if it can be executed, as in Grbl: keep(). Its text must live until then.
    void propose(std::uint32_t number, std::string_view text) noexcept
    {
        number_ = static_cast<std::uint8_t>(number);
        text_ = text;
    }
    void keep() noexcept { stored_.startup[number_].set(text_); }
    // The line that is executed.
    std::string_view text() const noexcept { return text_; }

private:
    StoredState& stored_;
    std::string_view text_;
    unsigned next_{kStartupLineCount};
    std::uint8_t number_{0};
    bool answer_waits_{false};
};

}  // namespace cusp::machine
