// How near tools come to the fixtures of a job, and links that go over them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "host_tools/job/job.hpp"

namespace cusp::job {

// mm from a fixture grown by its margin to a tool whose tip is there: a vertical cylinder of the
// tool's radius over the tip. Not above 0 where it touches; over a rim at most the true distance.
double distance_to(const Fixture& fixture, double tool_radius, Vec3d tip);

struct FixtureHit {
    std::size_t fixture;  // of the job
    Vec3d tip;
};

// A place of the move where the tool is in a grown fixture, by 1e-3 mm or more; curves as chords
// within that.
std::optional<FixtureHit> fixture_hit(const Job& job,
                                      double tool_radius,
                                      Vec3d from,
                                      const toolpath::ToolMove& move);

// Leads links that would touch a grown fixture over it: up to the clearance, across, and down at
// the plunge feed to where the link ends. Returns how many.
//
// operation  for messages
//
// Errors: InputError where any other move touches one: fixture, place, operation.
int keep_off_fixtures(const Job& job, const std::string& operation, toolpath::Toolpath& path);

}  // namespace cusp::job
