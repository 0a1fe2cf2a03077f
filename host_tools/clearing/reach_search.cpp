// Contacts bound the drop from below, each exact drop adds one.
#include "host_tools/clearing/reach_search.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/clearing/ball_directions.hpp"
#include "host_tools/surface_offset/pattern_search.hpp"

namespace cusp::host {
namespace {

constexpr int kMostDrops = 10;          // from a start
constexpr std::size_t kMostStarts = 3;  // apart from each other
constexpr double kApart = 0.3;          // radii
constexpr double kFinest = 1e-3;        // of the pitch
// Where no walk leads lower.
constexpr std::size_t kMostTriangles = 600;  // of directions that are looked at
constexpr int kMostWalks = 10;               // to what the contacts known leave open
constexpr int kMostTries = 40;               // drops for nothing but a contact
constexpr std::size_t kMostRemembered = 64;  // contacts
constexpr double kMoreGained = 0.25;         // of what is gained: worth another search

double square(double a) { return a * a; }

// The square of how far a place is from the tool's flat, seen from above.
double square_off_flat(double flat, Vec2d axis, Vec3d place)
{
    const double away = square(place.x - axis.x) + square(place.y - axis.y);
    return flat > 0 ? square(std::max(0.0, std::sqrt(away) - flat)) : away;
}

}  // namespace

ReachSearch::ReachSearch(const Tool& tool, double keep_off, double pitch, double agrees, Drop drop)
    : radius_{tool.radius},
      flat_{tool.radius - tool.corner_radius},
      corner_{tool.corner_radius},
      contact_corner_{tool.corner_radius + keep_off},
      pitch_{pitch},
      agrees_{agrees},
      drop_{std::move(drop)}
{
}

double ReachSearch::height_under(Vec3d centre, Vec3d place) const
{
    const double under = square(corner_) - square_off_flat(flat_, {centre.x, centre.y}, place);
    return under < 0 ? kNowhere : centre.z - std::sqrt(under);
}

const ReachSearch::Rest& ReachSearch::node(std::int64_t i, std::int64_t j)
{
    const std::uint64_t key =
        (static_cast<std::uint64_t>(i) << 32) ^ (static_cast<std::uint64_t>(j) & 0xffffffffU);
    const auto found = nodes_.find(key);
    if (found != nodes_.end()) {
        return found->second;
    }
    return nodes_
        .emplace(key, drop_(static_cast<double>(i) * pitch_, static_cast<double>(j) * pitch_))
        .first->second;
}

// The contacts of all nodes are kept.
void ReachSearch::remember(Vec3d contact)
{
    if (remembered_.size() < kMostRemembered) {
        remembered_.push_back(contact);
    } else {
        remembered_[next_remembered_++ % kMostRemembered] = contact;
    }
}

std::vector<ReachSearch::Answer> ReachSearch::starts_over(Vec3d place)
{
    contacts_.clear();
    for (const Vec3d& contact : remembered_) {
        if (std::hypot(contact.x - place.x, contact.y - place.y) < 2 * radius_) {
            contacts_.push_back(contact);
        }
    }
    std::vector<Answer> all;
    const auto cell = [&](double at) {
        return static_cast<std::int64_t>(std::floor(at / pitch_));
    };
    for (std::int64_t i = cell(place.x - radius_) + 1; i <= cell(place.x + radius_); ++i) {
        for (std::int64_t j = cell(place.y - radius_) + 1; j <= cell(place.y + radius_); ++j) {
            const double x = static_cast<double>(i) * pitch_;
            const double y = static_cast<double>(j) * pitch_;
            if (square_off_flat(flat_, {x, y}, place) > square(corner_)) {
                continue;
            }
            const Rest& at = node(i, j);
            if (std::isfinite(at.centre.z)) {
                contacts_.push_back(at.contact);
                all.push_back({at.centre, height_under(at.centre, place)});
            }
        }
    }
    std::sort(all.begin(), all.end(),
              [](const Answer& a, const Answer& b) { return a.height < b.height; });
    std::vector<Answer> out;
    for (const Answer& start : all) {
        const bool apart = std::all_of(out.begin(), out.end(), [&](const Answer& other) {
            return std::hypot(start.centre.x - other.centre.x, start.centre.y - other.centre.y) >
                   kApart * radius_;
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

// What a tool that stands on the contacts known leaves over the place: never above the truth.
double ReachSearch::lowest_known(Vec3d place, Vec2d at) const
{
    double centre = -kNowhere;
    for (const Vec3d& contact : contacts_) {
        const double up = square(contact_corner_) - square_off_flat(flat_, at, contact);
        if (up >= 0) {
            centre = std::max(centre, contact.z + std::sqrt(up));
        }
    }
    return height_under({at.x, at.y, centre}, place);
}

// A place where `lowest_known` is least, near the one given.
Vec2d ReachSearch::improved(Vec3d place, Vec2d at)
{
    double best = lowest_known(place, at);
    const double corner_square = square(contact_corner_);
    const double flat = flat_;
    // True where no contact keeps the tool as high as `best`. The one that does is looked at first
    // the next time: mostly the same few are in the way.
    const auto lower = [&](Vec2d to) {
        const double under = square(corner_) - square_off_flat(flat_, to, place);
        if (under < 0) {
            return false;
        }
        const double depth = std::sqrt(under);
        const double limit = best + depth;
        double centre = -kNowhere;
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
        // Rounding may have let it pass at the same height: no walk goes on for ever.
        const bool found = centre - depth < best;
        best = std::min(best, centre - depth);
        return found;
    };
    return pattern_search(at, pitch_, kFinest * pitch_, lower);
}

void ReachSearch::improve_from(const Answer& start,
                               Vec3d place,
                               double worth,
                               std::optional<Answer>& best)
{
    const auto take = [&](const Answer& answer) {
        if (!best || answer.height < best->height) {
            best = answer;
        }
    };
    take(start);
    Vec2d at{start.centre.x, start.centre.y};
    for (int drops = 0; drops < kMostDrops; ++drops) {
        const Vec2d to = improved(place, at);
        const double hoped = lowest_known(place, to);
        // The contacts know that this start leads no lower than what is known or asked for.
        if (hoped > worth || hoped > best->height - agrees_) {
            return;
        }
        const Rest rest = drop_(to.x, to.y);
        if (!std::isfinite(rest.centre.z)) {
            return;
        }
        const double height = height_under(rest.centre, place);
        take({rest.centre, height});
        contacts_.push_back(rest.contact);
        if (height - hoped < agrees_) {
            return;
        }
        at = to;
    }
}

// Under a tool without a corner single contacts are steps of a stair: no slope leads on.
void ReachSearch::improve_by_drops(Vec3d place, Answer& best)
{
    const auto lower = [&](Vec2d to) {
        const Vec3d centre = drop_(to.x, to.y).centre;
        const double height = height_under(centre, place);
        const bool found = height < best.height;
        best = found ? Answer{centre, height} : best;
        return found;
    };
    pattern_search({best.centre.x, best.centre.y}, pitch_, kFinest * pitch_, lower);
}

// Walks from a few starts miss narrow ways between cliffs. The directions that no contact bars are
// quartered, large parts first, and their middles are tried: whether the ball gets lower than a
// height, and the first place found where it does.
//
// Precondition: the tool is a ball
std::optional<ReachSearch::Answer> ReachSearch::lower_than(double height, Vec3d place, bool& proved)
{
    BallDirections directions{{place.x, place.y, height}, radius_, contact_corner_};
    for (const Vec3d& contact : contacts_) {
        directions.add(contact);
    }
    const auto whole = BallDirections::half_sphere();
    std::vector<BallDirections::Triangle> open{whole.begin(), whole.end()};
    int walks = 0;
    int tries = 0;
    for (std::size_t k = 0; k < open.size() && k < kMostTriangles; ++k) {
        const BallDirections::Triangle triangle = open[k];
        if (directions.bars(triangle)) {
            continue;
        }
        const Vec3d middle = directions.centre(BallDirections::middle(triangle));
        Vec2d at{middle.x, middle.y};
        const bool open_middle = lowest_known(place, at) < height;
        const double edge = norm(triangle[0] - triangle[1]);
        // Among nodes too few contacts are known.
        if (open_middle || (edge * radius_ < pitch_ && ++tries < kMostTries)) {
            if (open_middle && ++walks < kMostWalks) {
                at = improved(place, at);
            }
            const Rest rest = drop_(at.x, at.y);
            if (std::isfinite(rest.centre.z)) {
                const Answer there{rest.centre, height_under(rest.centre, place)};
                contacts_.push_back(rest.contact);
                remember(rest.contact);
                if (there.height < height) {
                    return there;
                }
                directions.add(rest.contact);
                if (directions.bars(triangle)) {
                    continue;
                }
            }
        }
        const auto parts = BallDirections::quarters(triangle);
        open.insert(open.end(), parts.begin(), parts.end());
    }
    proved = open.size() <= kMostTriangles;
    return std::nullopt;
}

std::optional<ReachSearch::Answer> ReachSearch::over(Vec3d place,
                                                     double worth,
                                                     double enough,
                                                     std::optional<Vec2d> guess)
{
    std::optional<Answer> first;
    if (guess) {
        const Rest rest = drop_(guess->x, guess->y);
        if (std::isfinite(rest.centre.z)) {
            first = Answer{rest.centre, height_under(rest.centre, place)};
            if (first->height <= enough) {
                return first;
            }
        }
    }
    std::vector<Answer> starts = starts_over(place);
    if (first && std::isfinite(first->height)) {
        starts.push_back(*first);
    }
    const bool ball = flat_ == 0;
    std::optional<Answer> best;
    // Mostly there is nothing better, and that is told at once.
    if (ball && !starts.empty() &&
        std::none_of(starts.begin(), starts.end(),
                     [&](const Answer& start) { return start.height < worth; })) {
        bool proved = false;
        best = lower_than(worth - agrees_, place, proved);
        if (!best && proved) {
            return starts.front();
        }
    }
    for (const Answer& start : starts) {
        improve_from(start, place, worth, best);
        if (best->height <= enough) {
            return best;
        }
    }
    if (best && corner_ == 0) {
        improve_by_drops(place, *best);
    }
    while (ball && best && best->height > enough && best->height < worth) {
        const double gained = worth - best->height;
        bool proved = false;
        const auto lower =
            lower_than(best->height - std::max(agrees_, kMoreGained * gained), place, proved);
        if (!lower) {
            break;
        }
        improve_from(*lower, place, worth, best);
    }
    return best;
}

ReachSearch::Rest rest_on(const TipFloor& floor, double x, double y)
{
    const TipFloor::Rest rest = floor.drop({x, y});
    if (rest.height == TipFloor::kNothing) {
        return {{x, y, ReachSearch::kNowhere}, {}};
    }
    const Tool& tool = floor.tool();
    const Vec2d touched = floor.touched({x, y}, rest);
    const double away = std::min(tool.radius, std::hypot(touched.x - x, touched.y - y));
    return {{x, y, rest.height + tool.corner_radius},
            {touched.x, touched.y, rest.height + profile_height(tool, away)}};
}

}  // namespace cusp::host
