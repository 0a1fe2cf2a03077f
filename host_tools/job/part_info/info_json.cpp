// PartInfo as JSON. Its keys are stable: scripts read them.
#include <cmath>

#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/job/part_info/part_info.hpp"

#include "nlohmann/json.hpp"

namespace cusp::part_info {

using job::ClosedLoop;
using job::LoopNesting;
using job::OpenChain;
using job::PartLayer;

namespace {

using Json = nlohmann::ordered_json;

double rounded(double value)
{
    constexpr double kMicro = 1e6;
    return std::round(value * kMicro) / kMicro + 0.0;
}

Json point(Vec3d p) { return {rounded(p.x), rounded(p.y), rounded(p.z)}; }
Json point(Vec2d p) { return {rounded(p.x), rounded(p.y)}; }

double share(double part, double whole) { return whole > 0 ? rounded(part / whole) : 0; }

Json loop_json(const ClosedLoop& loop, std::size_t number)
{
    Json out{{"number", number},
             {"curves", loop.curves.size()},
             {"length_mm", rounded(loop.length)},
             {"area_mm2", rounded(loop.area)},
             {"counter_clockwise", loop.counter_clockwise},
             {"depth", loop.depth},
             {"hole", loop.depth % 2 == 1}};
    if (loop.parent >= 0) {
        out["inside"] = loop.parent + 1;
    }
    if (loop.crossing) {
        out["crosses_itself_at_mm"] = point(*loop.crossing);
    }
    return out;
}

Json chain_json(const OpenChain& chain)
{
    return {{"curves", chain.curves},          {"length_mm", rounded(chain.length)},
            {"begin_mm", point(chain.begin)},  {"end_mm", point(chain.end)},
            {"gap_mm", rounded(chain.gap)},    {"gap_from_mm", point(chain.gap_from)},
            {"gap_to_mm", point(chain.gap_to)}};
}

Json layer_json(const PartLayer& layer)
{
    const LoopNesting& nesting = layer.loops;
    Json out{{"name", layer.name},       {"hidden", layer.hidden},
             {"curves", nesting.curves}, {"repeated_curves", nesting.repeated},
             {"loops", Json::array()},   {"open_chains", Json::array()}};
    for (std::size_t k = 0; k < nesting.loops.size(); ++k) {
        out["loops"].push_back(loop_json(nesting.loops[k], k + 1));
    }
    for (const OpenChain& chain : nesting.open) {
        out["open_chains"].push_back(chain_json(chain));
    }
    if (nesting.bridged > 0) {
        out["bridged_gaps"] = nesting.bridged;
        out["widest_gap_mm"] = rounded(nesting.widest_gap);
    }
    if (nesting.crossing) {
        out["loops_cross_at_mm"] = point(*nesting.crossing);
    }
    if (!layer.problem.empty()) {
        out["problem"] = layer.problem;
    }
    return out;
}

void add_mesh(const PartInfo& info, Json& out)
{
    const MeshHealth& mesh = *info.mesh;
    out["facets"] = info.pieces;
    out["degenerate_facets"] = info.part.degenerate;
    out["shells"] = mesh.shells;
    out["closed"] = mesh.closed;
    out["open_edges"] = mesh.open_edges;
    out["holes"] = mesh.holes;
    if (mesh.hole_at) {
        out["hole_at_mm"] = point(*mesh.hole_at);
    }
    out["holes_above"] = Json::array();
    for (const job::OpenHole& hole : info.part.holes_above) {
        out["holes_above"].push_back(
            {{"middle_mm", point(hole.middle)}, {"size_mm", point(hole.size)}});
    }
    out["non_manifold_edges"] = mesh.non_manifold_edges;
    if (mesh.non_manifold_at) {
        out["non_manifold_at_mm"] = point(*mesh.non_manifold_at);
    }
    out["inverted_facets"] = mesh.inverted_facets;
    out["inside_out_shells"] = mesh.inside_out_shells;
}

void add_ground(const Ground& ground, Json& out)
{
    out["area_mm2"] = rounded(ground.area);
    out["steepest_degrees"] = rounded(ground.steepest);
    out["steepest_at_mm"] = point(ground.steepest_at);
    if (ground.steepest_slope) {
        out["steepest_slope_degrees"] = rounded(*ground.steepest_slope);
        out["steepest_slope_at_mm"] = point(ground.steepest_slope_at);
    }
    out["upright_share"] = share(ground.vertical_area, ground.area);
    out["level_share"] = share(ground.level_area, ground.area);
    if (ground.level_at) {
        out["level_at_mm"] = point(*ground.level_at);
    }
    out["undercut_share"] = share(ground.hidden_area, ground.area);
    out["undercut_area_mm2"] = rounded(ground.hidden_area);
    if (ground.hidden_at && ground.hidden_area > 0) {
        out["undercut_at_mm"] = point(*ground.hidden_at);
    }
}

void add_ball(const PartInfo& info, Json& out)
{
    if (info.hollow) {
        out["hollow_radius_mm"] = rounded(info.hollow->radius);
        out["hollow_at_mm"] = point(info.hollow->place.point);
    }
    const BallReach& ball = *info.ball;
    out["any_ball"] = !ball.radius;
    out["sharp_corner"] = ball.corner;
    out["ball_leaves_mm"] = ball.leaves;
    if (ball.radius) {
        out["largest_ball_mm"] = rounded(2 * *ball.radius);
        out["ball_at_mm"] = point(ball.at);
    }
    out["places"] = ball.places;
}

Json holes_json(const job::PartHoles& holes)
{
    Json out{{"diameter_mm", rounded(holes.diameter)},
             {"top_mm", rounded(holes.top)},
             {"depth_mm", rounded(holes.depth)},
             {"tip_mm", rounded(holes.tip)},
             {"through", holes.through},
             {"places_mm", Json::array()}};
    for (const Vec2d& at : holes.places) {
        out["places_mm"].push_back(point(at));
    }
    if (holes.mouth) {
        out["mouth"] = {{"diameter_mm", rounded(holes.mouth->diameter)},
                        {"depth_mm", rounded(holes.mouth->depth)},
                        {"angle_degrees", rounded(holes.mouth->angle)}};
    }
    return out;
}

void add_features(const job::PartFeatures& features, Json& out)
{
    for (const char* const list :
         {"levels", "pockets", "round_holes", "inner_corners", "fillets"}) {
        out[list] = Json::array();
    }
    for (const job::PartLevel& level : features.levels) {
        out["levels"].push_back(
            {{"z_mm", rounded(level.z)}, {"level_area_mm2", rounded(level.area)}});
    }
    for (const job::PartPocket& pocket : features.pockets) {
        out["pockets"].push_back({{"z_mm", rounded(pocket.z)},
                                  {"middle_mm", point(pocket.middle)},
                                  {"size_mm", point(pocket.size)},
                                  {"level_area_mm2", rounded(pocket.area)},
                                  {"open", pocket.open}});
    }
    for (const job::PartHoles& holes : features.holes) {
        out["round_holes"].push_back(holes_json(holes));
    }
    out["closed_above"] = features.closed_above;
    for (const job::PartCorners& corners : features.corners) {
        out["inner_corners"].push_back(
            {{"radius_mm", rounded(corners.radius)}, {"count", corners.count}});
    }
    for (const job::PartFillets& fillets : features.fillets) {
        out["fillets"].push_back({{"radius_mm", rounded(fillets.radius)},
                                  {"concave", fillets.concave},
                                  {"count", fillets.count},
                                  {"length_mm", rounded(fillets.length)}});
    }
}

Json part_json(const PartInfo& info)
{
    Json out{{"file", info.part.file}, {"format", info.part.format}, {"unit", info.part.unit.name}};
    out["unit_assumed"] = info.part.unit.assumed;
    out["box_low_mm"] = point(info.part.box_low);
    out["box_high_mm"] = point(info.part.box_high);
    out["size_mm"] = point(info.part.box_high - info.part.box_low);
    if (info.is_drawing()) {
        out["layers"] = Json::array();
        for (const PartLayer& layer : info.part.layers) {
            out["layers"].push_back(layer_json(layer));
        }
        out["notes"] = info.part.notes;
    } else if (info.is_mesh()) {
        add_mesh(info, out);
    } else {
        out["faces"] = info.pieces;
        out["solids"] = info.part.solids;
        out["unread_faces"] = info.part.unread_faces;
        out["notes"] = info.part.notes;
    }
    if (info.part.features) {
        add_features(*info.part.features, out);
    }
    if (info.ground) {
        add_ground(*info.ground, out);
        add_ball(info, out);
    }
    return out;
}

}  // namespace

std::string json_of(const std::vector<PartInfo>& parts)
{
    Json out{{"files", Json::array()}};
    for (const PartInfo& info : parts) {
        out["files"].push_back(part_json(info));
    }
    return json_text::written(out, 1) + "\n";
}

}  // namespace cusp::part_info
