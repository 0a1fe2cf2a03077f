// A sweep along x counts the boxes that cover each interval of y. The union has a side where the
// count leaves or reaches zero; the ends of sides are its corners.
#include "host_tools/cam/hull_rough/box_union.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <tuple>

namespace cusp::hull_rough {
namespace {

struct Event {
    double x;
    bool begins;
    double y_min;
    double y_max;
};

std::vector<Event> sorted_events(const std::vector<Rectangle>& boxes)
{
    std::vector<Event> events;
    for (const Rectangle& box : boxes) {
        if (box.x_min < box.x_max && box.y_min < box.y_max) {
            events.push_back({box.x_min, true, box.y_min, box.y_max});
            events.push_back({box.x_max, false, box.y_min, box.y_max});
        }
    }
    // At equal x, boxes that begin come before boxes that end: there is no side between them.
    std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
        return std::make_tuple(a.x, !a.begins, a.y_min, a.y_max) <
               std::make_tuple(b.x, !b.begins, b.y_min, b.y_max);
    });
    return events;
}

// A side of the union at the present x.
struct Stretch {
    double y_min;
    double y_max;
};

// The number of boxes that cover each interval of y; the count of a key holds up to the next key.
class Coverage {
public:
    // Adds or removes one box; returns the intervals whose count left or reached zero.
    std::vector<Stretch> change(const Event& event)
    {
        const auto first = split(event.y_min);
        const auto last = split(event.y_max);
        std::vector<Stretch> sides;
        for (auto here = first; here != last; ++here) {
            const bool edge = event.begins ? here->second == 0 : here->second == 1;
            here->second += event.begins ? 1 : -1;
            if (edge) {
                const double end = std::next(here)->first;
                if (!sides.empty() && sides.back().y_max == here->first) {
                    sides.back().y_max = end;
                } else {
                    sides.push_back({here->first, end});
                }
            }
        }
        merge(first->first, last->first);
        return sides;
    }

private:
    std::map<double, int> counts_;

    std::map<double, int>::iterator split(double y)
    {
        const auto next = counts_.upper_bound(y);
        if (next != counts_.begin() && std::prev(next)->first == y) {
            return std::prev(next);
        }
        const int count = next == counts_.begin() ? 0 : std::prev(next)->second;
        return counts_.emplace_hint(next, y, count);
    }

    // Removes keys that no longer change the count, so that the map's size is that of the active
    // boxes.
    void merge(double y_min, double y_max)
    {
        auto here = counts_.lower_bound(y_min);
        while (here != counts_.end() && here->first <= y_max) {
            const int before = here == counts_.begin() ? 0 : std::prev(here)->second;
            here = here->second == before ? counts_.erase(here) : std::next(here);
        }
    }
};

// Sides of the union along y. `up` sides have the union on their left: loops turn
// counter-clockwise.
struct Side {
    double x;
    double y_min;
    double y_max;
    bool up;
};

std::vector<Side> sides_along_y(const std::vector<Rectangle>& boxes)
{
    std::vector<Side> sides;
    Coverage coverage;
    std::size_t of_this_x = 0;
    for (const Event& event : sorted_events(boxes)) {
        if (of_this_x < sides.size() && sides[of_this_x].x != event.x) {
            of_this_x = sides.size();
        }
        for (const Stretch& s : coverage.change(event)) {
            sides.push_back({event.x, s.y_min, s.y_max, !event.begins});
        }
    }
    return sides;
}

struct Corner {
    Vec2d point;
    std::size_t side;
    bool at_top;
    bool leaves;  // the loop leaves this corner along its side in y
};

// Joins touching sides at one x with the same direction, so that loops have no needless corners.
std::vector<Side> joined(std::vector<Side> sides)
{
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.x, a.up, a.y_min) < std::tie(b.x, b.up, b.y_min);
    });
    std::vector<Side> out;
    for (const Side& side : sides) {
        if (!out.empty() && out.back().x == side.x && out.back().up == side.up &&
            out.back().y_max == side.y_min) {
            out.back().y_max = side.y_max;
        } else {
            out.push_back(side);
        }
    }
    return out;
}

// For every side, the next one in its loop. At each y, the corners in order of x are alternately
// the left and right ends of horizontal sides. If parts touch in a point, two corners are equal;
// this order makes both parts one loop.
std::vector<std::size_t> followers(const std::vector<Side>& sides)
{
    std::vector<Corner> corners;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const Side& s = sides[i];
        corners.push_back({{s.x, s.y_min}, i, false, s.up});
        corners.push_back({{s.x, s.y_max}, i, true, !s.up});
    }
    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        return std::make_tuple(a.point.y, a.point.x, a.at_top != a.leaves) <
               std::make_tuple(b.point.y, b.point.x, b.at_top != b.leaves);
    });
    std::vector<std::size_t> next(sides.size());
    for (std::size_t i = 0; i < corners.size(); i += 2) {
        const Corner& a = corners[i];
        const Corner& b = corners[i + 1];
        if (a.leaves) {
            next[b.side] = a.side;
        } else {
            next[a.side] = b.side;
        }
    }
    return next;
}

}  // namespace

double union_area(const std::vector<Rectangle>& boxes, const Rectangle& window)
{
    std::vector<Rectangle> inside;
    for (const Rectangle& box : boxes) {
        inside.push_back({std::max(box.x_min, window.x_min), std::max(box.y_min, window.y_min),
                          std::min(box.x_max, window.x_max), std::min(box.y_max, window.y_max)});
    }
    double area = 0;
    for (const Side& side : sides_along_y(inside)) {
        area += (side.up ? 1 : -1) * (side.x - window.x_min) * (side.y_max - side.y_min);
    }
    return area;
}

std::vector<std::vector<Vec2d>> union_outline(const std::vector<Rectangle>& boxes)
{
    const std::vector<Side> sides = joined(sides_along_y(boxes));
    const std::vector<std::size_t> next = followers(sides);
    std::vector<std::vector<Vec2d>> loops;
    std::vector<bool> done(sides.size(), false);
    for (std::size_t first = 0; first < sides.size(); ++first) {
        if (done[first]) {
            continue;
        }
        loops.emplace_back();
        for (std::size_t i = first; !done[i]; i = next[i]) {
            done[i] = true;
            const Side& s = sides[i];
            loops.back().push_back({s.x, s.up ? s.y_min : s.y_max});
            loops.back().push_back({s.x, s.up ? s.y_max : s.y_min});
        }
    }
    return loops;
}

}  // namespace cusp::hull_rough
