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
#include "firmware/planner/law_path.hpp"
#include "firmware/planner/planner.hpp"
#include "firmware/planner/station_spacing.hpp"
#include "firmware/planner/time_law.hpp"

namespace cusp::test {

// A stretch of path from stop to stop.
struct LawStretch {
    std::deque<planner::Block> blocks;
    std::vector<float> feeds;  // squared
    std::vector<float> centripetals;
    std::vector<planner::LawCell> cells;  // with both elements
};

class LawRig {
public:
    explicit LawRig(const MachineLimits& limits)
        : limits_{limits},
          queue_{std::make_unique<planner::PathQueue>()},
          planner_{std::make_unique<planner::Planner>(*queue_, limits)}
    {
    }

    // As run(), but after so many windows in all no further station comes: the plan is played to
    // its end, and so to rest.
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
        std::size_t planned = 0;
        while (planned < stretches_.size() && windows < windows_known_) {
            plan(stretches_[planned]);
            ++planned;
        }
        stretches_.resize(planned);
        return play(moves.empty() ? Position{} : moves.front().start);
    }

    float station_steps{0};  // Newton steps, each as many times as it had stations
    std::uint32_t stations{0};
    std::uint32_t windows{0};
    std::uint32_t retreats{0};  // plans that the check refused
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
        LawStretch& stretch = stretches_.back();
        stretch.blocks.push_back(block);
        stretch.feeds.push_back(feed * feed);
        stretch.centripetals.push_back(std::max(kExactDeviation, kFilterShare * tolerance) /
                                       std::max(square, 1e-12F));
        if (block.stops) {
            stretches_.emplace_back();
        }
    }

    void plan(LawStretch& stretch)
    {
        const auto path = std::make_unique<planner::LawPath>();
        const auto law = std::make_unique<planner::TimeLaw>();
        const auto spacing = std::make_unique<planner::StationSpacing>(*path);
        MachineLimits shared = limits_;
        shared.acceleration = shared.acceleration * kShare;
        shared.jerk = shared.jerk * kShare;
        law->set_limits(shared);
        spacing->set_limits(shared, law->station_time());
        float longest = 0;
        for (unsigned i = 0; i < 3; ++i) {
            longest = std::max(longest, limits_.acceleration[i] / limits_.jerk[i]);
        }
        const planner::StopChoice stop{0.8F * longest, 1.0F};
        spacing->begin(stop);
        spacing->set_stop(stop);
        std::size_t next = 0;
        planner::PathCursor checked{};
        bool started = false;
        bool ended = false;
        for (;;) {
            while (next < stretch.blocks.size() && !path->full()) {
                path->append(
                    {&stretch.blocks[next], stretch.feeds[next], stretch.centripetals[next]});
                ++next;
                if (next == stretch.blocks.size()) {
                    path->close();
                }
            }
            planner::StopElement element;
            if (!started && spacing->start(element)) {
                law->begin(element);
                const float length = element.length * kPathUnitsPerMillimetre;
                stretch.cells.push_back(
                    {{}, static_cast<std::uint32_t>(length + 0.5F), planner::LawPiece::kStart});
                started = true;
            }
            planner::Station station;
            while (started && !ended && law->has_room() && spacing->next(station)) {
                law->add(station);
                ++stations;
                if (spacing->finished()) {
                    law->end(spacing->stop());
                    ended = true;
                }
            }
            const std::uint32_t before = law->steps();
            law->work();
            station_steps += law->steps() == before
                                 ? 0.0F
                                 : static_cast<float>(law->end_cell() - law->first_cell());
            if (law->state() == planner::TimeLaw::State::kChecks) {
                check(*law, *path, checked, shared);
            }
            planner::LawCell cell;
            while (law->take(cell)) {
                stretch.cells.push_back(cell);
            }
            path->drop_before(checked);
            if (windows >= windows_known_ && !law->plans_the_end()) {
                starve(*law, stretch);
                return;
            }
            if (law->state() == planner::TimeLaw::State::kBlocked) {
                ++blocked;
                break;
            }
            if (started && law->state() == planner::TimeLaw::State::kDone) {
                break;
            }
        }
        finish(stretch, spacing->stop());
    }

    void check(planner::TimeLaw& law,
               const planner::LawPath& path,
               planner::PathCursor& cursor,
               const MachineLimits& limits)
    {
        ++windows;
        while (law.state() == planner::TimeLaw::State::kChecks) {
            const std::int64_t begin = law.station(law.first_cell()).begin;
            const float use = planner::greatest_use(law, path, cursor, limits);
            path.seek(cursor, begin);
            if (use <= kMostUse) {
                greatest_use = std::max(greatest_use, use);
                law.accept();
            } else {
                ++retreats;
                law.retreat();
            }
        }
    }

    // Appends the plan beyond its final cells, and the stop from its crawl.
    static void starve(const planner::TimeLaw& law, LawStretch& stretch)
    {
        for (std::uint32_t k = law.taken(); k < law.planned_cells(); ++k) {
            stretch.cells.push_back(law.cell(k));
        }
        for (const planner::LawCell& cell : law.stop_from_crawl()) {
            stretch.cells.push_back(cell);
        }
        stretch.cells.front().start.value = stretch.cells[1].start.value;
    }

    // The elements' inner ends have the speed of the cells beside them.
    static void finish(LawStretch& stretch, const planner::StopElement& stop)
    {
        std::vector<planner::LawCell>& cells = stretch.cells;
        if (cells.size() < 2) {
            return;
        }
        cells.front().start.value = cells[1].start.value;
        const planner::LawCell& last = cells.back();
        const float length = static_cast<float>(last.travel) / kPathUnitsPerMillimetre;
        const float travel = stop.length * kPathUnitsPerMillimetre;
        cells.push_back({advanced(last.start, length), static_cast<std::uint32_t>(travel + 0.5F),
                         planner::LawPiece::kStop});
    }

    // A stretch on its way.
    struct Track {
        const LawStretch* stretch{nullptr};
        interpolator::LawPlayer player;
        std::size_t next{0};
        std::size_t block{0};
        std::uint32_t offset{0};
        PathOffset place{};

        // Goes on for some time, s. Returns the way gone.
        PathOffset go(float time)
        {
            PathOffset gone{};
            while (stretch != nullptr && time > 0) {
                if (player.needs_cell()) {
                    if (next == stretch->cells.size()) {
                        stretch = nullptr;
                        break;
                    }
                    player.play(stretch->cells[next]);
                    ++next;
                    continue;
                }
                gone = gone + travel(player.advance(time));
            }
            return gone;
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
        Track track;
        planner::AxisFilter filter{0, 0};  // none yet
        interpolator::RunningSum<PathOffset, 32> first;
        interpolator::RunningSum<PathOffset, 32> second;
        std::array<interpolator::ExactDivision, 3> division;
        while (idle < 3) {
            if (track.stretch == nullptr && next < stretches_.size()) {
                const planner::AxisFilter wanted = stretches_[next].blocks.front().filter;
                const bool drained = first.drained() && second.drained();
                if (wanted == filter || drained) {
                    if (wanted != filter) {
                        filter = wanted;
                        first.set_length(filter.first);
                        second.set_length(filter.second);
                        const std::int32_t whole =
                            kPathUnitsPerNanometre * filter.first * filter.second;
                        for (interpolator::ExactDivision& axis : division) {
                            axis.set(whole, whole / 2);
                        }
                    }
                    track = Track{&stretches_[next], {}, 0, 0, 0, {}};
                    ++next;
                }
            }
            const PathOffset moved = second.add(first.add(track.go(kServoTick)));
            at = at + Position{division[0].divide(moved.x), division[1].divide(moved.y),
                               division[2].divide(moved.z)};
            samples.push_back(at);
            const bool rests = track.stretch == nullptr && next == stretches_.size() &&
                               first.drained() && second.drained();
            idle = rests ? idle + 1 : 0;
        }
        return samples;
    }

    static constexpr int kIdleRounds = 50;
    static constexpr float kGreatestSpeed = 2000.0F;
    static constexpr float kExactDeviation = 0.0009F;
    static constexpr float kFilterShare = 0.45F;
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
