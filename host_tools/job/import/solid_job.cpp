// The survey of the solid says which bands of heights are cut, and how.
#include "host_tools/job/import/solid_job.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "firmware/base/inch.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/cleared_ground.hpp"
#include "host_tools/job/import/drawing_choice.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/one_line_check.hpp"
#include "host_tools/job/import/one_line_text.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/sheet_layers.hpp"
#include "host_tools/job/import/sheet_tools.hpp"
#include "host_tools/job/import/solid_chamfers.hpp"
#include "host_tools/job/import/solid_edges.hpp"
#include "host_tools/job/import/solid_ground.hpp"
#include "host_tools/job/import/solid_holes.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::Hole;
using job::Region;

namespace {

constexpr double kLeastSlant = 0.05;  // mm^2
constexpr double kLeastUncut = 1.0;   // mm^2
constexpr double kLeastLeft = 0.5;    // mm of edges
constexpr double kPeckFrom = 3;       // diameters
constexpr std::array<const char*, 3> kFinishing{"ball", "bull", "taper"};

bool has_shape(const OneLineRequest& request, const char* shape)
{
    return std::any_of(request.tools.begin(), request.tools.end(), [&](const std::string& text) {
        return text.rfind(std::string{shape} + ":", 0) == 0;
    });
}

// Down along a hole's wall, in steps from its middle.
const job::Strategy& boring_strategy(const job::Strategies& strategies)
{
    return **std::find_if(strategies.begin(), strategies.end(), [](const job::Strategy* one) {
        return one->traits.region == Region::kHoles &&
               find_key(keys_of(*one), "step_over") != nullptr;
    });
}

class SolidCutter {
public:
    SolidCutter(const OneLineRequest& request,
                const OneLineChoice& choice,
                const job::Strategies& strategies,
                PartFiles& parts)
        : request_{request},
          choice_{choice},
          strategies_{strategies},
          tools_{request, choice},
          unit_{request.inch ? kMillimetresPerInch : 1.0},
          file_{request.parts.front()},
          parts_{parts}
    {
        for (std::size_t k = 0; k < choice.tools.size(); ++k) {
            if (choice.tools[k].shape == "flat") {
                flats_.push_back(k);
            }
        }
    }

    SolidCuts cuts()
    {
        const CadHoles found = is_cad_file(file_) ? parts_.cad_holes(file_) : CadHoles{};
        const std::vector<Hole> mouths = mouths_of(found);
        has_holes_ = !found.holes.empty();
        const Triangles& facets = parts_.facets(file_, unit_);
        const std::vector<SolidChamfer> chamfers = solid_chamfers(facets, choice_.tools, unit_);
        const SolidGround ground =
            ground_of_solid(facets, found.holes, mouths, cut_by_vees(chamfers));
        const Vec3d size = ground.box.size();
        check_shapes(request_, choice_.tools, {number(size.x), number(size.y)});
        const bool slants = ground.slanted > kLeastSlant;
        const bool has_ball = !finishing_end().empty();
        // A ball, a bull or a taper finishes slanted ground, and a part of which nothing is below its top;
        // without one the last flat end finishes slanted ground to a scallop.
        const bool flat_finishes = slants && !has_ball && request_.scallop && !flats_.empty();
        cuts_.is_all = !flat_finishes && !(has_ball && (slants || ground.openings.empty()));
        if (cuts_.is_all && flats_.empty()) {
            throw InputError(
                "--tool: level ground and upright walls need a flat end: add one, such as --tool "
                "flat:6");
        }
        top_ = request_.stock_top.value_or(number(ground.box.high.z));
        if (top_ * unit_ < ground.box.high.z - kSameDiameter) {
            throw InputError(fmt::format("--stock-top: is {:g} {}, but {} rises to z = {:.6g}",
                                         top_, choice_.unit, file_, number(ground.box.high.z)));
        }
        if (cuts_.is_all) {
            say_part(ground);
            add_face(ground);
        }
        const ClearedGround levels = cleared(facets, mouths, ground);
        if (!cuts_.is_all) {
            cuts_.before += hole_operations(found, levels, ground);
        }
        for (const SolidBand& band : cuts_.is_all ? ground.openings : ground.walls) {
            if (cuts_.is_all) {
                add_band(Region::kLevelPocket, "below", band);
            } else if (!flats_.empty() &&
                       choice_.tools[flats_.back()].diameter * unit_ / 2 < band.widest) {
                add_band(Region::kOutline, "above", band);
            }
        }
        if (cuts_.is_all) {
            cuts_.after += hole_operations(found, levels, ground);
        }
        add_chamfers(chamfers, found, levels);
        if (cuts_.is_all && cuts_.before.empty() && cuts_.after.empty()) {
            throw InputError(fmt::format(
                "{}: a flat end has nothing to cut: {:.4g} mm2 of slanted ground need a ball, such "
                "as --tool {} ball:4 --scallop 0.05",
                file_, ground.slanted, request_.tools.front()));
        }
        say_ground(ground, slants, has_ball);
        return std::move(cuts_);
    }

private:
    // In the unit of the job, without the noise of a conversion.
    double number(double millimetres) const
    {
        return std::round(millimetres / unit_ * 1e6) / 1e6 + 0.0;
    }
    // mm
    double across(std::size_t tool) const { return choice_.tools[tool].diameter * unit_; }
    std::string tool_words(std::size_t tool) const
    {
        return words_of(choice_.tools[tool], request_.inch);
    }
    std::string operation(Region region, const std::string& boundary) const
    {
        return fmt::format(
            "\n[[operation]]\nstrategy = \"{}\"\n{}", strategy_for(region, strategies_).name,
            boundary.empty() ? "" : fmt::format("boundary = {}\n", quoted(boundary)));
    }

