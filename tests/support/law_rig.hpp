// LawRig: programs by the time law, offline: today's planner cuts them into blocks, the law plans
// the stretches from stop to stop, and the axis filters make set points of them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "firmware/interpolator/box_filter.hpp"
#include "firmware/interpolator/law_player.hpp"
#include "firmware/planner/law_check.hpp"
#include "firmware/planner/law_corner.hpp"
#include "firmware/planner/law_path.hpp"
#include "firmware/planner/law_plans.hpp"
#include "firmware/planner/planner.hpp"
#include "firmware/planner/station_spacing.hpp"
#include "firmware/planner/time_law.hpp"

namespace cusp::test {

// A stretch of path from stop to stop.
struct LawStretch {
    std::deque<planner::Block> blocks;
    std::vector<float> feeds;  // squared
    std::vector<float> centripetals;
    std::vector<float> tolerances;        // mm, that pieces have left at corners
    std::vector<planner::LawCell> cells;  // with both elements
    planner::LawOverlap overlap{};        // at its end
};

class LawRig {
public:
    explicit LawRig(const MachineLimits& limits)
        : limits_{limits},
          queue_{std::make_unique<planner::PathQueue>()},
          planner_{std::make_unique<planner::Planner>(*queue_, limits)}
    {
    }

    // As run(), but after each so many windows no further station comes in time: the plan is played
    // to its end, and so to rest, and the path goes on from there.
    std::vector<Position> run_starved(const std::vector<path::Move>& moves,
                                      std::uint32_t windows_known)
    {
        windows_known_ = windows_known;
        return run(moves);
    }

    // Set points of the whole program, one a tick.
    std::vector<Position> run(const std::vector<path::Move>& moves)
    {
        cut(moves);
        overlap_corners();
        planner::StopChoice start = planner::full_stop(shared());
        for (LawStretch& stretch : stretches_) {
            plan(stretch, start);
            start = stretch.overlap.stop;
        }
        return play(moves.empty() ? Position{} : moves.front().start);
    }

    float station_steps{0};  // Newton steps, each as many times as it had stations
    std::uint32_t stations{0};
    std::uint32_t windows{0};
    std::uint32_t retreats{0};  // plans that the check refused
    std::uint32_t rests{0};     // plans that ended before their stretch
    std::uint32_t blocked{0};   // stretches that could not be planned to their end
    float greatest_use{0};      // by the check, of the plans accepted

private:
    void cut(const std::vector<path::Move>& moves)
    {
        std::map<std::uint32_t, path::Move> by_line;
        for (const path::Move& move : moves) {
            by_line[move.line] = move;
        }
        planner_->reset(moves.empty() ? Position{} : moves.front().start);
        stretches_.emplace_back();
        std::size_t next = 0;
        int idle = 0;
        while (queue_->block_begin() != queue_->block_end() || idle < kIdleRounds) {
            const std::uint32_t before = queue_->block_end();
            planner_->work();
            if (next < moves.size() && planner_->has_room()) {
                planner_->push(moves[next]);
                ++next;
            } else if (next == moves.size()) {
                planner_->close();
                planner_->work();
            }
            idle = next < moves.size() || queue_->block_end() != before ? 0 : idle + 1;
            // The last block may still become one that stops.
            const std::uint32_t kept = idle >= kIdleRounds ? 0U : 14U;
            while (queue_->block_end() - queue_->block_begin() > kept) {
                take_block(by_line);
            }
            while (queue_->interval_begin() != queue_->published()) {
                queue_->drop_interval();
            }
        }
        if (stretches_.back().blocks.empty()) {
            stretches_.pop_back();
        }
    }

