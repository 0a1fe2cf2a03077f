// One row a key.
#include "host_tools/job/import/one_line_keys.hpp"

#include <algorithm>
#include <type_traits>

#include "host_tools/job/import/placing.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

namespace {

constexpr const char* kLength = "LENGTH";
constexpr int kMostKinds = 1000;  // of drawings that are copied

using Request = OneLineRequest;
using Keys = std::vector<OneLineKey>;

Keys drawing_keys()
{
    constexpr OneLineUse kUse = OneLineUse::kDrawings;
    return {
        {"depth", &Request::depth, kLength,
         "of a drawing's outlines and holes, below the stock's top", kUse},
        {"layers",
         &Request::layers,
         "NAME=OPERATION",
         "NAME=OPERATION or NAME=OPERATION:DEPTH for a layer of a drawing: pocket, drill, engrave, "
         "v_carve, chamfer, profile, outside, inside, on, none; may be repeated",
         kUse,
         {},
         "--layer"},
        {"tabs", &Request::tabs, "TABS",
         "that hold a drawing's outlines: COUNT or COUNT:WIDTH:HEIGHT", kUse},
        {"side",
         &Request::side,
         "SIDE",
         "of a drawing's outlines: outside (the default), inside, on",
         kUse,
         {"outside", "inside", "on"}},
        {"join_gaps", &Request::join_gaps, kLength,
         "largest gap between lines of a drawing that is closed", kUse},
        {"sheet",
         &Request::sheet,
         "WIDTH,HEIGHT",
         "of the stock: the drawings are placed on it",
         kUse,
         {},
         nullptr,
         2,
         2},
        {"copies",
         &Request::copies,
         "COUNT,...",
         "of the drawings on the --sheet, turned and laid beside each other: all together, or of "
         "each",
         kUse,
         {},
         nullptr,
         1,
         kMostKinds},
        {"gap", &Request::gap, kLength,
         "between copies and to the sheet's edges; default: 1.5 diameters of the first tool", kUse},
    };
}

Keys placing_keys()
{
    const Keys keys{
        {"width", &Request::width, kLength, "of a picture (.png), which is a relief",
         OneLineUse::kSurfaces},
        {"heights",
         &Request::heights,
         "BLACK,WHITE",
         "z of a picture's black and of its white",
         OneLineUse::kSurfaces,
         {},
         nullptr,
         2,
         2},
        {"scale", &Request::scale, "FACTOR", "of the parts, such as 25.4"},
        {"up", &Request::up, "AXIS",
         "the file's axis that points up: +x, +y, +z; --up=-y for one that points down",
         OneLineUse::kSurfaces, kUpAxes},
        {"rotate",
         &Request::rotate,
         "DEGREES",
         "degrees about z, or about x,y,z; after --up",
         OneLineUse::kAny,
         {},
         nullptr,
         1,
         3},
        {"origin", &Request::origin, "PLACE",
         "corner, centre, top: the point of the part at 0; its top is z = 0 with each",
         OneLineUse::kAny, kOrigins},
        {"move",
         &Request::move,
         "X,Y,Z",
         "by x,y,z, after --origin",
         OneLineUse::kAny,
         {},
         nullptr,
         3,
         3},
    };
    return keys;
}

Keys cutting_keys()
{
    return {
        {"boundary", &Request::boundary, "LOOP",
         "loop round a pocket (.json, .dxf, plate.dxf#layer)", OneLineUse::kSurfaces},
        {"islands",
         &Request::islands,
         "LOOP",
         "loop of an island in the pocket; may be repeated",
         OneLineUse::kSurfaces,
         {},
         "--island"},
        {"material", &Request::material, "NAME",
         "feeds and speeds by a maker's table: aluminium, brass, steel, acrylic, plywood, mdf, "
         "softwood, hardwood, or a file .toml"},
        {"feed", &Request::feed, "FEED", "length a minute; default 200 diameters, at most 1200 mm"},
        {"plunge_feed", &Request::plunge_feed, "FEED", "default: a quarter of the feed"},
        {"spindle", &Request::spindle, "RPM", "default 12000"},
        {"max_depth", &Request::max_depth, kLength,
         "of a roughing layer; default: half the diameter"},
        {"allowance", &Request::allowance, kLength,
         "stock that roughing leaves; default: 0.05 diameters, at most 0.3 mm"},
        {"tolerance", &Request::tolerance, kLength, "default: half the scallop, at most 0.01 mm",
         OneLineUse::kSurfaces},
        {"stock_top", &Request::stock_top, kLength, "z; default: the part's top"},
        {"clearance", &Request::clearance, kLength,
         "height of rapid moves above the stock; default 5 mm"},
    };
}

Keys path_keys(const job::Strategies& strategies)
{
    std::vector<std::string> names;
    for (const job::Strategy* const strategy : strategies) {
        if (strategy->traits.one_line) {
            names.push_back(strategy->name);
        }
    }
    return {
        {"strategy", &Request::strategy, "NAME",
         fmt::format("{}; pockets need --boundary", fmt::join(names, ", ")), OneLineUse::kSurfaces,
         names},
        {"moves",
         &Request::output,
         "NAME",
         "lines, arcs or nurbs",
         OneLineUse::kAny,
         {"lines", "arcs", "nurbs"}},
    };
}

}  // namespace

std::string option_of(const OneLineKey& key)
{
    if (key.option != nullptr) {
        return key.option;
    }
    std::string option = fmt::format("--{}", key.name);
    std::replace(option.begin(), option.end(), '_', '-');
    return option;
}

bool is_given(const OneLineRequest& request, const OneLineKey& key)
{
    const auto has_value = [&](const auto place) {
        const auto& value = request.*place;
        if constexpr (std::is_same_v<decltype(value), const std::optional<double>&> ||
                      std::is_same_v<decltype(value), const std::optional<std::string>&>) {
            return value.has_value();
        } else {
            return !value.empty();
        }
    };
    return std::visit(has_value, key.place);
}

std::vector<OneLineKey> one_line_keys(const job::Strategies& strategies)
{
    Keys all{
        {"tools",
         &Request::tools,
         "SHAPE:DIAMETER ...",
         "ball:6, flat:8, bull:10:1.5, taper:6:5:0.5, drill:5, vee:6:60, vee:3:30:0.1: the last "
         "finishes",
         OneLineUse::kAny,
         {},
         "--tool"},
        {"scallop", &Request::scallop, kLength,
         "height of the scallops that may remain, tolerance included", OneLineUse::kSurfaces},
    };
    for (const Keys& more :
         {drawing_keys(), cutting_keys(), placing_keys(), path_keys(strategies)}) {
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

}  // namespace cusp::import