    // The shape of a tool of the call that finishes slanted ground; empty: there is none.
    std::string finishing_end() const
    {
        const auto found =
            std::find_if(kFinishing.begin(), kFinishing.end(),
                         [&](const char* shape) { return has_shape(request_, shape); });
        return found == kFinishing.end() ? "" : *found;
    }

    std::string finishing_words() const
    {
        const std::string shape = finishing_end();
        return shape.empty() ? tool_words(flats_.back()) : shape;
    }

    void add_face(const SolidGround& ground)
    {
        const double above = top_ - number(ground.box.high.z);
        if (above * unit_ <= kSameDiameter) {
            return;
        }
        const std::size_t tool = flats_.front();
        faces_ = true;
        cuts_.before += operation(Region::kTop, "") +
                        fmt::format("tool = {}\ndepth = {}\nmax_depth = {}\n", tool + 1,
                                    number(above * unit_), tools_.step_of(tool));
        cuts_.said.push_back(
            fmt::format("top: face, {}, {:.6g} {} deep", tool_words(tool), above, choice_.unit));
    }

    bool flats_clear() const { return cuts_.is_all && !flats_.empty(); }

    ClearedGround cleared(const Triangles& facets,
                          const std::vector<Hole>& mouths,
                          const SolidGround& ground) const
    {
        return {facets, mouths, flats_clear() ? ground : SolidGround{},
                flats_clear() ? across(flats_.back()) / 2 : 0.0};
    }

    // A ball finishes before holes are cleared down to their ground: they begin at the stock's top then.
    std::string hole_operations(const CadHoles& found,
                                const ClearedGround& levels,
                                const SolidGround& ground)
    {
        const double top = std::max(top_ * unit_, ground.box.high.z);
        const GroundAround around = [&](const Hole& hole, double height) {
            return flats_clear() ? levels.around(hole, height) : top;
        };
        std::string text;
        for (const SolidHoles& holes : solid_holes(found, choice_.tools, unit_, around)) {
            if (holes.way == HoleWay::kLeft) {
                say_left(holes);
            } else {
                text += hole_operation(holes);
            }
        }
        return text;
    }

