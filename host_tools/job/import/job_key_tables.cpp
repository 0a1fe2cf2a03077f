// One row a key.
#include "host_tools/job/import/job_key_tables.hpp"

#include "host_tools/job/job/operation_keys.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::choice;
using job::Key;
using job::KeyTable;
using job::kFeedRange;
using job::kNotNegative;
using job::kPositive;
using job::table;
using job::tables;
using Kind = job::KeyKind;

namespace {

void refuse_keys_of_others(const JobTable& table,
                           const job::Strategies& strategies,
                           const job::Strategy& strategy)
{
    constexpr std::size_t kFew = 6;  // more names don't help
    const std::vector<Key> known = job::keys_of(strategy);
    for (const Key& key : job::all_keys(strategies)) {
        if (!table.has(key.name.c_str()) || job::find_key(known, key.name) != nullptr) {
            continue;
        }
        const auto names = job::names_of(job::strategies_with(strategies, key.name));
        table.refuse(key.name.c_str(), names.size() > kFew
                                           ? fmt::format("is no key of {}", strategy.name)
                                           : fmt::format("is a key of {}, not of {}",
                                                         fmt::join(names, ", "), strategy.name));
    }
}

}  // namespace

const KeyTable& job_table()
{
    static const KeyTable kTable{
        "",
        "The file itself.",
        {choice("units", {"mm", "inch"},
                "of this file, of JSON, STL, OBJ and DXF parts without a unit of their own, and of "
                "the G-code (G20, G21)"),
         tables("tool", tool_table, "needed without `library`", "the tools"),
         {"library", Kind::kText, "none",
          "file of tools, `.toml`; or one that comes with the program: `\"wood\"`, `\"plastics\"`, "
          "`\"aluminium\"`"},
         table("cutting", cutting_table, "needed, unless all tools have a feed",
               "rates of tools without their own"),
         table("stock", stock_table, "none", "what is cut from"),
         tables("placing", placing_table, "none", "how files of parts and drawings lie"),
         tables("fixture", fixture_table, "none", "what holds the stock"),
         {"post", Kind::kText, "cusp",
          "the controller to write for: `\"grbl\"`, `\"grblhal\"`, `\"linuxcnc\"`, `\"mach3\"`, "
          "`\"fanuc\"`, or a file `.toml` (`docs/posts.md`)"},
         {"machine", Kind::kText, "none",
          "file `.toml` of the machine that it is cut on: limits of feeds, spindle and travel, and "
          "the default of "
          "`post` (`docs/posts.md`)"},
         {"material", Kind::kText, "none",
          "feeds and speeds of tools that have none: `\"aluminium\"`, `\"brass\"`, `\"steel\"`, "
          "`\"acrylic\"`, `\"plywood\"`, `\"mdf\"`, `\"softwood\"`, `\"hardwood\"`, or a file "
          "`.toml` "
          "(`docs/strategies.md`)"},
         {"operation", Kind::kTables, "needed", "what is cut, in order"},
         {"group_by_tool", Kind::kFlag, "true",
          "operations whose cuts lie beside each other change places where that saves a change of "
          "tool; false: the order of the job"},
         tables("setup", setup_table, "none", "how the stock is clamped, time after time")}};
    return kTable;
}

const KeyTable& library_table()
{
    static const KeyTable kTable{
        "library",
        "A file of tools.",
        {choice("units", {"mm", "inch"}, "of the library's lengths and feeds", "needed"),
         tables("tool", tool_table, "needed", "the tools; each has a `name`")}};
    return kTable;
}

const KeyTable& machine_table()
{
    static const KeyTable kTable{
        "machine",
        "A machine, a file of its own; all optional.",
        {choice("units", {"mm", "inch"}, "of lengths and rates in this file"),
         {"name", Kind::kText, "none", "for people"},
         {"settings", Kind::kText, "none",
          "file with what the controller (Grbl, grblHAL, `cusp`) prints for `$$`: $30, $31, $110 "
          "to "
          "$132 take the place of keys that are absent"},
         {"travel", Kind::kThree, "unknown", "`[x, y, z]`: of the axes", kPositive},
         {"max_rate", Kind::kThree, "unknown",
          "`[x, y, z]`, lengths a minute: feeds are at most the slower one of x and y, plunge "
          "feeds "
          "that of z",
          job::kFeedRange},
         {"acceleration", Kind::kThree, "unknown",
          "`[x, y, z]`, lengths a second and second: for the time that a program takes", kPositive},
         {"spindle", Kind::kNumbers, "unknown", "rpm, `[least, greatest]`; 0 is always allowed",
          kNotNegative},
         {"post", Kind::kText, "cusp", "of jobs that name none; a path is relative to this file"}}};
    return kTable;
}