    void take_block(const std::map<std::uint32_t, path::Move>& by_line)
    {
        planner::Block block = queue_->block(queue_->block_begin());
        if (block.shape == planner::BlockShape::kCurve) {
            curves_.push_back(*block.curve);
            block.curve = &curves_.back();
        }
        queue_->drop_block();
        const auto found = by_line.find(block.line);
        const bool is_rapid = block.kind == path::MoveKind::kRapid || found == by_line.end();
        const float feed = is_rapid ? kGreatestSpeed : std::min(found->second.feed, kGreatestSpeed);
        const float tolerance = found == by_line.end() ? 0.0F : found->second.tolerance;
        const float first = static_cast<float>(block.filter.first);
        const float second = static_cast<float>(block.filter.second);
        const float square = (first * first + second * second - 2.0F) * 1e-6F / 24.0F;
        const bool is_piece = block.shape == planner::BlockShape::kQuintic;
        LawStretch& stretch = stretches_.back();
        stretch.tolerances.push_back((kCornerShare - (is_piece ? kPieceShare : 0.0F)) * tolerance);
        stretch.blocks.push_back(block);
        stretch.feeds.push_back(feed * feed);
        stretch.centripetals.push_back(std::max(kExactDeviation, kFilterShare * tolerance) /
                                       std::max(square, 1e-12F));
        if (block.stops) {
            stretches_.emplace_back();
        }
    }

    // What plans a stretch.
    struct Planning {
        explicit Planning(const MachineLimits& limits)
        {
            law.set_limits(limits);
            spacing.set_limits(limits, law.station_time());
        }

        planner::LawPath path;
        planner::TimeLaw law;
        planner::StationSpacing spacing{path};
        planner::LawPlans plans;
        planner::PathCursor checked{};
        std::size_t next{0};       // block
        std::uint32_t windows{0};  // since then
        bool started{false};
        bool ended{false};
        bool rests{false};  // the tick has played the last plan to its end
    };

    // Less what rounding takes.
    MachineLimits shared() const
    {
        MachineLimits shared = limits_;
        shared.acceleration = shared.acceleration * kShare;
        shared.jerk = shared.jerk * kShare;
        return shared;
    }

    void overlap_corners()
    {
        const auto side = [](const LawStretch& stretch, const planner::Block& block, float at) {
            double length = 0;
            for (const planner::Block& each : stretch.blocks) {
                length +=
                    static_cast<double>(each.length) / static_cast<double>(kPathUnitsPerMillimetre);
            }
            return planner::LawSide{planner::derivatives_at(block, at), static_cast<float>(length),
                                    static_cast<float>(block.length) / kPathUnitsPerMillimetre};
        };
        for (std::size_t i = 0; i < stretches_.size(); ++i) {
            LawStretch& stretch = stretches_[i];
            const planner::Block& last = stretch.blocks.back();
            const float end = static_cast<float>(last.length) / kPathUnitsPerMillimetre;
            const planner::LawSide before = side(stretch, last, end);
            const bool goes_on =
                i + 1 < stretches_.size() && stretches_[i + 1].blocks.front().filter == last.filter;
            const LawStretch& next = stretches_[goes_on ? i + 1 : i];
            const float deviation =
                goes_on ? std::min(stretch.tolerances.back(), next.tolerances.front()) : 0.0F;
            stretch.overlap = planner::law_overlap(before, side(next, next.blocks.front(), 0),
                                                   shared(), last.filter, deviation);
        }
    }

    void plan(LawStretch& stretch, const planner::StopChoice& start)
    {
        const auto planning = std::make_unique<Planning>(shared());
        Planning& now = *planning;
        now.spacing.begin(start, {}, 0);
        now.spacing.set_stop(stretch.overlap.stop);
        while (now.law.state() != planner::TimeLaw::State::kDone || !now.started) {
            give(now, stretch);
            const std::uint32_t before = now.law.steps();
            now.law.work();
            station_steps += now.law.steps() == before
                                 ? 0.0F
                                 : static_cast<float>(now.law.end_cell() - now.law.first_cell());
            if (accepts(now) && !now.law.rests()) {
                play(now, stretch);
                if (now.windows >= windows_known_ && !now.law.plans_the_end()) {
                    play(now, stretch);
                    now.rests = true;
                }
            }
            if (now.law.rests()) {
                go_on_from_rest(now, stretch);
            }
            if (now.law.state() == planner::TimeLaw::State::kBlocked) {
                ++blocked;
                break;
            }
        }
    }

