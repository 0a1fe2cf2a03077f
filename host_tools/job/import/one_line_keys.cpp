// One row a key.
#include "host_tools/job/import/one_line_keys.hpp"

#include <algorithm>

#include "host_tools/job/import/placing.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

namespace {

using Request = OneLineRequest;
using Keys = std::vector<OneLineKey>;

Keys drawing_keys()
{
    return {
        {"depth", &Request::depth, "", "of a drawing's outlines and holes, below the stock's top"},
        {"layers",
         &Request::layers,
         "NAME=OPERATION",
         "NAME=OPERATION or NAME=OPERATION:DEPTH for a layer of a drawing: pocket, drill, engrave, "
         "v_carve, chamfer, profile, outside, inside, on, none; may be repeated",
         {},
         "--layer"},
        {"tabs", &Request::tabs, "TABS",
         "that hold a drawing's outlines: COUNT or COUNT:WIDTH:HEIGHT"},
        {"side",
         &Request::side,
         "SIDE",
         "of a drawing's outlines: outside (the default), inside, on",
         {"outside", "inside", "on"}},
        {"join_gaps", &Request::join_gaps, "",
         "largest gap between lines of a drawing that is closed"},
    };
}

Keys placing_keys()
{
    const Keys keys{
        {"scale", &Request::scale, "", "of the parts, such as 25.4"},
        {"up", &Request::up, "AXIS",
         "the file's axis that points up: +x, +y, +z; --up=-y for one that points down", kUpAxes},
        {"rotate",
         &Request::rotate,
         "DEGREES",
         "degrees about z, or about x,y,z; after --up",
         {},
         nullptr,
         1,
         3},
        {"origin", &Request::origin, "PLACE",
         "corner, centre, top: the point of the part at 0; its top is z = 0 with each", kOrigins},
        {"move", &Request::move, "X,Y,Z", "by x,y,z, after --origin", {}, nullptr, 3, 3},
    };
    return keys;
}

Keys cutting_keys()
{
    return {
        {"boundary", &Request::boundary, "", "loop round a pocket (.json, .dxf, plate.dxf#layer)"},
        {"islands",
         &Request::islands,
         "",
         "loop of an island in the pocket; may be repeated",
         {},
         "--island"},
        {"material", &Request::material, "NAME",
         "feeds and speeds by a maker's table: aluminium, brass, steel, acrylic, plywood, mdf, "
         "softwood, hardwood, or a file .toml"},
        {"feed", &Request::feed, "FEED", "length a minute; default 200 diameters, at most 1200 mm"},
        {"plunge_feed", &Request::plunge_feed, "FEED", "default: a quarter of the feed"},
        {"spindle", &Request::spindle, "RPM", "default 12000"},
        {"max_depth", &Request::max_depth, "", "of a roughing layer; default: half the diameter"},
        {"allowance", &Request::allowance, "",
         "stock that roughing leaves; default: 0.05 diameters, at most 0.3 mm"},
        {"tolerance", &Request::tolerance, "", "default: half the scallop, at most 0.01 mm"},
        {"stock_top", &Request::stock_top, "", "z; default: the part's top"},
        {"clearance", &Request::clearance, "",
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
         fmt::format("{}; pockets need --boundary", fmt::join(names, ", ")), names},
        {"moves", &Request::output, "NAME", "lines, arcs or nurbs", {"lines", "arcs", "nurbs"}},
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

std::vector<OneLineKey> one_line_keys(const job::Strategies& strategies)
{
    Keys all{
        {"tools",
         &Request::tools,
         "SHAPE:DIAMETER ...",
         "ball:6, flat:8, bull:10:1.5, taper:6:5:0.5, drill:5, vee:6:60: the last finishes",
         {},
         "--tool"},
        {"scallop", &Request::scallop, "",
         "height of the scallops that may remain, tolerance included"},
    };
    for (const Keys& more :
         {drawing_keys(), cutting_keys(), placing_keys(), path_keys(strategies)}) {
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

}  // namespace cusp::import
