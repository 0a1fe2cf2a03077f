// One row a key.
#include "host_tools/job/job/operation_keys.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace cusp::job {
namespace {

using Kind = KeyKind;

// Keys of parts, tolerances and levels.
const std::vector<Key>& part_keys()
{
    static const std::vector<Key> kKeys{
        {"floor", Kind::kFiles, "needed",
         "files of surfaces, together the part: nothing is cut below any of them"},
        {"intersect", Kind::kFiles, "none",
         "files of more bodies: the part is what lies below the floor and below each of them"},
        {"islands", Kind::kFiles, "none", "files of closed loops that stay"},
        choice("output", {"lines", "arcs", "nurbs"},
               "`\"lines\"` (G1), `\"arcs\"` (G2, G3 too), `\"nurbs\"` (G6.2 too)"),
        {"scallop", Kind::kLength, "see strategies",
         "most that may be left where the tool reaches, square to the surface, tolerance included",
         kToleranceRange},
        {"join_gaps", Kind::kLength, "see below",
         "largest gap between ends of curves of a drawing that is closed (Loops of a drawing, "
         "below); 0.001 mm at least",
         kNotNegative},
        choice("tolerance_side", {"outside", "both"},
               "never below the surface nor through a wall; `\"both\"`: half the tolerance to "
               "either side"),
        choice("direction_of_cut", {"climb", "conventional"},
               "side of the tool that is in the material"),
        choice("entry", {"auto", "helix", "ramp", "plunge"},
               "into pockets; auto takes the first of helix, ramp and plunge that has room"),
        choice("traversal", {"zigzag", "one_way"}, "of neighbouring passes"),
        choice("relief", {"none", "dogbone", "t_bone"},
               "of inner corners between straight sides, so that square corners fit: "
               "`\"dogbone\"` into the corner, `\"t_bone\"` along its longer side"),
        {"allowance", Kind::kLength, "0", "what roughing leaves on the floor and the walls",
         kNotNegative},
        {"max_depth", Kind::kLength, "none",
         "deepest cut of a layer; with it pockets are cut in layers", kPositive},
        {"min_depth", Kind::kLength, "none", "thinnest layer", kNotNegative},
        {"layers", Kind::kLengths, "none",
         "depths of layers below the stock's top, in place of equal ones", kPositive},
    };
    return kKeys;
}

Key of_text(const Key& key) { return key.needing({"text"}); }

// Keys that spell a text in place of a drawing.
const std::vector<Key>& text_keys()
{
    static const std::vector<Key> kKeys{
        Key{"text", Kind::kText, "none",
            "letters in place of `boundary`; a line break begins another line (Text, below)"}
            .needing({"size"})
            .excluding({"boundary"}),
        of_text({"font", Kind::kText, "single lines",
                 "of `text`: file of a font (.ttf, .otf), or a font's name such as "
                 "`\"DejaVuSans-Bold\"`"}),
        of_text({"size", Kind::kLength, "with `text`: needed", "of `text`: height of its capitals",
                 kPositive}),
        of_text({"at", Kind::kTwo, "[0, 0]",
                 "of `text`: place of its first baseline, as `align` says"}),
        of_text(choice("align", {"left", "centre", "right"},
                       "of `text`: the point of a line that is at `at`")),
        of_text({"angle",
                 Kind::kAngle,
                 "0",
                 "of `text`: its baseline, counter-clockwise from x",
                 {-360, 360}}),
        of_text({"arc", Kind::kLength, "none",
                 "of `text`: radius of the circle through `at` that it follows; its centre is "
                 "below the letters, with a negative radius above them"}),
    };
    return kKeys;
}

// Keys of tools, passes and rates.
const std::vector<Key>& pass_keys()
{
    static const std::vector<Key> kKeys{
        {"tools", Kind::kTools, "the tool",
         "numbers or names of roughing tools; the largest first cuts what it can", kToolNumber},
        {"step_over", Kind::kLength, "the tool's", "the most between passes", kPositive},
        choice("clearing", {"contour", "adaptive"},
               "or `\"adaptive\"`: passes of bounded engagement (`docs/strategies.md`)"),
        Key{"max_engagement",
            Kind::kAngle,
            "60",
            "with `\"adaptive\"`: degrees of the tool's circumference in stock; in pockets a "
            "`step_over` is the width of a straight cut, and the stricter counts",
            {20, 150}}
            .needing({"clearing = \"adaptive\""}),
        {
            "chip_load",
            Kind::kFlag,
            "false",
            "the feed follows the engagement (`docs/strategies.md`); of flat ends",
        },
        Key{"feed_min", Kind::kRate, "the feed", "with `chip_load`: least F word", kFeedRange}
            .needing({"chip_load = true"}),
        Key{"feed_max", Kind::kRate, "twice the feed", "with `chip_load`: largest F word",
            kFeedRange}
            .needing({"chip_load = true"}),
        {"roughing", Kind::kFlag, "false", "rough in levels of `max_depth` before the finish"},
        {"depth", Kind::kLength, "needed", "below `top`: of the floor, or of the tool's tip",
         kPositive},
        {"top", Kind::kLength, "where the last `face` ended, else the stock's top",
         "z at which the operation begins"},
        {"drawing_layers", Kind::kTexts, "all",
         "layers of `boundary` that count, together; in place of `#layer`"},
        choice("loops", {"all", "outer", "inner", "open"},
               "or those in no other one, those in others by themselves, open lines alone "
               "(`engrave`)"),
        {"except_diameters", Kind::kLengths, "none",
         "circles of these diameters are left to other operations", kPositive},
        {"may_open", Kind::kFlag, "false",
         "its cut may open into that of the other side (Set-ups, below)"},
    };
    return kKeys;
}

}  // namespace