    // The tick plays up to its next choice.
    static void play(Planning& now, LawStretch& stretch)
    {
        planner::LawCell cell;
        do {
            const bool plays = now.plans.next(cell);
            CUSP_ASSERT(plays);
            stretch.cells.push_back(cell);
        } while (!now.plans.chooses());
    }

    // Blocks and stations, as many as there is room for.
    void give(Planning& now, LawStretch& stretch)
    {
        while (now.next < stretch.blocks.size() && !now.path.full()) {
            now.path.append({&stretch.blocks[now.next], stretch.feeds[now.next],
                             stretch.centripetals[now.next]});
            ++now.next;
            if (now.next == stretch.blocks.size()) {
                now.path.close();
            }
        }
        planner::StopElement element;
        if (!now.started && now.spacing.start(element)) {
            now.law.begin(element);
            now.started = true;
        }
        planner::Station station;
        while (now.started && !now.ended && now.law.has_room() && now.spacing.next(station)) {
            now.law.add(station);
            ++stations;
            if (now.spacing.finished()) {
                now.law.end(now.spacing.stop());
                now.ended = true;
            }
        }
    }

    // Checks the window that is planned, if one is. True: it is accepted.
    bool accepts(Planning& now)
    {
        planner::TimeLaw& law = now.law;
        if (law.state() == planner::TimeLaw::State::kChecks) {
            const std::int64_t begin = law.station(law.first_cell()).begin;
            const float use = planner::greatest_use(law, now.path, now.checked, shared());
            now.path.seek(now.checked, begin);
            if (use > kMostUse) {
                ++retreats;
                law.retreat();
            } else {
                greatest_use = std::max(greatest_use, use);
            }
        }
        if (law.state() != planner::TimeLaw::State::kChecks &&
            law.state() != planner::TimeLaw::State::kStays) {
            return false;
        }
        ++windows;
        ++now.windows;
        law.accept(now.plans);
        now.path.drop_before(now.checked);
        return true;
    }

    void go_on_from_rest(Planning& now, LawStretch& stretch)
    {
        if (!now.rests) {
            play(now, stretch);
        }
        ++rests;
        now.rests = false;
        now.windows = 0;
        const std::int64_t rest = now.law.place_of_rest();
        planner::PathCursor cursor = now.checked;
        now.path.seek(cursor, rest);
        now.spacing.begin(planner::full_stop(shared()), cursor, rest);
        now.started = false;
        now.ended = false;
    }

    // A stretch on its way.
    struct Track {
        const LawStretch* stretch{nullptr};
        interpolator::LawPlayer player;
        std::size_t next{0};
        std::size_t block{0};
        std::uint32_t offset{0};
        PathOffset place{};

        // Goes on for `left` seconds and lowers it by the time that this takes. Returns the way gone.
        PathOffset go(float& left)
        {
            PathOffset gone{};
            while (stretch != nullptr && left > 0) {
                if (player.needs_cell()) {
                    if (next == stretch->cells.size()) {
                        stretch = nullptr;
                        break;
                    }
                    player.play(stretch->cells[next]);
                    ++next;
                    continue;
                }
                gone = gone + travel(player.advance(left));
            }
            return gone;
        }

        // How long before the end of this tick the stretch after it begins, s.
        float head_of_next(float start_time) const
        {
            if (stretch == nullptr) {
                return kServoTick;
            }
            Track after = *this;
            float left = kServoTick;
            (void)after.go(left);
            const bool ends = after.stretch == nullptr || after.next == stretch->cells.size();
            if (!ends) {
                return 0;
            }
            const planner::LawCell& stop = stretch->cells.back();
            float overlap = std::min(stretch->overlap.time, element_time(stop));
            overlap = stretch->overlap.disjoint ? overlap : std::min(overlap, start_time);
            const float rest = after.stretch == nullptr ? -left : after.player.time_to_rest();
            return std::min(overlap - rest, kServoTick);
        }

