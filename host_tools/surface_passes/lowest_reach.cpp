// Kelley's way: contacts bound the drop from below, each exact drop adds one.
#include "host_tools/surface_passes/lowest_reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cusp::host {
namespace {

constexpr int kMostDrops = 10;          // from a start
constexpr std::size_t kMostStarts = 3;  // apart from each other
constexpr double kApart = 0.3;          // radii
constexpr double kAgrees = 3e-4;        // mm
constexpr double kDropAccuracy = 1e-4;  // mm
constexpr double kFinest = 1e-3;        // of the pitch
constexpr int kDirections = 8;
constexpr double kTurn = 0.41;  // radians, so that no valley lies between all directions
constexpr double kNever = std::numeric_limits<double>::infinity();

double square(double a) { return a * a; }

}  // namespace

LowestReach::LowestReach(const std::vector<Surface>& surfaces,
                         const CertifiedPasses& certified,
                         double pitch)
    : surfaces_{surfaces},
      certified_{certified},
      radius_{certified.tool().radius},
      contact_radius_{radius_ + certified.band().lift},
      pitch_{pitch}
{
}

LowestReach::Node LowestReach::dropped(double x, double y)
{
    if (surfaces_.empty()) {
        const auto rest = certified_.model().rest_on_mesh(x, y, contact_radius_);
        return rest ? Node{rest->centre, rest->point} : Node{{x, y, kNever}, {}};
    }
    // Most models never ask.
    if (!floor_) {
        floor_.emplace(surfaces_, certified_.lifted_tool(), kDropAccuracy);
    }
    const TipFloor::Contact contact = floor_->contact({x, y}, 0.0);
    if (contact.height == TipFloor::kNothing) {
        return {{x, y, kNever}, {}};
    }
    return {{x, y, contact.height + contact_radius_}, contact.surface.point};
}

const LowestReach::Node& LowestReach::node(std::int64_t i, std::int64_t j)
{
    const std::uint64_t key =
        (static_cast<std::uint64_t>(i) << 32) ^ (static_cast<std::uint64_t>(j) & 0xffffffffU);
    const auto found = nodes_.find(key);
    if (found != nodes_.end()) {
        return found->second;
    }
    return nodes_
        .emplace(key, dropped(static_cast<double>(i) * pitch_, static_cast<double>(j) * pitch_))
        .first->second;
}

