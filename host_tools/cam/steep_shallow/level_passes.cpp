// Levels from the top down; then those between, loop by loop; then the passes, all at once.
#include "host_tools/cam/steep_shallow/level_passes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/steep_shallow/level_spiral.hpp"

#include "fmt/format.h"

namespace cusp::steep_shallow {

using finishing::FinishArea;
using finishing::Points;
using finishing::SurfaceOperation;
using job::Job;
using job::Operation;
using part_model::PartModel;

namespace {

constexpr double kMostLevels = 20000;
constexpr double kLeastStep = 1.0 / 16;  // of the widest: less is for passes that are missing
constexpr std::size_t kSteps = 24;       // that are tried for a level
constexpr double kEnough = 1e-6;         // of a step
constexpr int kHalvings = 10;            // between two places

class LevelPlanner {
public:
    LevelPlanner(const Job& job,
                 const Operation& operation,
                 const SurfaceOperation& work,
                 const FinishArea& area)
        : job_{job},
          operation_{operation},
          work_{work},
          step_{work, *operation.tolerance.scallop},
          curves_{work, area, step_}
    {
        const Vec3d low = work.model().box_low();
        const Vec3d high = work.model().box_high();
        top_ = std::min(high.z, area.range().high);
        bottom_ = std::max(low.z, area.range().low) - work.path_fitter().tool().corner_radius;
    }

    double cut(FinishCompletion& passes)
    {
        if ((top_ - bottom_) / step_.widest() > kMostLevels) {
            throw InputError(fmt::format(
                "{}: {}: levels {:.3g} mm apart by the scallop over a height of {:g} mm would be "
                "more than {:g}",
                job_.file, operation_.name(), step_.widest(), top_ - bottom_, kMostLevels));
        }
        find_levels();
        for (SurfaceOperation::FittedPass& pass : fitted()) {
            passes.cut(std::move(pass));
        }
        return step_.widest();
    }

private:
    using Loops = std::vector<LevelLoop>;

    void find_levels()
    {
        double z = top_;
        Loops above = curves_.at(z);
        keep(above, kInfinite);
        while (z > bottom_) {
            const double next = std::max(bottom_, z - step_down(above, step_.widest()));
            Loops below = curves_.at(next);
            fill(z, above, next, below);
            keep(below, kInfinite);
            job_.report_progress(0.5 * kSectionsDone * (top_ - next) / (top_ - bottom_));
            z = next;
            above = std::move(below);
        }
    }

    // The least step that ground in the area asks for.
    double least_step(const Loops& loops) const
    {
        double least = kInfinite;
        for (const LevelLoop& loop : loops) {
            for (const LevelPlace& place : loop.places) {
                if (place.in_area) {
                    least = std::min(least, place.step);
                }
            }
        }
        return std::max(least, kLeastStep * step_.widest());
    }

    // Adds levels between two, over the ground that they are too far apart for.
    void fill(double high, const Loops& above, double low, const Loops& below)
    {
        const double apart = high - low;
        if (std::min(least_step(above), least_step(below)) >= (1 - kEnough) * apart) {
            return;
        }
        const double middle = 0.5 * (high + low);
        Loops between = curves_.at(middle);
        fill(high, above, middle, between);
        keep(between, (1 - kEnough) * apart);
        fill(middle, between, low, below);
    }

    // Keeps the loops, as far as their ground allows less than that step.
    void keep(const Loops& loops, double step)
    {
        for (LevelLoop loop : loops) {
            bool some = false;
            for (LevelPlace& place : loop.places) {
                place.in_area = place.in_area && place.step < step;
                some = some || place.in_area;
            }
            if (some) {
                if (operation_.passes.direction_of_cut == job::CutDirection::kConventional) {
                    std::reverse(loop.places.begin(), loop.places.end());
                }
                widen(loop);
                begin_near_last(loop);
                kept_.push_back(std::move(loop));
            }
        }
    }

    // Passes go on for a stepover.
    void widen(LevelLoop& loop) const
    {
        const std::size_t n = loop.places.size();
        std::vector<char> wide(n, 0);
        for (std::size_t k = 0; k < n; ++k) {
            if (!loop.places[k].in_area) {
                continue;
            }
            wide[k] = 1;
            for (const std::size_t way : {std::size_t{1}, n - 1}) {
                double gone = 0;
                std::size_t at = k;
                for (std::size_t m = 0; m < n && !loop.places[(at + way) % n].in_area; ++m) {
                    const std::size_t next = (at + way) % n;
                    gone += norm(loop.places[next].tip - loop.places[at].tip);
                    if (gone > step_.widest()) {
                        break;
                    }
                    wide[next] = 1;
                    at = next;
                }
            }
        }
        for (std::size_t k = 0; k < n; ++k) {
            loop.places[k].in_area = wide[k] != 0;
        }
    }