Key choice(const std::string& name,
           const std::vector<std::string>& choices,
           const std::string& help,
           const std::string& otherwise)
{
    return {name, Kind::kChoice, otherwise.empty() ? choices.front() : otherwise,
            help, kAnyNumber,    choices};
}

Key table(const std::string& name,
          const KeyTable& (*members)(),
          const std::string& otherwise,
          const std::string& help)
{
    return {name, Kind::kTable, otherwise, help, kAnyNumber, {}, members};
}

Key tables(const std::string& name,
           const KeyTable& (*members)(),
           const std::string& otherwise,
           const std::string& help)
{
    return {name, Kind::kTables, otherwise, help, kAnyNumber, {}, members};
}

const std::vector<Key>& common_keys()
{
    static const std::vector<Key> kKeys{
        {"strategy", Kind::kText, "needed", "one of the strategies"},
        {"boundary", Kind::kText, "pockets and 2.5-D: needed",
         "file of closed loops or curves, such as `\"plate.dxf#outline\"`"},
        {"tool", Kind::kTool, "the first", "number or name of the tool", kToolNumber},
        {"setup", Kind::kText, "the first", "name of the set-up in which it is cut"},
        {"feed", Kind::kRate, "the tool's", "of this operation, for all its tools", kFeedRange},
        {"plunge_feed", Kind::kRate, "the tool's",
         "of this operation; a `feed` without it makes it a quarter of itself", kFeedRange},
        {"spindle", Kind::kNumber, "the tool's", "rpm, of this operation", kNotNegative},
        choice("coolant", {"off", "mist", "flood"}, "`\"mist\"` (M7), `\"flood\"` (M8)",
               "the tool's"),
        {"floor_tolerance", Kind::kLength, "0.02 mm", "of the path against the floor",
         kToleranceRange},
        {"plan_tolerance", Kind::kLength, "0.02 mm", "across walls, seen from above",
         kToleranceRange},
        {"after", Kind::kFiles, "none",
         "program, or list of programs, that were cut before this operation (Rest machining, "
         "below)"},
        {"rest_tolerance",
         Kind::kLength,
         "see below",
         "with `after` or the stock's `program`: stock that is thinner stays",
         {0.001, 1}},
    };
    return kKeys;
}

const Strategy kNoStrategy{};