const KeyTable& material_table()
{
    static const KeyTable kTable{
        "material",
        "A material, a file of its own.",
        {{"source", Kind::kText, "needed", "who gives the figures"},
         {"surface_speed", Kind::kNumber, "needed", "m/min, of mills", kPositive},
         {"chip", Kind::kPairs, "needed",
          "`[[diameter, chip], ...]`, mm, mm a tooth: of mills; between two diameters in "
          "proportion",
          kPositive},
         {"drill_speed", Kind::kNumber, "needed", "m/min, of drills", kPositive},
         {"drill_feed", Kind::kPairs, "needed", "`[[diameter, feed], ...]`, mm, mm a turn",
          kPositive}}};
    return kTable;
}

const KeyTable& tool_table()
{
    static const KeyTable kTable{
        "tool",
        "A tool; several are `[[tool]]`.",
        {{"number", Kind::kCount, "its place", "the T word", job::kToolNumber},
         choice("shape", {"ball", "flat", "bull", "vee", "drill", "taper"},
                "`\"taper\"`: a flat end or a ball under slanted flanks", "needed"),
         {"diameter", Kind::kLength, "needed", "of a taper at its upper end", kPositive},
         Key{"corner_radius", Kind::kLength, "bull: needed",
             "of a bull-nose end; of a taper that of a ball at its tip, in place of `tip_diameter`",
             kPositive}
             .excluding({"tip_diameter"}),
         {"tip_angle",
          Kind::kAngle,
          "vee: needed; drill: 118",
          "degrees between the flanks",
          {1, 179}},
         {"taper_angle",
          Kind::kAngle,
          "taper: needed",
          "degrees of the flank from the axis; `diameter` is that at its upper end",
          {0.1, 60}},
         {"tip_diameter", Kind::kLength, "vee: 0; taper: this or `corner_radius`",
          "of the flat at the tip", kNotNegative},
         {"name", Kind::kText, "none",
          "what operations may name it by, and the program's comments do"},
         {"flutes",
          Kind::kCount,
          "none",
          "number of teeth; for feeds of a `material` 2 without it",
          {1, 20}},
         {"flute_length", Kind::kLength, "none", "of the teeth, from the tip", kPositive},
         {"length", Kind::kLength, "none", "out of the holder, from the tip", kPositive},
         Key{"shank_diameter", Kind::kLength, "none",
             "of the shank above the flutes; needs `flute_length`", kPositive}
             .needing({"flute_length"}),
         Key{"holder", Kind::kPairs, "none",
             "`[[diameter, length], ...]`: cylinders from the holder's lower face up; needs "
             "`length`",
             kPositive}
             .needing({"length"}),
         Key{"holder_clearance", Kind::kLength, "0.5 mm",
             "that the shank and the holder keep to stock, to the sides and downward", kNotNegative}
             .needing({"shank_diameter", "holder"}),
         {"feed", Kind::kRate, "of `[cutting]`", "of this tool", kFeedRange},
         {"plunge_feed", Kind::kRate, "of `[cutting]`",
          "of this tool; a `feed` without it makes it a quarter of itself", kFeedRange},
         {"spindle", Kind::kNumber, "of `[cutting]`", "rpm, of this tool", kNotNegative},
         choice("coolant", {"off", "mist", "flood"}, "`\"mist\"` (M7), `\"flood\"` (M8)")}};
    return kTable;
}

const KeyTable& cutting_table()
{
    static const KeyTable kTable{"cutting",
                                 "Rates of tools without their own.",
                                 {{"feed", Kind::kRate, "needed, unless all tools have one",
                                   "of cuts and links", kFeedRange},
                                  {"plunge_feed", Kind::kRate, "a quarter of `feed`",
                                   "down into stock; on a slope this over its sine", kFeedRange},
                                  {"spindle", Kind::kNumber, "0", "rpm", kNotNegative}}};
    return kTable;
}

