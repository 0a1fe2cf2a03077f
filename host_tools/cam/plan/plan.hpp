// A job in, a program with its report out: without files, without printing.
//
//     class Bar : public Watcher {
//         void progress(const char* work, double share) override { draw(work, share); }
//         bool cancelled() override { return stop_was_pressed; }
//     };
//     Bar bar;
//     job::Job job = import::read_job("part.toml", strategies::all());
//     const PlannedProgram part = plan_job(job, {}, bar);
//     files::write_text("part.ngc", part.gcode);
//     for (const std::string& warning : part.all_warnings()) { fmt::print("{}\n", warning); }
//
// A plan runs through stages (stages.hpp): it reads what was cut before, fits the tolerances to the post, plans
// the operations, leaves out what earlier cuts have taken, keeps off fixtures, orders, proves rapid moves and holders,
// feeds by load, writes and times.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::plan {

// Follows a plan, and may end it. Each function is called by one thread at a time.
class Watcher {
public:
    Watcher() = default;
    virtual ~Watcher() = default;
    Watcher(const Watcher&) = delete;
    Watcher& operator=(const Watcher&) = delete;

    // An operation begins: `place` of `count`, from 1.
    virtual void operation(std::size_t place, std::size_t count, const std::string& strategy);
    // A piece of work begins, in words: "checking rapid moves".
    virtual void begin(const std::string& work);
    // The share of a long computation that is done, 0 to 1. `work` is one of few names: "planning", "timing".
    virtual void progress(const char* work, double share);
    // Asked between operations and between stages. True ends the plan: Cancelled is thrown.
    virtual bool cancelled();
};

class Cancelled : public std::runtime_error {
public:
    Cancelled() : std::runtime_error{"the plan was cancelled"} {}
};

struct PlanOptions {
    std::string title;  // for the program's first comment: where it comes from
    // By which later set-ups and messages call the program.
    std::string name{"program"};
    double blend{};  // in the job's units: G64 P; 0: the exact path
    bool measures_engagement{
        true};                // of operations that bound it: air, volume, time over the bound
    bool runs_program{true};  // for its times, by the controller's core; else they are estimates
};

// s of an operation.
struct TimeShares {
    double cutting{};
    double air{};  // at feed: links, and moves that meet no stock (verify/path_air.hpp)
    double rapid{};
};

struct PlannedProgram {
    std::string gcode;
    std::vector<toolpath::PlannedOperation> operations;  // not empty
    std::vector<toolpath::PathMeasure> measures;  // of each operation; times are the controller's
    std::vector<TimeShares> shares;     // of each operation; empty where they are not known
    std::vector<std::string> warnings;  // on the whole job

    // The job's warnings, then those of each operation.
    std::vector<std::string> all_warnings() const;
};

// Plans the operations of a job in one set-up.
//
// job  its tolerances are lowered by what the post rounds, and its progress is set: it is not copied, as meshes are
//      large. Its bounds afterwards are not those that it was read with.
//
// Errors: InputError if an operation can't be planned, there is nothing to cut, a rapid move would cut stock or a holder
// touch it; Cancelled.
PlannedProgram plan_job(job::Job& job, const PlanOptions& options, Watcher& watcher);

// Plans the set-ups of a job in turn: those before have made the stock of the later ones, in memory.
//
// setups  as import::read_setups() returns them; their operations are deleted as they are planned
// begin   called before each: what to call its program, and so on
// done    receives each program
//
// Errors: as plan_job(); before anything is planned, InputError if the post has no field for the offset of a set-up.
void plan_setups(std::vector<job::Job>& setups,
                 Watcher& watcher,
                 const std::function<PlanOptions(const job::Job&)>& begin,
                 const std::function<void(const job::Job&, PlannedProgram)>& done);

// The figures of the program, then of each operation, in mm and s: docs/stats.md. JSON text.
std::string statistics_json(const job::Job& job, const PlannedProgram& program);

// Three lines for people: lengths, times, bounds.
std::string summary_text(const PlannedProgram& program);

}  // namespace cusp::plan