        static float element_time(const planner::LawCell& cell)
        {
            return 3.0F * static_cast<float>(cell.travel) / kPathUnitsPerMillimetre /
                   std::sqrt(cell.start.value);
        }

        PathOffset travel(std::uint32_t units)
        {
            PathOffset gone{};
            offset += units;
            while (block < stretch->blocks.size() && offset >= stretch->blocks[block].length) {
                offset -= stretch->blocks[block].length;
                gone = gone + (stretch->blocks[block].displacement - place);
                place = {};
                ++block;
            }
            if (block < stretch->blocks.size()) {
                const PathOffset now = planner::position_at(stretch->blocks[block], offset);
                gone = gone + (now - place);
                place = now;
            }
            return gone;
        }
    };

    std::vector<Position> play(Position at)
    {
        std::vector<Position> samples;
        std::size_t idle = 0;
        std::size_t next = 0;
        std::array<Track, 2> tracks;  // they overlap at corners
        std::size_t lead = 0;
        planner::AxisFilter filter{0, 0};  // none yet
        interpolator::RunningSum<PathOffset, 32> first;
        interpolator::RunningSum<PathOffset, 32> second;
        std::array<interpolator::ExactDivision, 3> division;
        while (idle < 3) {
            float head = 0;
            if (next < stretches_.size() && tracks[1 - lead].stretch == nullptr) {
                const planner::AxisFilter wanted = stretches_[next].blocks.front().filter;
                const bool drained =
                    tracks[lead].stretch == nullptr && first.drained() && second.drained();
                if (wanted != filter && drained) {
                    filter = wanted;
                    first.set_length(filter.first);
                    second.set_length(filter.second);
                    const std::int32_t whole =
                        kPathUnitsPerNanometre * filter.first * filter.second;
                    for (interpolator::ExactDivision& axis : division) {
                        axis.set(whole, whole / 2);
                    }
                }
                const float start_time = Track::element_time(stretches_[next].cells.front());
                head = wanted == filter ? tracks[lead].head_of_next(start_time) : 0.0F;
            }
            PathOffset gone{};
            for (Track& track : tracks) {
                float left = kServoTick;
                gone = gone + track.go(left);
            }
            if (head > 0) {
                lead = 1 - lead;
                tracks[lead] = Track{&stretches_[next], {}, 0, 0, 0, {}};
                gone = gone + tracks[lead].go(head);
                ++next;
            }
            const PathOffset moved = second.add(first.add(gone));
            at = at + Position{division[0].divide(moved.x), division[1].divide(moved.y),
                               division[2].divide(moved.z)};
            samples.push_back(at);
            const bool still = tracks[0].stretch == nullptr && tracks[1].stretch == nullptr &&
                               next == stretches_.size() && first.drained() && second.drained();
            idle = still ? idle + 1 : 0;
        }
        return samples;
    }

    static constexpr int kIdleRounds = 50;
    static constexpr float kGreatestSpeed = 2000.0F;
    static constexpr float kExactDeviation = 0.0009F;
    static constexpr float kFilterShare = 0.45F;
    static constexpr float kCornerShare = 0.985F;  // of the tolerance
    static constexpr float kPieceShare = 0.45F;
    static constexpr float kShare = 0.999F;
    static constexpr float kMostUse = 1.0005F;  // of the limits shared

    std::uint32_t windows_known_{0xFFFFFFFFU};
    MachineLimits limits_;
    std::unique_ptr<planner::PathQueue> queue_;
    std::unique_ptr<planner::Planner> planner_;
    std::deque<planner::CurveBlock> curves_;
    std::vector<LawStretch> stretches_;
};

}  // namespace cusp::test