const KeyTable& stock_table()
{
    static const KeyTable kTable{
        "stock",
        "What is cut from; all optional.",
        {{"top", Kind::kLength, "the parts', at least 0",
          "z of the stock's top: by default the highest place of the floors, or 0 where all lies "
          "below"},
         {"clearance", Kind::kLength, "5 mm", "rapid moves are made this far above the top",
          kPositive},
         {"bottom", Kind::kLength, "the parts' box", "z of the stock's bottom"},
         {"x", Kind::kExtent, "the parts' box", "of the stock, seen from above"},
         {"y", Kind::kExtent, "the parts' box", "of the stock, seen from above"},
         Key{"margin", Kind::kMargin, "none",
             "in place of `x` and `y`: how far the stock reaches beyond the parts; one number, or "
             "`[in x, in y]`",
             kNotNegative}
             .excluding({"x", "y"}),
         Key{"margin_top", Kind::kLength, "none",
             "in place of `top`: above the parts' highest place", kNotNegative}
             .excluding({"top"}),
         Key{"margin_bottom", Kind::kLength, "none",
             "in place of `bottom`: below the parts' lowest place", kNotNegative}
             .excluding({"bottom"}),
         {"program", Kind::kFiles, "none",
          "program, or list of programs, that were cut before: the stock of all operations is what "
          "they leave (Rest machining, below)"},
         {"least_floor", Kind::kLength, "0.5 mm", "between the cuts of two sides (Set-ups, below)",
          kNotNegative},
         Key{"outline", Kind::kText, "none",
             "in place of `x` and `y`: the stock's outline, a drawing as `boundary` names it: "
             "`\"bar.dxf#stock\"` (Stock of any outline, below)"}
             .excluding({"x", "y", "margin"})}};
    return kTable;
}

const KeyTable& placing_table()
{
    static const KeyTable kTable{
        "placing",
        "How files lie; all optional, in the order in which they act.",
        {{"file", Kind::kFiles, "all others", "the file or files that the table is for"},
         Key{"width", Kind::kLength, "of a picture: needed",
             "of the relief that a picture (.png) is", job::kToleranceRange}
             .needing({"heights"}),
         Key{"heights", Kind::kTwo, "of a picture: needed", "`[z of black, z of white]`"}.needing(
             {"width"}),
         {"scale", Kind::kNumber, "1", "factor", job::kScaleRange},
         choice("up", {"+x", "-x", "+y", "-y", "+z", "-z"}, "the file's axis that points up", "+z"),
         {"rotate",
          Kind::kTurn,
          "0",
          "degrees: about z, or `[x, y, z]`, about x first",
          {-360, 360}},
         choice("origin", {"corner", "centre", "top"},
                "`\"top\"`: the part's top at z = 0; `\"corner\"`: also its least x and y at 0; "
                "`\"centre\"`: also its middle in x and y at 0",
                "the file's"),
         {"move", Kind::kThree, "`[0, 0, 0]`", "`[x, y, z]`"},
         Key{"grid", Kind::kNumbers, "none",
             "`[columns, rows]` of the part, the first one where all above puts it"}
             .needing({"pitch"}),
         Key{"pitch", Kind::kMargin, "with a `grid`: needed",
             "from part to part, or `[in x, in y]`"}
             .needing({"grid"}),
         Key{"copies", Kind::kPairs, "none",
             "`[[x, y], ...]`, in place of a `grid`: all places of the part, moved by these"}
             .excluding({"grid"}),
         Key{"copies_rotate",
             Kind::kNumbers,
             "0",
             "degrees of the copies about the origin, before they are moved: one number, or one "
             "each",
             {-360, 360}}
             .needing({"copies"})}};
    return kTable;
}