    std::string hole_operation(const SolidHoles& holes)
    {
        const bool bored = holes.way == HoleWay::kBored;
        const job::Strategy& strategy =
            bored ? boring_strategy(strategies_) : strategy_for(Region::kHoles, strategies_);
        const std::string chosen =
            holes.alone ? file_
                        : fmt::format("{}#holes:{}:{}", file_, number(holes.least_top),
                                      number(holes.greatest_top));
        std::string text = fmt::format(
            "\n[[operation]]\nstrategy = \"{}\"\nboundary = {}\ntool = {}\ndiameter = {}\n"
            "top = {}\n",
            strategy.name, quoted(chosen), holes.tool + 1, number(holes.diameter),
            number(holes.begins));
        double deepest = 0;
        std::size_t through = 0;
        for (const Hole& hole : holes.holes) {
            deepest = std::max(deepest, holes.begins - hole.span->bottom);
            through += hole.span->through ? 1U : 0U;
        }
        if (bored) {
            text += fmt::format("output = \"{}\"\n", request_.output);
        } else if (deepest > kPeckFrom * across(holes.tool)) {
            text += fmt::format("peck = {}\n", choice_.tools[holes.tool].diameter);
        }
        cuts_.said.push_back(fmt::format("{} of {:.6g} {}, {} through: {}, {}",
                                         counted(holes.holes.size(), "hole"),
                                         number(holes.diameter), choice_.unit,
                                         through == holes.holes.size() ? "all"
                                         : through == 0                ? "none"
                                                                       : std::to_string(through),
                                         strategy.name, tool_words(holes.tool)));
        return text;
    }

    void say_left(const SolidHoles& holes)
    {
        constexpr std::size_t kPlaces = 4;
        std::vector<std::string> places;
        for (std::size_t k = 0; k < std::min(kPlaces, holes.holes.size()); ++k) {
            const Vec2d at = holes.holes[k].at;
            places.push_back(fmt::format("x {:.6g} y {:.6g}", number(at.x), number(at.y)));
        }
        const std::size_t more = holes.holes.size() - places.size();
        const double diameter = number(holes.diameter);
        const bool one = holes.holes.size() == 1;
        cuts_.said.push_back(fmt::format(
            "{} of {:.6g} {}: {}, at {}{}: no drill has {} diameter and no flat end is narrower; "
            "--tool drill:{:.6g} drills {}",
            counted(holes.holes.size(), "hole"), diameter, choice_.unit,
            cuts_.is_all ? one ? "stays" : "stay" : "left to the " + finishing_words(),
            fmt::join(places, ", "), more > 0 ? fmt::format(" and {} more places", more) : "",
            one ? "its" : "their", diameter, one ? "it" : "them"));
    }

    void add_chamfers(const std::vector<SolidChamfer>& chamfers,
                      const CadHoles& found,
                      const ClearedGround& levels)
    {
        for (const SolidChamfer& chamfer : chamfers) {
            const auto sunk = chamfer.sink ? sunk_holes(chamfer, found) : std::nullopt;
            if (sunk && levels.is_open(chamfer.sink->near, chamfer.band.high)) {
                add_countersinks(chamfer, *sunk);
            } else {
                add_chamfer(chamfer, levels);
            }
        }
        say_idle_vees();
    }

    // After all others: only then is the ground around it open.
    void add_chamfer(const SolidChamfer& chamfer, const ClearedGround& levels)
    {
        const EdgeBand& band = chamfer.band;
        if (!chamfer.tool || !levels.is_open(chamfer.near, band.high)) {
            say_chamfer_left(chamfer, chamfer.tool ? ChamferFault::kStockBeside : chamfer.fault);
            return;
        }
        const std::size_t tool = *chamfer.tool;
        vees_at_work_.insert(tool);
        const std::string edges = fmt::format("{}#edges:{}:{}:{}", file_, number(band.low),
                                              number(band.high), number(band.width));
        const std::string keys = fmt::format("tool = {}\ntop = {}\noutput = \"{}\"\n", tool + 1,
                                             number(band.high), request_.output);
        if (!chamfer.ways) {
            cuts_.after += operation(Region::kEdges, edges) + keys +
                           fmt::format("width = {}\n", number(band.width));
            cuts_.said.push_back(
                fmt::format("{}: chamfer, {}", edge_words(chamfer), tool_words(tool)));
            return;
        }
        cuts_.after += operation(Region::kGrooves, edges) + keys +
                       fmt::format("depth = {}\n", number(chamfer.depth()));
        std::string left;
        if (chamfer.all.length - chamfer.ways->broken > kLeastLeft) {
            left = fmt::format(
                "; the rest {}, such as at x {:.6g} y {:.6g}: the vee would gouge the part beside "
                "it",
                cuts_.is_all ? "stays" : "is left to the " + finishing_words(),
                number(chamfer.ways->left_at.x), number(chamfer.ways->left_at.y));
        }
        cuts_.said.push_back(fmt::format("{}: {:.4g} {} of {:.4g} broken, {}{}",
                                         edge_words(chamfer), number(chamfer.ways->broken),
                                         choice_.unit, number(chamfer.all.length), tool_words(tool),
                                         left));
    }