// The best nodes, apart from each other; the contacts of all nodes are kept.
std::vector<LowestReach::Start> LowestReach::starts_over(Vec3d place)
{
    contacts_.clear();
    std::vector<Start> all;
    const auto cell = [&](double at) {
        return static_cast<std::int64_t>(std::floor(at / pitch_));
    };
    for (std::int64_t i = cell(place.x - radius_) + 1; i <= cell(place.x + radius_); ++i) {
        for (std::int64_t j = cell(place.y - radius_) + 1; j <= cell(place.y + radius_); ++j) {
            const double x = static_cast<double>(i) * pitch_;
            const double y = static_cast<double>(j) * pitch_;
            const double under = square(radius_) - square(x - place.x) - square(y - place.y);
            if (under < 0) {
                continue;
            }
            const Node& at = node(i, j);
            if (std::isfinite(at.centre.z)) {
                contacts_.push_back(at.contact);
                all.push_back({at.centre.z - std::sqrt(under), at.centre});
            }
        }
    }
    std::sort(all.begin(), all.end(),
              [](const Start& a, const Start& b) { return a.height < b.height; });
    std::vector<Start> out;
    for (const Start& start : all) {
        const bool apart = std::all_of(out.begin(), out.end(), [&](const Start& other) {
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

// What a ball that stands on the contacts known leaves over the place: never above the truth.
double LowestReach::height_over(Vec3d place, double x, double y) const
{
    const double under = square(radius_) - square(x - place.x) - square(y - place.y);
    if (under < 0) {
        return kNever;
    }
    double centre = -kNever;
    for (const Vec3d& contact : contacts_) {
        const double up = square(contact_radius_) - square(x - contact.x) - square(y - contact.y);
        if (up > 0) {
            centre = std::max(centre, contact.z + std::sqrt(up));
        }
    }
    return centre - std::sqrt(under);
}

// A place where `height_over` is least, near the one given.
std::array<double, 2> LowestReach::improved(Vec3d place, double x, double y)
{
    double best = height_over(place, x, y);
    // True where no contact keeps the ball as high as `best`. The one that does is looked at first
    // the next time: mostly the same few are in the way.
    const auto lower_at = [&](double to_x, double to_y) {
        const double under = square(radius_) - square(to_x - place.x) - square(to_y - place.y);
        if (under < 0) {
            return false;
        }
        const double centre = best + std::sqrt(under);
        for (std::size_t i = 0; i < contacts_.size(); ++i) {
            const Vec3d c = contacts_[i];
            const double up = square(contact_radius_) - square(to_x - c.x) - square(to_y - c.y);
            if (up > 0 && (c.z >= centre || up >= square(centre - c.z))) {
                std::swap(contacts_[i], contacts_[i / 2]);
                return false;
            }
        }
        return true;
    };
    double turn = 0;
    for (double step = pitch_; step > kFinest * pitch_; turn += kTurn) {
        const double from = best;
        for (int k = 0; k < kDirections; ++k) {
            const double angle = turn + k * 0.78539816339744831;
            const double to_x = x + step * std::cos(angle);
            const double to_y = y + step * std::sin(angle);
            if (lower_at(to_x, to_y)) {
                best = height_over(place, to_x, to_y);
                x = to_x;
                y = to_y;
                break;
            }
        }
        if (best == from) {
            step *= 0.5;
        }
    }
    return {x, y};
}

std::optional<LowestReach::Answer> LowestReach::over(Vec3d place, double worth)
{
    std::optional<Start> best;
    const auto height_of = [&](Vec3d centre) {
        return centre.z - std::sqrt(std::max(0.0, square(radius_) - square(centre.x - place.x) -
                                                      square(centre.y - place.y)));
    };
    const auto take = [&](Vec3d centre, double height) {
        if (!best || height < best->height) {
            best = Start{height, centre};
        }
    };
    for (const Start& start : starts_over(place)) {
        take(start.centre, start.height);
        double x = start.centre.x;
        double y = start.centre.y;
        for (int drops = 0; drops < kMostDrops; ++drops) {
            const auto [to_x, to_y] = improved(place, x, y);
            const double hoped = height_over(place, to_x, to_y);
            // The contacts know that this start leads no lower than what is known or asked for.
            if (hoped > worth || (best && hoped > best->height - kAgrees)) {
                break;
            }
            const Node at = dropped(to_x, to_y);
            if (!std::isfinite(at.centre.z)) {
                break;
            }
            const double height = height_of(at.centre);
            take(at.centre, height);
            contacts_.push_back(at.contact);
            if (height - hoped < kAgrees) {
                break;
            }
            x = to_x;
            y = to_y;
        }
    }
    if (!best) {
        return std::nullopt;
    }
    if (best->height > worth) {
        return Answer{best->centre - Vec3d{0, 0, radius_}, best->height};
    }
    const std::optional<Vec3d> tip = certified_.dropped(best->centre.x, best->centre.y);
    if (!tip) {
        return std::nullopt;
    }
    return Answer{*tip, height_of(*tip + Vec3d{0, 0, radius_})};
}

// What the tool leaves where it stands on the model and off its guarded edges.
std::optional<LowestReach::Answer> LowestReach::raised_over(Vec3d place,
                                                            double x,
                                                            double y,
                                                            bool exact)
{
    const double under = square(radius_) - square(x - place.x) - square(y - place.y);
    if (under < 0) {
        return std::nullopt;
    }
    Vec3d tip;
    if (exact) {
        const std::optional<Vec3d> on_model = certified_.dropped(x, y);
        if (!on_model) {
            return std::nullopt;
        }
        tip = *on_model;
    } else {
        tip = dropped(x, y).centre - Vec3d{0, 0, radius_};
        if (!std::isfinite(tip.z)) {
            return std::nullopt;
        }
    }
    tip = certified_.raised_off_edges(tip);
    return Answer{tip, tip.z + radius_ - std::sqrt(under)};
}

void LowestReach::improve_raised(Vec3d place, Answer& best)
{
    double turn = 0;
    for (double step = pitch_; step > kFinest * pitch_; turn += kTurn) {
        bool lower = false;
        for (int k = 0; k < kDirections && !lower; ++k) {
            const double angle = turn + k * 0.78539816339744831;
            const std::optional<Answer> other =
                raised_over(place, best.tip.x + step * std::cos(angle),
                            best.tip.y + step * std::sin(angle), false);
            lower = other && other->height < best.height;
            if (lower) {
                best = *other;
            }
        }
        if (!lower) {
            step *= 0.5;
        }
    }
}

// Contacts say nothing of how far an edge keeps the tool off: here each step is a drop.
std::optional<LowestReach::Answer> LowestReach::kept_off_edges(Vec3d place,
                                                               const Answer& from,
                                                               double worth)
{
    std::vector<Start> starts = starts_over(place);
    starts.push_back({from.height, from.tip});
    std::optional<Answer> best;
    for (const Start& start : starts) {
        std::optional<Answer> here = raised_over(place, start.centre.x, start.centre.y, false);
        if (!here) {
            continue;
        }
        improve_raised(place, *here);
        if (!best || here->height < best->height) {
            best = here;
        }
    }
    if (!best || best->height > worth) {
        return std::nullopt;
    }
    best = raised_over(place, best->tip.x, best->tip.y, true);
    return best && best->height <= worth ? best : std::nullopt;
}

}  // namespace cusp::host
