// Each piece of the job as TOML; numbers with the digits that read back as the same.
#include "host_tools/job/import/one_line_text.hpp"

#include <algorithm>
#include <iterator>

#include "firmware/base/inch.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {
namespace {

// One number where it is the same for all tools, else one for each, in their order.
std::string said_of_tools(const OneLineRequest& request,
                          const OneLineChoice& choice,
                          const std::vector<double>& values)
{
    const auto differs = [&](double value) {
        return value != values.front();
    };
    if (std::none_of(values.begin(), values.end(), differs)) {
        return fmt::format("{:.6g}", values.front());
    }
    std::vector<std::string> each;
    for (std::size_t i = 0; i < values.size(); ++i) {
        each.push_back(
            fmt::format("{:.6g} ({})", values[i], words_of(choice.tools[i], request.inch)));
    }
    return fmt::format("{}", fmt::join(each, ", "));
}

}  // namespace

std::string quoted(const std::string& text)
{
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
        }
        const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
        out += control ? fmt::format("\\u{:04X}", static_cast<unsigned>(c)) : std::string(1, c);
    }
    return out + '"';
}

std::string quoted_list(const std::vector<std::string>& texts)
{
    std::vector<std::string> all;
    std::transform(texts.begin(), texts.end(), std::back_inserter(all), quoted);
    return fmt::format("[{}]", fmt::join(all, ", "));
}

std::string head_toml(const OneLineRequest& request, const OneLineChoice& choice)
{
    std::string out = fmt::format(
        "# The job of a call of cusp plan without a job file. Paths are relative to this "
        "file:\n"
        "# save it in the folder where the call was made.\nunits = \"{}\"\n",
        choice.unit);
    if (!request.post.empty()) {
        out += fmt::format("post = {}\n", quoted(request.post));
    }
    if (!request.machine.empty()) {
        out += fmt::format("machine = {}\n", quoted(request.machine));
    }
    for (std::size_t i = 0; i < choice.tools.size(); ++i) {
        out += fmt::format("\n[[tool]]\nnumber = {}\nshape = \"{}\"\ndiameter = {}\n", i + 1,
                           choice.tools[i].shape, choice.tools[i].diameter);
        if (choice.tools[i].corner_radius > 0) {
            out += fmt::format("corner_radius = {}\n", choice.tools[i].corner_radius);
        }
        if (choice.tools[i].taper_angle > 0) {
            out += fmt::format("taper_angle = {}\n", choice.tools[i].taper_angle);
        }
        if (choice.tools[i].tip_angle > 0) {
            out += fmt::format("tip_angle = {}\n", choice.tools[i].tip_angle);
        }
        if (choice.tools[i].tip_diameter > 0) {
            out += fmt::format("tip_diameter = {}\n", choice.tools[i].tip_diameter);
        }
        if (choice.feeds[i] != choice.feeds.back() ||
            choice.plunge_feeds[i] != choice.plunge_feeds.back()) {
            out += fmt::format("feed = {}\nplunge_feed = {}\n", choice.feeds[i],
                               choice.plunge_feeds[i]);
        }
        if (choice.spindles[i] != choice.spindles.back()) {
            out += fmt::format("spindle = {}\n", choice.spindles[i]);
        }
    }
    out += fmt::format("\n[cutting]\nfeed = {}\nplunge_feed = {}\nspindle = {}\n",
                       choice.feeds.back(), choice.plunge_feeds.back(), choice.spindles.back());
    return out;
}

std::string placing_toml(const OneLineRequest& request, const std::vector<NestedFiles>& copied)
{
    std::string keys;
    if (request.width) {
        keys += fmt::format("width = {}\n", *request.width);
    }
    if (!request.heights.empty()) {
        keys += fmt::format("heights = [{}]\n", fmt::join(request.heights, ", "));
    }
    if (request.scale) {
        keys += fmt::format("scale = {}\n", *request.scale);
    }
    if (!request.up.empty()) {
        keys += fmt::format("up = \"{}\"\n", request.up);
    }
    if (!request.rotate.empty()) {
        keys += fmt::format("rotate = [{}]\n", fmt::join(request.rotate, ", "));
    }
    if (!request.origin.empty()) {
        keys += fmt::format("origin = \"{}\"\n", request.origin);
    }
    if (!request.move.empty()) {
        keys += fmt::format("move = [{}]\n", fmt::join(request.move, ", "));
    }
    if (copied.empty()) {
        return keys.empty() ? "" : "\n[placing]\n" + keys;
    }
    const double unit = request.inch ? kMillimetresPerInch : 1.0;
    std::string tables;
    for (const NestedFiles& each : copied) {
        std::vector<std::string> places;
        std::vector<double> turns;
        for (const CopyPlace& place : each.places) {
            places.push_back(fmt::format("[{}, {}]", place.at.x / unit, place.at.y / unit));
            turns.push_back(place.degrees);
        }
        tables += fmt::format("\n[[placing]]\nfile = {}\n{}copies = [{}]\ncopies_rotate = [{}]\n",
                              quoted_list(each.files), keys, fmt::join(places, ", "),
                              fmt::join(turns, ", "));
    }
    return tables;
}

std::string said_feeds(const OneLineRequest& request, const OneLineChoice& choice)
{
    std::vector<std::string> chosen;
    const auto note = [&](const std::optional<double>& asked, const char* option) {
        if (!asked) {
            chosen.emplace_back(option);
        }
    };
    note(request.feed, "--feed");
    note(request.plunge_feed, "--plunge-feed");
    note(request.spindle, "--spindle");
    std::string out = fmt::format("feed {} {}/min, plunge feed {}, spindle {} rpm",
                                  said_of_tools(request, choice, choice.feeds), choice.unit,
                                  said_of_tools(request, choice, choice.plunge_feeds),
                                  said_of_tools(request, choice, choice.spindles));
    if (!choice.rated.empty() && !chosen.empty()) {
        return fmt::format("{}\n{}", out, fmt::join(choice.rated, "\n"));
    }
    if (!chosen.empty()) {
        out += fmt::format(": defaults; set them for your material by --material, or by {}",
                           fmt::join(chosen, " "));
    }
    return out;
}

}  // namespace cusp::import