    // Down in the middle of round mouths.
    void add_countersinks(const SolidChamfer& chamfer, const SunkHoles& sunk)
    {
        const SolidChamfer::Sink& sink = *chamfer.sink;
        const double foot = number(chamfer.band.low);
        vees_at_work_.insert(sink.tool);
        cuts_.after += operation(Region::kHoles, fmt::format("{}#holes:{}:{}", file_, foot, foot)) +
                       fmt::format("tool = {}\ndiameter = {:.6g}\ntop = {}\ncountersink = {:.6g}\n",
                                   sink.tool + 1, number(sunk.diameter), number(chamfer.band.high),
                                   number(sunk.mouth));
        cuts_.said.push_back(fmt::format("{}: countersink {:.6g} {}, {}", edge_words(chamfer),
                                         number(sunk.mouth), choice_.unit, tool_words(sink.tool)));
    }

    // "2 edges at z 12, 1 mm wide".
    std::string edge_words(const SolidChamfer& chamfer) const
    {
        return fmt::format("{} at z {:.6g}, {:.4g} {} wide", counted(chamfer.all.count, "edge"),
                           number(chamfer.band.high), number(chamfer.band.width), choice_.unit);
    }

    void say_chamfer_left(const SolidChamfer& chamfer, ChamferFault fault)
    {
        const Vec2d at = chamfer.all.place;
        cuts_.said.push_back(
            fmt::format("{}: {}, such as at x {:.6g} y {:.6g}: {}", edge_words(chamfer),
                        cuts_.is_all ? "stay" : "left to the " + finishing_words(), number(at.x),
                        number(at.y), words_of(chamfer, fault, request_.inch)));
    }

    void say_idle_vees()
    {
        for (std::size_t k = 0; k < choice_.tools.size(); ++k) {
            if (choice_.tools[k].shape == name_of(toolpath::ToolShape::kVee) &&
                vees_at_work_.count(k) == 0) {
                cuts_.said.push_back(tool_words(k) + " is not used: it fits no edge of the part");
            }
        }
    }

    // Down to a band's bottom: what the part's box has beside it is cleared, or its walls are finished.
    void add_band(Region region, const char* part, const SolidBand& band)
    {
        const double bottom = number(band.bottom);
        const double top = number(band.top);
        const double depth = number(band.top - band.bottom);
        const std::size_t tool = flats_.back();
        const double across = choice_.tools[tool].diameter;
        const double step = request_.max_depth.value_or(across);
        std::string keys =
            fmt::format("tool = {}\ntop = {}\ndepth = {}\nmax_depth = {}\noutput = \"{}\"\n",
                        tool + 1, top, depth, step, request_.output);
        const bool clears = region == Region::kLevelPocket;
        if (clears) {
            keys += "clearing = \"adaptive\"\n";
        } else if (band.fills_box) {
            keys += "loops = \"inner\"\nside = \"inside\"\n";
        }
        cuts_.after += operation(region, fmt::format("{}#{}:{}{}", file_, part, bottom,
                                                     has_holes_ ? ":no_holes" : "")) +
                       keys;
        cuts_.said.push_back(
            fmt::format("z {:.6g} to {:.6g}: {}, {}{}", top, bottom,
                        clears ? "cleared" : "along the upright walls", tool_words(tool),
                        step < depth ? fmt::format(", cuts of at most {:.6g}", step) : ""));
        needs_box_ = true;
    }

