// Contacts bound the drop from below; each exact drop adds a contact.
#include "host_tools/geometry/drop_cutter/lowest_position_search.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/grid_square.hpp"
#include "host_tools/geometry/part_model/pattern_search.hpp"

namespace cusp::drop_cutter {

using part_model::pattern_search;
using part_model::square_key;
using toolpath::Tool;

namespace {

constexpr int kMostDrops = 10;  // from one start
constexpr std::size_t kMostStarts = 3;
constexpr double kApart = 0.3;    // radii: distance of starts
constexpr double kFinest = 1e-3;  // of the pitch
// The cover of directions.
constexpr int kMostCaps = 64;
constexpr int kMostImprovements = 10;        // of positions that known contacts leave open
constexpr int kMostTries = 40;               // drops
constexpr double kPoorMargin = 1e-3;         // the same: another contact may block far more
constexpr double kLeastMargin = 1e-8;        // of a cap beyond the direction that it is to block
constexpr std::size_t kMostProofs = 50'000;  // 15 MB
constexpr std::size_t kMostNodes = 200'000;  // 16 MB
constexpr double kMoreGained = 0.25;         // of the gain: least gain of another search

double square(double a) { return a * a; }

// The square of the distance in plan between a point and the tool's flat.
double square_off_flat(double flat, Vec2d axis, Vec3d place)
{
    const double away = square(place.x - axis.x) + square(place.y - axis.y);
    return flat > 0 ? square(std::max(0.0, std::sqrt(away) - flat)) : away;
}

}  // namespace

LowestPositionSearch::LowestPositionSearch(
    const Tool& tool, double growth, double pitch, double agrees, Drop drop)
    : radius_{tool.radius},
      flat_{tool.radius - tool.corner_radius},
      corner_{tool.corner_radius},
      contact_corner_{tool.corner_radius + growth},
      pitch_{pitch},
      agreement_{agrees},
      drop_{std::move(drop)}
{
}

double LowestPositionSearch::height_under(Vec3d centre, Vec3d place) const
{
    const double under = square(corner_) - square_off_flat(flat_, {centre.x, centre.y}, place);
    return under < 0 ? kInfinite : centre.z - std::sqrt(under);
}

void LowestPositionSearch::begin_with(Nodes nodes)
{
    nodes_ = std::move(nodes);
    begun_with_.clear();
    for (const auto& [key, node] : nodes_) {
        begun_with_.push_back(key);
    }
}

LowestPositionSearch::Nodes LowestPositionSearch::take_nodes()
{
    for (const std::uint64_t key : begun_with_) {
        nodes_.erase(key);
    }
    begun_with_.clear();
    return std::exchange(nodes_, {});
}

const LowestPositionSearch::DroppedTool& LowestPositionSearch::node(std::int64_t i, std::int64_t j)
{
    const std::uint64_t key = square_key(i, j);
    if (known_ != nullptr) {
        const auto known = known_->find(key);
        if (known != known_->end()) {
            return known->second;
        }
    }
    const auto found = nodes_.find(key);
    if (found != nodes_.end()) {
        return found->second;
    }
    if (nodes_.size() > kMostNodes) {
        nodes_.clear();
    }
    return nodes_
        .emplace(key, drop_(static_cast<double>(i) * pitch_, static_cast<double>(j) * pitch_))
        .first->second;
}

std::vector<LowestPositionSearch::Position> LowestPositionSearch::starts_over(Vec3d place)
{
    contacts_.clear();
    std::vector<Position> all;
    for (std::int64_t i = cell(place.x - radius_) + 1; i <= cell(place.x + radius_); ++i) {
        for (std::int64_t j = cell(place.y - radius_) + 1; j <= cell(place.y + radius_); ++j) {
            const double x = static_cast<double>(i) * pitch_;
            const double y = static_cast<double>(j) * pitch_;
            if (square_off_flat(flat_, {x, y}, place) > square(corner_)) {
                continue;
            }
            const DroppedTool& at = node(i, j);
            if (std::isfinite(at.centre.z)) {
                contacts_.push_back(at.contact);
                all.push_back({at.centre, height_under(at.centre, place)});
            }
        }
    }
    std::sort(all.begin(), all.end(),
              [](const Position& a, const Position& b) { return a.height < b.height; });
    std::vector<Position> out;
    for (const Position& start : all) {
        const bool apart = std::all_of(out.begin(), out.end(), [&](const Position& other) {
            return elementary::hypot(start.centre.x - other.centre.x,
                                     start.centre.y - other.centre.y) > kApart * radius_;
        });
        if (apart) {
            out.push_back(start);
        }
        if (out.size() == kMostStarts) {
            break;
        }
    }
    return out;
}

// Lower bound of the height at which a tool resting on the known contacts cuts over the point.
double LowestPositionSearch::lowest_known(Vec3d place, Vec2d at) const
{
    double centre = -kInfinite;
    for (const Vec3d& contact : contacts_) {
        const double up = square(contact_corner_) - square_off_flat(flat_, at, contact);
        if (up >= 0) {
            centre = std::max(centre, contact.z + std::sqrt(up));
        }
    }
    return height_under({at.x, at.y, centre}, place);
}

// A local minimum of lowest_known() near `at`.
Vec2d LowestPositionSearch::improved(Vec3d place, Vec2d at)
{
    double best = lowest_known(place, at);
    const double corner_square = square(contact_corner_);
    const double flat = flat_;
    // True where no contact keeps the tool as high as `best`. A contact that does moves to the
    // front: usually the same few decide.
    const auto lower = [&](Vec2d to) {
        const double under = square(corner_) - square_off_flat(flat_, to, place);
        if (under < 0) {
            return false;
        }
        const double depth = std::sqrt(under);
        const double limit = best + depth;
        double centre = -kInfinite;
        for (std::size_t i = 0; i < contacts_.size(); ++i) {
            const Vec3d c = contacts_[i];
            const double up = corner_square - square_off_flat(flat, to, c);
            const bool higher = up >= 0 && (c.z > centre || up > square(centre - c.z));
            centre = higher ? c.z + std::sqrt(up) : centre;
            if (centre >= limit) {
                std::swap(contacts_[i], contacts_[i / 2]);
                return false;
            }
        }
        // Rounding may give an equal height, which must not count: the search would never end.
        const bool found = centre - depth < best;
        best = std::min(best, centre - depth);
        return found;
    };
    return pattern_search(at, pitch_, kFinest * pitch_, lower);
}

void LowestPositionSearch::improve_from(const Position& start,
                                        Vec3d place,
                                        double exact_below,
                                        std::optional<Position>& best)
{
    const auto take = [&](const Position& answer) {
        if (!best || answer.height < best->height) {
            best = answer;
        }
    };
    take(start);
    Vec2d at{start.centre.x, start.centre.y};
    for (int drops = 0; drops < kMostDrops; ++drops) {
        const Vec2d to = improved(place, at);
        const double bound = lowest_known(place, to);
        // From this start nothing lower than the best or `exact_below` can be reached.
        if (bound > exact_below || bound > best->height - agreement_) {
            return;
        }
        const DroppedTool rest = drop_(to.x, to.y);
        if (!std::isfinite(rest.centre.z)) {
            return;
        }
        const double height = height_under(rest.centre, place);
        take({rest.centre, height});
        contacts_.push_back(rest.contact);
        if (height - bound < agreement_) {
            return;
        }
        at = to;
    }
}

// For a tool without a corner radius the bound by contacts is piecewise constant, without a slope
// to follow: the search uses drops instead.
void LowestPositionSearch::improve_by_drops(Vec3d place, Position& best)
{
    const auto lower = [&](Vec2d to) {
        const Vec3d centre = drop_(to.x, to.y).centre;
        const double height = height_under(centre, place);
        const bool found = height < best.height;
        best = found ? Position{centre, height} : best;
        return found;
    };
    pattern_search({best.centre.x, best.centre.y}, pitch_, kFinest * pitch_, lower);
}

std::int64_t LowestPositionSearch::cell(double at) const
{
    return static_cast<std::int64_t>(std::floor(at / pitch_));
}

// The known contact that blocks a ball with this centre by most.
ApproachBlock LowestPositionSearch::greatest_block(Vec3d point, Vec3d centre) const
{
    ApproachBlock best;
    for (const Vec3d& contact : contacts_) {
        const ApproachBlock block =
            approach_block(contact, point, centre, radius_, contact_corner_);
        best = block.margin > best.margin ? block : best;
    }
    return best;
}

// Drops the ball where it would cut down to `point`. Returns a lower position, if that is one; else its
// contact is known from now on, and becomes `best` where it blocks more than that.
std::optional<LowestPositionSearch::Position> LowestPositionSearch::lower_at(Vec2d at,
                                                                             Vec3d point,
                                                                             Vec3d centre,
                                                                             ApproachBlock& best)
{
    const DroppedTool rest = drop_(at.x, at.y);
    if (!std::isfinite(rest.centre.z)) {
        return std::nullopt;
    }
    const double there = height_under(rest.centre, point);
    if (there < point.z) {
        return Position{rest.centre, there};
    }
    contacts_.push_back(rest.contact);
    const ApproachBlock block =
        approach_block(rest.contact, point, centre, radius_, contact_corner_);
    best = block.margin > best.margin ? block : best;
    return std::nullopt;
}

// A position of the ball lower than `height`, if one is found. A descent from a few starts misses
// narrow gaps between cliffs. Contacts block caps of the directions from which a ball cuts down to
// that height; from a direction that none blocks well the ball is dropped, which finds a lower
// position or adds a contact.
//
// Precondition: the tool is a ball
std::optional<LowestPositionSearch::Position> LowestPositionSearch::lower_than(double height,
                                                                               Vec3d place,
                                                                               bool& proved)
{
    const Vec3d point{place.x, place.y, height};
    if (proofs_.size() > kMostProofs) {
        proofs_.clear();
    }
    std::vector<Vec3d>& last = proofs_[square_key(cell(place.x), cell(place.y))];
    contacts_.insert(contacts_.begin(), last.begin(), last.end());
    last.clear();
    HalfSphereCover cover;
    bool by_contacts = true;
    int drops = 0;
    std::optional<Vec3d> open = cover.open();
    for (int caps = 0; open && caps < kMostCaps; ++caps, open = cover.open()) {
        const Vec3d centre = point + *open * radius_;
        const Vec2d at{centre.x, centre.y};
        ApproachBlock best = greatest_block(point, centre);
        std::optional<Position> lower;
        // The direction may be a corner of what is open: the best place is within.
        if (best.margin <= kPoorMargin && drops < kMostImprovements) {
            const Vec2d within = improved(place, at);
            if (lowest_known(place, within) < height) {
                ++drops;
                lower = lower_at(within, point, centre, best);
            }
        }
        if (!lower && best.margin <= kPoorMargin && ++drops < kMostTries) {
            lower = lower_at(at, point, centre, best);
        }
        if (lower) {
            return lower;
        }
        if (best.margin > kLeastMargin) {
            last.push_back(best.contact);
        } else {
            // The tool is not allowed there, or touches nothing: directions farther off are tried.
            by_contacts = false;
            best.cap = {*open, 1 - 0.5 * square(pitch_ / radius_)};
        }
        if (!cover.add(best.cap)) {
            return std::nullopt;
        }
    }
    proved = !open && by_contacts;
    return std::nullopt;
}

std::optional<LowestPositionSearch::Position> LowestPositionSearch::lowest_over(
    Vec3d place, double exact_below, double sufficient, std::optional<Vec2d> guess)
{
    std::optional<Position> first;
    if (guess) {
        const DroppedTool rest = drop_(guess->x, guess->y);
        if (std::isfinite(rest.centre.z)) {
            first = Position{rest.centre, height_under(rest.centre, place)};
            if (first->height <= sufficient) {
                return first;
            }
        }
    }
    std::vector<Position> starts = starts_over(place);
    if (first && std::isfinite(first->height)) {
        starts.push_back(*first);
    }
    const bool ball = flat_ == 0;
    std::optional<Position> best;
    // Fast rejection: usually nothing lower exists.
    if (ball && !starts.empty() &&
        std::none_of(starts.begin(), starts.end(),
                     [&](const Position& start) { return start.height < exact_below; })) {
        bool proved = false;
        best = lower_than(exact_below - agreement_, place, proved);
        if (!best && proved) {
            return starts.front();
        }
    }
    for (const Position& start : starts) {
        improve_from(start, place, exact_below, best);
        if (best->height <= sufficient) {
            return best;
        }
    }
    if (best && corner_ == 0) {
        improve_by_drops(place, *best);
    }
    while (ball && best && best->height > sufficient && best->height < exact_below) {
        const double gained = exact_below - best->height;
        bool proved = false;
        const auto lower =
            lower_than(best->height - std::max(agreement_, kMoreGained * gained), place, proved);
        if (!lower) {
            break;
        }
        improve_from(*lower, place, exact_below, best);
    }
    return best;
}

LowestPositionSearch::DroppedTool drop_tool(const DropCutter& floor, double x, double y)
{
    const std::optional<DropCutter::ClPoint> cl = floor.drop({x, y});
    if (!cl) {
        return {{x, y, kInfinite}, {}};
    }
    const Tool& tool = floor.tool();
    const Vec2d touched = floor.cc_place({x, y}, *cl);
    const double away = std::min(tool.radius, elementary::hypot(touched.x - x, touched.y - y));
    return {{x, y, cl->z + tool.corner_radius},
            {touched.x, touched.y, cl->z + profile_height(tool, away)}};
}

}  // namespace cusp::drop_cutter
