// The work of the commands as calls: JSON in, JSON out, files in memory, no command line.
//
//     files::FileSet files{{"part.stl", bytes}};
//     engine::Listener nobody;
//     const engine::Answer job = engine::call("suggest", R"({"parts": ["part.stl"], "tools": ["ball:6"]})", files, nobody);
//     job.json;  // {"ok":true,"result":{"job":"units = ...","said":[...]}}
//
// Pages call it through the server of cusp studio. Files that a job names are looked for in the set
// alone, so that a page reads nothing of the disk; posts and libraries of tools are those that come with the program.
//
// Arguments, [those that may be absent], and results. `job` is the text of a job, `name` its file: paths in it are relative
// to the folder of that name. A `block` names a block of the answer. Lengths are mm.
//
//     keys      {} -> version, threads, cad, schema (that of cusp plan --schema), strategies, suggest (the options of suggest), posts, errors and alarms of Grbl
//     describe  files [units, tolerance, facets] -> files (as cusp info --stats), text, facets: file, triangles, block
//     suggest   parts, tools [the options of a plan without a job, by their names] -> job, said
//     check     job [name, facets] -> faults, warnings, setups: name, offset, unit, stock, tools, operations, facets
//     plan      job [name, program, title, post, blend, only] -> programs: name, setup, block, summary, warnings, stats
//     verify    job, program [name, after, engagement, max_engagement, grid, step, maps] -> holds, broken, text, stats,
//               map: columns, rows, x0, y0, pitch, of the blocks "left", "gouge", "part" (as verify::Verification)
//     run       program [settings, dialect, page, job, name, after] -> good, faults, stats; with page also facts, ticks,
//               refused, verdict and the blocks of view::RunData
//     fit       program, tolerance -> block, stats
//     send      program [numbers, line, safe_z, start, start_place, now, place] -> lines, block ("LINE<tab>TEXT" each; LINE 0: of
//               the way to `line`), and with line also way. start, now: what $I, $$, $G and $# listed when the program began
//               and after the reset; places: of the machine
#pragma once

#include <string>
#include <vector>

#include "host_tools/base/files/file_set.hpp"

namespace cusp::engine {

// A binary part of a result: the bytes of a program, or little-endian numbers.
struct Block {
    std::string name;  // by which the JSON calls it
    std::string bytes;
};

struct Answer {
    // One line: {"ok":true,"result":...}, or {"ok":false,"error":{"kind","text","file","line","place","key","value",
    // "limit"}}. Kinds: "input" (the caller can mend it), "cancelled", "memory", "internal".
    std::string json;
    std::vector<Block> blocks;  // none where the call failed
};

// Follows a call, and may end it. Each function is called by one thread at a time.
class Listener {
public:
    Listener() = default;
    virtual ~Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    // share  0 to 1, of the piece of work that `text` names
    virtual void progress(double share, const std::string& text);
    // Asked at each progress. True ends the call soon, with the kind "cancelled".
    virtual bool cancelled();
};

// The names of all calls: "keys", "describe", "suggest", "check", "plan", "verify", "run", "fit", "send".
std::vector<std::string> names();

// Throws nothing. A process does one call at a time: a second one waits for the first.
//
// arguments  a JSON object; "" is {}
// files      what jobs and arguments name, by the paths as they spell them
Answer call(const std::string& name,
            const std::string& arguments,
            const files::FileSet& files,
            Listener& listener);

}  // namespace cusp::engine