const KeyTable& fixture_table()
{
    static const KeyTable kTable{
        "fixture",
        "What holds the stock; any number of `[[fixture]]`.",
        {{"name", Kind::kText, "its place", "for messages"},
         Key{"x", Kind::kExtent, "of a box: needed", "of the box, seen from above"}
             .needing({"y"})
             .excluding({"centre"}),
         Key{"y", Kind::kExtent, "of a box: needed", "of the box, seen from above"}
             .needing({"x"})
             .excluding({"centre"}),
         Key{"centre", Kind::kTwo, "of a vertical cylinder: needed", "`[x, y]`"}.needing(
             {"diameter"}),
         Key{"diameter", Kind::kLength, "of a vertical cylinder: needed", "of the cylinder",
             kPositive}
             .needing({"centre"}),
         {"top", Kind::kLength, "needed", "z; below it there is the fixture, down to the table"},
         {"margin", Kind::kLength, "1 mm", "that tools keep from it", kNotNegative},
         {"setup", Kind::kText, "all", "name of the set-up that it holds in"}}};
    return kTable;
}

const KeyTable& setup_table()
{
    static const KeyTable kTable{
        "setup",
        "How the stock is clamped; `[[setup]]` for each time.",
        {{"name", Kind::kText, "needed",
          "letters, digits, `_`, `-`: part of the program's file name"},
         choice("offset", {"G54", "G55", "G56", "G57", "G58", "G59"},
                "the work offset of its program; each set-up has its own", "by its place"),
         choice("flip", {"x", "y"}, "the stock is turned over about a line along that axis",
                "none")}};
    return kTable;
}

const KeyTable& post_table()
{
    // Fewer decimals would round by more than tolerances are; a controller reads no more than six.
    static const KeyTable kTable{
        "post",
        "A controller to write for, a file of its own.",
        {{"about", Kind::kText, "none", "the controller, in a few words"},
         {"mm_decimals", Kind::kCount, "needed", "of coordinates in mm", {3, 6}},
         {"inch_decimals", Kind::kCount, "needed", "of coordinates in inches", {4, 6}},
         choice("arcs", {"IJ", "R", "none"}, "centre or radius of an arc", "needed"),
         {"nurbs", Kind::kFlag, "needed", "it knows G6.2"},
         {"drill_cycles", Kind::kFlag, "false", "it knows G81 and G83"},
         {"point", Kind::kFlag, "needed", "whole numbers have a point"},
         {"rapid_feed", Kind::kNumber, "0", "mm/min, F of G0; 0: none", kNotNegative},
         choice("comments", {"()", ";", "none"}, "how a comment is written", "needed"),
         {"line_numbers", Kind::kCount, "0", "step between N words; 0: none", {0, 1000}},
         {"begin", Kind::kTexts, "needed", "first lines"},
         {"modes", Kind::kTexts, "needed", "lines that set the modes"},
         {"exact_path", Kind::kTexts, "needed", "lines for the exact path"},
         {"blend", Kind::kTexts, "needed", "lines for `--blend`"},
         {"header", Kind::kTexts, "needed", "lines after the modes"},
         {"first_tool", Kind::kTexts, "needed", "lines for the first tool"},
         {"next_tool", Kind::kTexts, "needed", "lines for a change of tool"},
         {"spindle_on", Kind::kTexts, "needed", "lines that start the spindle"},
         {"mist", Kind::kTexts, "needed", "lines for mist"},
         {"flood", Kind::kTexts, "needed", "lines for flood"},
         {"coolant_off", Kind::kTexts, "needed", "lines that stop the coolant"},
         {"after_tool", Kind::kTexts, "needed", "lines after a tool's cuts"},
         {"footer", Kind::kTexts, "needed", "lines before the end"},
         {"end", Kind::kTexts, "needed", "last lines"}}};
    return kTable;
}

const job::Strategy& strategy_of(JobTable& operation, const job::Strategies& strategies)
{
    const auto name = operation.text("strategy");
    if (!name) {
        operation.refuse("strategy", "is missing");
    }
    const job::Strategy* const strategy = find_strategy(strategies, *name);
    if (strategy == nullptr) {
        operation.refuse("strategy", fmt::format("is \"{}\", known are \"{}\"", *name,
                                                 fmt::join(job::names_of(strategies), "\", \"")));
    }
    refuse_keys_of_others(operation, strategies, *strategy);
    return *strategy;
}

}  // namespace cusp::import
