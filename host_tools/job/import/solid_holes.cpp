// Each hole by itself; then those that one operation can make together.
#include "host_tools/job/import/solid_holes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/import/drawing_choice.hpp"

namespace cusp::import {

using job::Hole;

namespace {

constexpr double kSameStep = 0.01;  // mm
constexpr double kRoomToMove =
    0.8;  // of a hole's diameter: a wider flat end bores nearly straight down

struct Choice {
    HoleWay way{HoleWay::kLeft};
    std::size_t tool{};
};

class HoleSorter {
public:
    HoleSorter(const CadHoles& found,
               const std::vector<NamedTool>& tools,
               double unit,
               const GroundAround& ground)
        : found_{found}, tools_{tools}, unit_{unit}, ground_{ground}
    {
    }

    std::vector<SolidHoles> sorted() const
    {
        std::vector<SolidHoles> all;
        for (std::size_t k = 0; k < found_.holes.size(); ++k) {
            all.push_back(alone(k));
        }
        std::stable_sort(all.begin(), all.end(), [](const SolidHoles& a, const SolidHoles& b) {
            const double across = std::round(a.diameter / kSameDiameter);
            const double other = std::round(b.diameter / kSameDiameter);
            return across != other ? across < other : a.greatest_top > b.greatest_top;
        });
        std::vector<SolidHoles> kinds;
        for (const SolidHoles& hole : all) {
            if (kinds.empty() || !joins(hole, kinds.back())) {
                kinds.push_back(hole);
                continue;
            }
            SolidHoles& kind = kinds.back();
            kind.least_top = std::min(kind.least_top, hole.least_top);
            kind.begins = std::max(kind.begins, hole.begins);
            kind.holes.push_back(hole.holes.front());
            const bool is_stricter = is_step(hole.holes.front()) && hole.way != HoleWay::kLeft;
            if (is_stricter || kind.way == HoleWay::kLeft) {
                kind.way = hole.way;
                kind.tool = hole.tool;
            }
        }
        for (SolidHoles& kind : kinds) {
            kind.alone = std::count_if(kinds.begin(), kinds.end(), [&](const SolidHoles& other) {
                             return is_same(other.diameter, kind.diameter);
                         }) == 1;
        }
        const auto rank = [&](const SolidHoles& kind) {
            return std::tuple{kind.way == HoleWay::kLeft,
                              tools_[kind.tool].shape == name_of(toolpath::ToolShape::kDrill),
                              -kind.greatest_top, kind.tool};
        };
        std::stable_sort(kinds.begin(), kinds.end(), [&](const SolidHoles& a, const SolidHoles& b) {
            return rank(a) < rank(b);
        });
        return kinds;
    }

private:
    static bool is_same(double a, double b) { return std::abs(a - b) <= kSameDiameter; }

    // One operation makes both: of their diameter all that begin between them.
    static bool joins(const SolidHoles& hole, const SolidHoles& kind)
    {
        const bool one_way = hole.way == kind.way && hole.tool == kind.tool;
        return is_same(hole.diameter, kind.diameter) &&
               (std::abs(hole.greatest_top - kind.least_top) <= kSameStep ||
                (one_way && std::abs(hole.begins - kind.begins) <= kSameStep));
    }

    bool is_step(const Hole& hole) const
    {
        return std::any_of(found_.holes.begin(), found_.holes.end(),
                           [&](const Hole& other) { return stands_on(other, hole); });
    }

    static bool stands_on(const Hole& narrow, const Hole& wide)
    {
        return norm(narrow.at - wide.at) <= kSameStep &&
               narrow.diameter < wide.diameter - kSameStep &&
               narrow.span->top <= wide.span->bottom + kSameStep;
    }

    SolidHoles alone(std::size_t place) const
    {
        const Hole& hole = found_.holes[place];
        const Choice chosen = choice(hole);
        return {hole.diameter, begin_of(place), hole.span->top, hole.span->top,
                false,         chosen.way,      chosen.tool,    {hole}};
    }

    // z of what stands around it: a step over it that is made by then, or the ground.
    double begin_of(std::size_t place) const
    {
        const Hole& hole = found_.holes[place];
        for (std::size_t k = 0; k < found_.holes.size(); ++k) {
            const Hole& wide = found_.holes[k];
            if (stands_on(hole, wide) &&
                std::abs(hole.span->top - wide.span->bottom) <= kSameStep) {
                return choice(wide).way == HoleWay::kLeft ? begin_of(k) : wide.span->bottom;
            }
        }
        const auto& cone = found_.cones[place];
        return ground_(hole, hole.span->top + (cone ? cone->depth : 0.0));
    }

    Choice choice(const Hole& hole) const
    {
        const bool step = is_step(hole);
        Choice bored;
        double widest = 0;
        std::optional<std::size_t> flat;
        for (std::size_t k = 0; k < tools_.size(); ++k) {
            const double across = tools_[k].diameter * unit_;
            const bool fits = is_same(across, hole.diameter);
            const bool is_flat = tools_[k].shape == "flat";
            if (fits && !step && tools_[k].shape == name_of(toolpath::ToolShape::kDrill)) {
                return {HoleWay::kDrilled, k};
            }
            if (fits && is_flat) {
                flat = k;
            }
            // of those with room the widest, else the narrowest
            const bool has_room = across <= kRoomToMove * hole.diameter;
            const double rank = has_room ? across : -across;
            if (is_flat && !fits && across < hole.diameter &&
                (bored.way == HoleWay::kLeft || rank > widest)) {
                bored = {HoleWay::kBored, k};
                widest = rank;
            }
        }
        return flat ? Choice{HoleWay::kDrilled, *flat} : bored;
    }

    const CadHoles& found_;
    const std::vector<NamedTool>& tools_;
    double unit_;  // mm
    const GroundAround& ground_;
};

}  // namespace

std::vector<SolidHoles> solid_holes(const CadHoles& found,
                                    const std::vector<NamedTool>& tools,
                                    double unit,
                                    const GroundAround& ground)
{
    return HoleSorter{found, tools, unit, ground}.sorted();
}

}  // namespace cusp::import
