// StretchPlanner: the blocks of the queue, stretch by stretch, become plans for the servo tick.
#pragma once

#include <cstdint>

#include "firmware/base/machine_limits.hpp"
#include "firmware/planner/law_path.hpp"
#include "firmware/planner/path_queue.hpp"
#include "firmware/planner/station_spacing.hpp"
#include "firmware/planner/time_law.hpp"

namespace cusp::planner {

// Context: main loop.
class StretchPlanner {
public:
    explicit StretchPlanner(PathQueue& queue) noexcept : queue_{queue} {}

    // Less what rounding takes. Precondition: the queue is empty.
    void set_limits(const MachineLimits& limits) noexcept;
    void set_shaper(const InputShaper& shaper) noexcept { spacing_.set_shaper(shaper); }
    void reset() noexcept;

    // Per cent of the programmed feed that is planned for, 100 at least.
    void set_percent(unsigned percent) noexcept;

    // A bounded step: some stations, one of Newton's steps, or the check. False: nothing is to do without news.
    bool work() noexcept;

    // True if the law has every block that the queue got, and waits for more.
    bool has_all() const noexcept
    {
        return next_ == queue_.block_end() &&
               (stage_ != Stage::kRuns || law_.state() == TimeLaw::State::kWaits);
    }

    // True if every block that the queue got is planned.
    bool finished() const noexcept { return stage_ == Stage::kIdle && next_ == queue_.block_end(); }

private:
    enum class Stage : std::uint8_t { kIdle, kBegins, kRuns };

    void begin_stretch() noexcept;
    bool read_blocks() noexcept;
    void close(const Block& last) noexcept;
    bool add_stations() noexcept;
    bool judge() noexcept;
    void begin_with_full_ring() noexcept;
    void go_on_from_rest() noexcept;
    StopChoice choice_at(const Block& block) const noexcept;

    PathQueue& queue_;
    MachineLimits limits_{};
    LawPath path_;
    StationSpacing spacing_{path_};
    TimeLaw law_;
    PathCursor checked_{};
    StopChoice start_{};  // of the next stretch
    StopChoice stop_{};   // at its end
    float overlap_{0};
    bool disjoint_{false};
    std::uint32_t next_{0};  // block of the queue that the law gets next
    unsigned percent_{100};
    Stage stage_{Stage::kIdle};
    bool ended_{false};  // the law has the last station
};

}  // namespace cusp::planner
