// A grid of squares finds neighbouring ends.
#include "host_tools/job/import/path_chains.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace cusp::import {

using nurbs::Curve;

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// Ends of piece k are numbers 2 k, its first one, and 2 k + 1.
struct End {
    Vec2d at;
    Vec2d outward;  // direction of leaving the piece, of length 1; 0 where it has none
};

Vec2d direction_from(const std::vector<Vec3d>& points, bool last)
{
    constexpr double kLeast = 1e-12;
    const Vec2d end = in_plan(last ? points.back() : points.front());
    for (std::size_t k = 1; k < points.size(); ++k) {
        const Vec2d way = end - in_plan(points[last ? points.size() - 1 - k : k]);
        if (norm(way) > kLeast) {
            return 1 / norm(way) * way;
        }
    }
    return {};
}

double length_of_polygons(const CurveChain& chain)
{
    double length = 0;
    for (const Curve& curve : chain) {
        for (std::size_t k = 1; k < curve.points.size(); ++k) {
            length += norm(in_plan(curve.points[k]) - in_plan(curve.points[k - 1]));
        }
    }
    return length;
}

void append(const CurveChain& piece, bool turned, CurveChain& chain)
{
    if (!turned) {
        chain.insert(chain.end(), piece.begin(), piece.end());
        return;
    }
    for (auto curve = piece.rbegin(); curve != piece.rend(); ++curve) {
        chain.push_back(reversed(*curve));
    }
}

// Spatial hash of ends.
class EndGrid {
public:
    explicit EndGrid(double side) : side_{side} {}
    void add(std::size_t number, Vec2d at) { squares_[key(at, 0, 0)].push_back(number); }

    // Calls visit(number) for all ends in the 3 x 3 squares around a point.
    template <class Visit>
    void near(Vec2d at, const Visit& visit) const
    {
        for (int i = -1; i <= 1; ++i) {
            for (int j = -1; j <= 1; ++j) {
                if (const auto found = squares_.find(key(at, i, j)); found != squares_.end()) {
                    std::for_each(found->second.begin(), found->second.end(), visit);
                }
            }
        }
    }

private:
    std::uint64_t key(Vec2d at, int i, int j) const
    {
        const auto column = static_cast<std::int64_t>(std::floor(at.x / side_)) + i;
        const auto row = static_cast<std::int64_t>(std::floor(at.y / side_)) + j;
        return static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15U ^
               static_cast<std::uint64_t>(row);
    }

    double side_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> squares_;
};

class Joining {
public:
    Joining(const std::vector<CurveChain>& pieces, double meets, double counted)
        : pieces_{pieces},
          meets_{meets},
          counted_{counted},
          grid_{meets},
          used_(pieces.size(), false),
          step_of_(2 * pieces.size(), kNone)
    {
        for (const CurveChain& piece : pieces) {
            lengths_.push_back(length_of_polygons(piece));
            add_end({in_plan(piece.front().points.front()),
                     direction_from(piece.front().points, false)});
            add_end(
                {in_plan(piece.back().points.back()), direction_from(piece.back().points, true)});
        }
    }

    ChainResult run()
    {
        find_junction();
        for (const bool from_open_ends : {true, false}) {
            for (std::size_t end = 0; end < ends_.size(); ++end) {
                if (!used_[end / 2] && (!from_open_ends || is_open(end))) {
                    follow(end);
                }
            }
        }
        return std::move(out_);
    }

private:
    void add_end(const End& end)
    {
        grid_.add(ends_.size(), end.at);
        ends_.push_back(end);
    }
    double apart(std::size_t a, std::size_t b) const { return norm(ends_[a].at - ends_[b].at); }
    std::size_t meeting(std::size_t end, double within) const
    {
        std::size_t count = 0;
        grid_.near(ends_[end].at, [&](std::size_t other) {
            count += other != end && apart(end, other) <= within ? 1U : 0U;
        });
        return count;
    }
    bool is_open(std::size_t end) const { return meeting(end, meets_) == 0; }
    void find_junction()
    {
        for (std::size_t end = 0; end < ends_.size() && !out_.junction; ++end) {
            if (const std::size_t others = meeting(end, counted_); others > 1) {
                out_.junction = {ends_[end].at, others + 1};
            }
        }
    }

    // The end of an unused piece at which a chain that left at `end` continues; kNone: there is none.
    std::size_t next_to(std::size_t end) const
    {
        std::tuple<double, double, std::size_t> best{};
        std::size_t found = kNone;
        grid_.near(ends_[end].at, [&](std::size_t other) {
            const double gap = apart(end, other);
            if (used_[other / 2] || gap > meets_) {
                return;
            }
            const double turn = dot(ends_[end].outward, ends_[other].outward);  // -1: straight on
            const std::tuple rank{gap > counted_ ? gap : 0, turn, other};
            if (found == kNone || rank < best) {
                best = rank;
                found = other;
            }
        });
        return found;
    }

    // The step of the chain whose start is where the last piece ends; kNone: it has not been there.
    std::size_t step_at(std::size_t end) const
    {
        std::size_t latest = kNone;
        grid_.near(ends_[end].at, [&](std::size_t other) {
            const std::size_t step = step_of_[other];
            if (step != kNone && apart(end, other) <= meets_ &&
                (latest == kNone || step > latest) && length_from(step) > 2 * meets_) {
                latest = step;
            }
        });
        return latest;
    }
    double length_from(std::size_t step) const
    {
        double length = 0;
        for (std::size_t k = step; k < steps_.size() && length <= 2 * meets_; ++k) {
            length += lengths_[steps_[k] / 2];
        }
        return length;
    }

    void note_gap(double gap)
    {
        if (gap > counted_) {
            ++out_.bridged;
            out_.widest_gap = std::max(out_.widest_gap, gap);
        }
    }

    // The chain from a step on, which is taken off.
    CurveChain taken_from(std::size_t step)
    {
        CurveChain chain;
        for (std::size_t k = step; k < steps_.size(); ++k) {
            if (k > step) {
                note_gap(apart(steps_[k - 1] ^ 1U, steps_[k]));
            }
            step_of_[steps_[k]] = kNone;
            append(pieces_[steps_[k] / 2], steps_[k] % 2 == 1, chain);
        }
        steps_.resize(step);
        return chain;
    }

    void follow(std::size_t first)
    {
        for (std::size_t at = first; at != kNone;) {
            used_[at / 2] = true;
            step_of_[at] = steps_.size();
            steps_.push_back(at);
            const std::size_t end = at ^ 1U;
            if (const std::size_t step = step_at(end); step != kNone) {
                note_gap(apart(end, steps_[step]));
                out_.closed.push_back(taken_from(step));
            }
            at = steps_.empty() ? kNone : next_to(steps_.back() ^ 1U);
        }
        if (!steps_.empty()) {
            out_.open.push_back(taken_from(0));
        }
    }

    const std::vector<CurveChain>& pieces_;
    double meets_, counted_;
    EndGrid grid_;
    std::vector<End> ends_;
    std::vector<double> lengths_;
    std::vector<bool> used_;
    std::vector<std::size_t> steps_;  // of the chain that is followed: the ends it enters pieces at
    std::vector<std::size_t> step_of_;  // of each end
    ChainResult out_;
};

}  // namespace

ChainResult join_chains(const std::vector<CurveChain>& pieces, double meets, double counted)
{
    return Joining{pieces, meets, counted}.run();
}

}  // namespace cusp::import