std::vector<Key> shared_keys(const std::vector<std::string>& names)
{
    std::vector<Key> keys;
    for (const std::string& name : names) {
        const Key* key = nullptr;
        for (const std::vector<Key>* some : {&part_keys(), &pass_keys(), &text_keys()}) {
            key = key == nullptr ? find_key(*some, name) : key;
        }
        if (key == nullptr) {
            throw std::logic_error("no shared key " + name);
        }
        keys.push_back(*key);
    }
    return keys;
}

std::vector<std::string> with_text(std::vector<std::string> names)
{
    std::transform(text_keys().begin(), text_keys().end(), std::back_inserter(names),
                   [](const Key& key) { return key.name; });
    return names;
}

std::vector<Key> surface_keys(const std::vector<std::string>& names,
                              const std::vector<std::string>& left_out)
{
    std::vector<std::string> all{"floor",     "intersect", "islands",        "output",
                                 "scallop",   "join_gaps", "tolerance_side", "direction_of_cut",
                                 "entry",     "traversal", "allowance",      "max_depth",
                                 "min_depth", "layers",    "clearing",       "max_engagement",
                                 "chip_load", "feed_min",  "feed_max"};
    all.insert(all.end(), names.begin(), names.end());
    const auto is_left_out = [&](const std::string& name) {
        return std::find(left_out.begin(), left_out.end(), name) != left_out.end();
    };
    all.erase(std::remove_if(all.begin(), all.end(), is_left_out), all.end());
    return shared_keys(all);
}

std::vector<Key> finishing_keys()
{
    return surface_keys(
        {}, {"allowance", "max_depth", "min_depth", "layers", "clearing", "max_engagement"});
}

const KeyTable& tabs_table()
{
    static const KeyTable kTable{
        "tabs",
        "Bridges that hold a part while it is cut free.",
        {Key{"count", Kind::kCount, "this or `places`", "on each loop, evenly spaced", {1, 1000}}
             .excluding({"places"}),
         {"places", Kind::kLengths, "this or `count`", "`[x, y, x, y]`: each on the nearest loop"},
         {"width", Kind::kLength, "needed", "of the part at full height, along the loop",
          kPositive},
         {"height", Kind::kLength, "needed", "over the bottom of the cut; below its depth",
          kPositive},
         choice("shape", {"ramp", "square"},
                "slopes of 1 : 2 at both sides, or `\"square\"`: vertical ends")}};
    return kTable;
}

std::vector<Key> keys_of(const Strategy& strategy)
{
    std::vector<Key> keys;
    const auto add = [&](const std::vector<Key>& more) {
        std::copy_if(more.begin(), more.end(), std::back_inserter(keys),
                     [&](const Key& key) { return find_key(keys, key.name) == nullptr; });
    };
    add(strategy.own);  // first: its defaults count
    add(strategy.keys);
    add(common_keys());
    return keys;
}

std::vector<Key> all_keys(const Strategies& strategies)
{
    std::vector<Key> keys = common_keys();
    for (const Strategy* const strategy : strategies) {
        for (const Key& key : keys_of(*strategy)) {
            if (find_key(keys, key.name) == nullptr) {
                keys.push_back(key);
            }
        }
    }
    return keys;
}

Strategies strategies_with(const Strategies& strategies, const std::string& key)
{
    Strategies with;
    std::copy_if(
        strategies.begin(), strategies.end(), std::back_inserter(with),
        [&](const Strategy* strategy) { return find_key(keys_of(*strategy), key) != nullptr; });
    return with;
}

std::vector<std::string> names_of(const Strategies& strategies)
{
    std::vector<std::string> names;
    std::transform(strategies.begin(), strategies.end(), std::back_inserter(names),
                   [](const Strategy* strategy) { return strategy->name; });
    return names;
}

const Strategy* find_strategy(const Strategies& strategies, const std::string& name)
{
    const auto found = std::find_if(strategies.begin(), strategies.end(),
                                    [&](const Strategy* s) { return s->name == name; });
    return found == strategies.end() ? nullptr : *found;
}

}  // namespace cusp::job