    void say_part(const SolidGround& ground)
    {
        const PartExtent& box = ground.box;
        cuts_.said.push_back(fmt::format(
            "part: {:.6g} x {:.6g} {} from above, {:.6g} deep; {}", number(box.size().x),
            number(box.size().y), choice_.unit, number(box.size().z),
            lacks_unit(file_)
                ? fmt::format("the file names no unit, {} is assumed (--units)", choice_.unit)
                : "the unit is the file's own"));
        cuts_.said.push_back(fmt::format(
            "stock: x {:.6g} to {:.6g}, y {:.6g} to {:.6g}, top z = {:.6g}{}; cut down to z = "
            "{:.6g}",
            number(box.low.x), number(box.high.x), number(box.low.y), number(box.high.y), top_,
            request_.stock_top ? "" : " (the part's; --stock-top)", number(box.low.z)));
        cuts_.said.push_back(said_feeds(request_, choice_));
    }

    void say_ground(const SolidGround& ground, bool slants, bool has_ball)
    {
        if (needs_box_) {
            const PartExtent& box = ground.box;
            cuts_.stock = fmt::format("x = [{}, {}]\ny = [{}, {}]\n", number(box.low.x),
                                      number(box.high.x), number(box.low.y), number(box.high.y));
        }
        if (cuts_.is_all) {
            cuts_.stock = fmt::format("top = {}\nbottom = {}\n", top_, number(ground.box.low.z)) +
                          cuts_.stock;
        }
        if (!cuts_.is_all && ground.wall > kLeastUncut && !flats_.empty()) {
            cuts_.said.push_back(
                fmt::format("{:.4g} mm2 of upright walls keep the allowance: they stand on slanted "
                            "ground, where "
                            "strategy = \"waterline\" finishes them",
                            ground.wall));
        }
        if (slants && cuts_.is_all) {
            cuts_.said.push_back(fmt::format(
                "slanted ground stays, {:.4g} mm2 seen from above, such as at x {:.6g} y {:.6g} z "
                "{:.6g}: a ball in --tool finishes it, or the last flat end with --scallop",
                ground.slanted, number(ground.slanted_at.x), number(ground.slanted_at.y),
                number(ground.slanted_at.z)));
        }
        for (const std::size_t flat : flats_) {
            const bool faces = flat == flats_.front() && faces_;
            if (cuts_.is_all && flat != flats_.back() && !faces) {
                cuts_.said.push_back(tool_words(flat) +
                                     " is not used: the last flat end clears alone");
            }
        }
        if (!slants && has_ball) {
            cuts_.said.push_back(
                fmt::format("all ground is level: the {} is not used", finishing_end()));
        }
    }

    const OneLineRequest& request_;
    const OneLineChoice& choice_;
    const job::Strategies& strategies_;
    SheetTools tools_;
    double unit_;  // mm
    const std::string& file_;
    PartFiles& parts_;
    std::vector<std::size_t> flats_;  // places in the call
    double top_{};                    // of the stock, in the unit of the job
    bool has_holes_{};
    bool faces_{};
    bool needs_box_{};
    std::set<std::size_t> vees_at_work_;  // places in the call
    SolidCuts cuts_;
};

}  // namespace

bool is_solid_request(const OneLineRequest& request)
{
    const bool is_solid = request.parts.size() == 1 && (is_cad_file(request.parts.front()) ||
                                                        is_mesh_file(request.parts.front()));
    return is_solid && !request.boundary && request.islands.empty() && request.strategy.empty() &&
           request.roughing &&
           (has_shape(request, "flat") || has_shape(request, name_of(toolpath::ToolShape::kDrill)));
}

SolidCuts solid_cuts(const OneLineRequest& request,
                     const OneLineChoice& choice,
                     const job::Strategies& strategies,
                     PartFiles& parts)
{
    return SolidCutter{request, choice, strategies, parts}.cuts();
}

}  // namespace cusp::import