    // A whole loop begins near the beginning of the one before, so that the way down is short; another
    // one begins outside the area.
    void begin_near_last(LevelLoop& loop)
    {
        std::vector<LevelPlace>& places = loop.places;
        const auto outside = std::find_if(places.begin(), places.end(),
                                          [](const LevelPlace& p) { return !p.in_area; });
        auto first = outside;
        if (outside == places.end()) {
            double least = kInfinite;
            for (const Vec3d& start : starts_) {
                for (auto at = places.begin(); at != places.end(); ++at) {
                    const double away = norm(at->tip - start);
                    if (away < least) {
                        least = away;
                        first = at;
                    }
                }
            }
            first = first == places.end() ? places.begin() : first;
            if (starts_.size() >= kStarts) {
                starts_.erase(starts_.begin());
            }
            starts_.push_back(first->tip);
        }
        std::rotate(places.begin(), first, places.end());
    }

    // Dense tips of all passes, fitted.
    std::vector<SurfaceOperation::FittedPass> fitted() const
    {
        std::vector<LevelRun> runs =
            keys().spiral ? spirals(kept_, curves_, 2 * curves_.pitch()) : runs_of(kept_);
        std::vector<SurfaceOperation::FittedPass> out(runs.size());
        {
            const PartModel::SharedQueries shared{work_.model()};
            parallel::for_each(runs.size(), [&](std::size_t k) {
                const PartModel::SharedQueries::Part queries{work_.model()};
                out[k] = work_.fitted_pass(dense(runs[k]), std::nullopt, {}, &queries);
            });
        }
        work_.model().forget_queries();
        return out;
    }

    Points dense(const LevelRun& run) const
    {
        std::vector<double> breaks;
        for (std::size_t k = 0; k < run.size(); ++k) {
            breaks.push_back(static_cast<double>(k));
        }
        const auto tip = [&](double at) {
            const auto k = std::min(static_cast<std::size_t>(at), run.size() - 2);
            const double share = at - static_cast<double>(k);
            if (share == 0) {
                return run[k];
            }
            const Vec3d between = run[k] + (run[k + 1] - run[k]) * share;
            return curves_.touching({between.x, between.y}, between.z);
        };
        return work_.path_fitter().sample(tip, breaks, kHalvings);
    }

    const job::FinishKeys& keys() const { return finish_keys(operation_); }

    static constexpr std::size_t kStarts = 64;  // remembered

    const Job& job_;
    const Operation& operation_;
    const SurfaceOperation& work_;
    SectionStep step_;
    LevelCurves curves_;
    double top_;
    double bottom_;
    Loops kept_;                 // from the top down
    std::vector<Vec3d> starts_;  // of the last whole loops
};

}  // namespace

// A level twice as far down as some ground allows has one more level over that, and so on.
double step_down(const std::vector<LevelLoop>& loops, double widest)
{
    struct Stretch {
        double step;
        double length;
    };
    std::vector<Stretch> all;
    for (const LevelLoop& loop : loops) {
        for (std::size_t k = 0; k < loop.places.size(); ++k) {
            const LevelPlace& place = loop.places[k];
            if (place.in_area) {
                const Vec3d next = loop.places[(k + 1) % loop.places.size()].tip;
                all.push_back(
                    {std::clamp(place.step, kLeastStep * widest, widest), norm(next - place.tip)});
            }
        }
    }
    if (all.empty()) {
        return widest;
    }
    std::sort(all.begin(), all.end(),
              [](const Stretch& a, const Stretch& b) { return a.step < b.step; });
    const auto cost = [&](double step) {
        double sum = 0;
        for (const Stretch& stretch : all) {
            double times = 1;
            for (double apart = step; apart > (1 + kEnough) * stretch.step; apart *= 0.5) {
                times *= 2;
            }
            sum += stretch.length * times;
        }
        return sum / step;
    };
    double best = all.front().step;
    double least = kInfinite;
    for (std::size_t k = 0; k <= kSteps; ++k) {
        const double step = all[(all.size() - 1) * k / kSteps].step;
        const double now = cost(step);
        if (now < least) {
            least = now;
            best = step;
        }
    }
    return best;
}

double cut_levels(const Job& job,
                  const Operation& operation,
                  const SurfaceOperation& work,
                  const FinishArea& area,
                  FinishCompletion& passes)
{
    return LevelPlanner{job, operation, work, area}.cut(passes);
}

}  // namespace cusp::steep_shallow
