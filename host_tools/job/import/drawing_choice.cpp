// The choice takes loops by their depth in the drawing, and counts the nesting of those taken anew.
#include "host_tools/job/import/drawing_choice.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/job/import/loop_nesting.hpp"

namespace cusp::import {
namespace {

// Split at the gaps that were joined, for a tool goes along what is drawn.
void add_pieces(const job::Chain& joined, std::vector<job::Chain>& chains)
{
    bool begins = true;
    for (const nurbs::Curve& curve : joined) {
        if (begins || norm(in_plan(chains.back().back().points.back()) -
                           in_plan(curve.points.front())) > kEndsMeet) {
            chains.emplace_back();
        }
        chains.back().push_back(curve);
        begins = false;
    }
}

bool is_excepted(const std::vector<double>& diameters, const FileLoop& loop)
{
    const auto circle = diameters.empty() ? std::nullopt : circle_of_loop(loop.loop);
    return circle && std::any_of(diameters.begin(), diameters.end(), [&](double d) {
               return std::abs(d - circle->diameter) <= kSameDiameter;
           });
}

}  // namespace

DrawingChoice read_drawing_choice(JobTable& table, const job::Operation& operation)
{
    DrawingChoice choice;
    choice.layers = table.texts("drawing_layers").value_or(choice.layers);
    choice.loops = table.choice_or_default("loops");
    choice.except_diameters = table.numbers("except_diameters").value_or(std::vector<double>{});
    if (choice.loops == "open" && !operation.cuts(job::Region::kGrooves)) {
        table.refuse("loops", "\"open\" is for engrave: other strategies need closed loops");
    }
    return choice;
}

std::vector<FileLoop> without_circles(const std::vector<FileLoop>& loops,
                                      const std::vector<double>& diameters)
{
    std::vector<FileLoop> left;
    std::vector<int>
        places;  // of each loop in `left`; of one that is left out that of the loop around it
    for (FileLoop loop : loops) {
        const int around = loop.parent < 0 ? -1 : places[static_cast<std::size_t>(loop.parent)];
        if (is_excepted(diameters, loop)) {
            places.push_back(around);
            continue;
        }
        loop.parent = around;
        loop.depth = around < 0 ? 0 : left[static_cast<std::size_t>(around)].depth + 1;
        places.push_back(static_cast<int>(left.size()));
        left.push_back(std::move(loop));
    }
    return left;
}

std::vector<FileLoop> chosen_loops(const DrawingChoice& choice, const FileShapes& shapes)
{
    std::vector<FileLoop> chosen;
    const auto taken = [&](const FileLoop& loop) {
        const bool fits = choice.loops == "outer"   ? loop.depth == 0
                          : choice.loops == "inner" ? loop.depth > 0
                                                    : choice.loops != "open";
        return fits && !is_excepted(choice.except_diameters, loop);
    };
    std::vector<int> depths;  // of each loop: how many are taken of it and those around it
    for (const FileLoop& loop : shapes.loops) {
        const bool is_taken = taken(loop);
        // the largest come first, so the loop around is known
        const int around = loop.parent < 0 ? 0 : depths[static_cast<std::size_t>(loop.parent)];
        depths.push_back(around + (is_taken ? 1 : 0));
        if (is_taken) {
            chosen.push_back(loop);
            chosen.back().depth = around;
        }
    }
    return chosen;
}

std::vector<job::Hole> chosen_circles(const DrawingChoice& choice, const FileShapes& shapes)
{
    std::vector<job::Hole> circles;
    for (const FileLoop& loop : chosen_loops(choice, shapes)) {
        const auto circle = circle_of_loop(loop.loop);
        if (circle && (choice.loops != "inner" || loop.depth % 2 == 0)) {
            circles.push_back(*circle);
        }
    }
    return circles;
}

std::vector<job::Chain> chosen_chains(const DrawingChoice& choice, const FileShapes& shapes)
{
    std::vector<job::Chain> chains;
    for (const FileLoop& loop : chosen_loops(choice, shapes)) {
        chains.push_back(loop.loop);
    }
    if (choice.loops == "open" || choice.loops == "all") {
        for (const job::OpenChain& open : shapes.open) {
            add_pieces(open.pieces, chains);
        }
    }
    return chains;
}

}  // namespace cusp::import
