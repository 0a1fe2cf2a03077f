// Writes the job file, and sentences on what was chosen.
#include "host_tools/job/import/one_line_job.hpp"

#include <algorithm>
#include <iterator>

#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/one_line_choice.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {
namespace {

// A text as TOML writes it.
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

class OneLineWriter {
public:
    OneLineWriter(const OneLineRequest& request, const OneLineChoice& choice)
        : request_{request}, choice_{choice}
    {
    }

    std::string toml() const;
    std::vector<std::string> said() const;

private:
    std::string placing_toml() const;
    std::string operation_toml() const;
    std::string said_of_tools(const std::vector<double>& values) const;
    std::string said_feeds() const;
    std::string said_roughing() const;

    bool is_pocket() const { return request_.boundary.has_value(); }

    const OneLineRequest& request_;
    const OneLineChoice& choice_;
};

std::string OneLineWriter::operation_toml() const
{
    std::string out = fmt::format("\n[[operation]]\nstrategy = \"{}\"\nfloor = {}\n",
                                  choice_.strategy, quoted_list(request_.parts));
    if (is_pocket()) {
        out += fmt::format("boundary = {}\n", quoted(*request_.boundary));
    }
    if (!request_.islands.empty()) {
        out += fmt::format("islands = {}\n", quoted_list(request_.islands));
    }
    if (choice_.roughs) {
        std::vector<std::size_t> numbers;
        for (std::size_t i = 1; i <= choice_.roughing_tools().size(); ++i) {
            numbers.push_back(i);
        }
        out += is_pocket() ? "" : "roughing = true\n";
        out += fmt::format("tools = [{}]  # these rough\nmax_depth = {}\nallowance = {}\n",
                           fmt::join(numbers, ", "), choice_.max_depth, choice_.allowance);
    }
    out += fmt::format(
        "tool = {}  # finishes\nscallop = {}\nfloor_tolerance = {}\nplan_tolerance = {}\n"
        "output = \"{}\"\n",
        choice_.tools.size(), *request_.scallop, choice_.tolerance, choice_.tolerance,
        request_.output);
    return out;
}

// "" where no option places the parts.
std::string OneLineWriter::placing_toml() const
{
    std::string keys;
    if (request_.scale) {
        keys += fmt::format("scale = {}\n", *request_.scale);
    }
    if (!request_.up.empty()) {
        keys += fmt::format("up = \"{}\"\n", request_.up);
    }
    if (!request_.rotate.empty()) {
        keys += fmt::format("rotate = [{}]\n", fmt::join(request_.rotate, ", "));
    }
    if (!request_.origin.empty()) {
        keys += fmt::format("origin = \"{}\"\n", request_.origin);
    }
    if (!request_.move.empty()) {
        keys += fmt::format("move = [{}]\n", fmt::join(request_.move, ", "));
    }
    return keys.empty() ? "" : "\n[placing]\n" + keys;
}

std::string OneLineWriter::toml() const
{
    std::string out = fmt::format(
        "# The job of a call of cusp plan without a job file. Paths are relative to this "
        "file:\n"
        "# save it in the folder where the call was made.\nunits = \"{}\"\n",
        choice_.unit);
    if (!request_.post.empty()) {
        out += fmt::format("post = {}\n", quoted(request_.post));
    }
    for (std::size_t i = 0; i < choice_.tools.size(); ++i) {
        out += fmt::format("\n[[tool]]\nnumber = {}\nshape = \"{}\"\ndiameter = {}\n", i + 1,
                           choice_.tools[i].shape, choice_.tools[i].diameter);
        if (choice_.tools[i].corner_radius > 0) {
            out += fmt::format("corner_radius = {}\n", choice_.tools[i].corner_radius);
        }
        if (choice_.feeds[i] != choice_.feeds.back()) {
            out += fmt::format("feed = {}\nplunge_feed = {}\n", choice_.feeds[i],
                               choice_.plunge_feeds[i]);
        }
    }
    out += fmt::format("\n[cutting]\nfeed = {}\nplunge_feed = {}\nspindle = {}\n",
                       choice_.feeds.back(), choice_.plunge_feeds.back(), choice_.spindle);
    out += fmt::format("\n[stock]\ntop = {}\n", choice_.top);
    if (!is_pocket() && choice_.bottom < choice_.top) {
        out += fmt::format("bottom = {}\n", choice_.bottom);
    }
    return out + fmt::format("clearance = {}\n", choice_.clearance) + placing_toml() +
           operation_toml();
}

// One number where it is the same for all tools, else one for each, in their order.
std::string OneLineWriter::said_of_tools(const std::vector<double>& values) const
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
            fmt::format("{:.6g} ({})", values[i], words_of(choice_.tools[i], request_.inch)));
    }
    return fmt::format("{}", fmt::join(each, ", "));
}

std::string OneLineWriter::said_feeds() const
{
    std::vector<std::string> chosen;
    const auto note = [&](const std::optional<double>& asked, const char* option) {
        if (!asked) {
            chosen.emplace_back(option);
        }
    };
    note(request_.feed, "--feed");
    note(request_.plunge_feed, "--plunge-feed");
    note(request_.spindle, "--spindle");
    std::string out = fmt::format("feed {} {}/min, plunge feed {}, spindle {:.6g} rpm",
                                  said_of_tools(choice_.feeds), choice_.unit,
                                  said_of_tools(choice_.plunge_feeds), choice_.spindle);
    if (!chosen.empty()) {
        out += fmt::format(": defaults; set them for your material by {}", fmt::join(chosen, " "));
    }
    return out;
}

std::string OneLineWriter::said_roughing() const
{
    if (!choice_.roughs) {
        return !request_.roughing         ? "roughing: none, as requested"
               : choice_.tools.size() > 1 ? "roughing: none, there is nothing above the allowance"
                                          : "roughing: none, the part is no deeper than one cut";
    }
    std::vector<std::string> names;
    for (const NamedTool& tool : choice_.roughing_tools()) {
        names.push_back(words_of(tool, request_.inch));
    }
    return fmt::format("roughing: {}, layers of at most {:.6g} {}{}, leaves {:.6g}{}",
                       fmt::join(names, ", "), choice_.max_depth, choice_.unit,
                       request_.max_depth ? "" : " (half the diameter; --max-depth)",
                       choice_.allowance, request_.allowance ? "" : " (--allowance)");
}

std::vector<std::string> OneLineWriter::said() const
{
    const Vec3d size = choice_.part.size();
    const bool names_unit = std::none_of(request_.parts.begin(), request_.parts.end(), lacks_unit);
    const std::string what = is_pocket() ? "floor" : "part";
    return {fmt::format("{}: {} x {} {} from above, {} deep; {}", what, choice_.words(size.x),
                        choice_.words(size.y), choice_.unit, choice_.words(size.z),
                        names_unit ? "the unit is the file's own"
                                   : fmt::format("the file names no unit, {} is assumed (--units)",
                                                 choice_.unit)),
            fmt::format("stock: x {} to {}, y {} to {}, top z = {}{}; cut down to z = {}",
                        choice_.words(choice_.part.low.x), choice_.words(choice_.part.high.x),
                        choice_.words(choice_.part.low.y), choice_.words(choice_.part.high.y),
                        choice_.words(choice_.top),
                        request_.stock_top ? ""
                        : is_pocket()      ? " (0 or the floor's top; --stock-top)"
                                           : " (the part's; --stock-top)",
                        choice_.words(choice_.part.low.z)),
            said_feeds(), said_roughing(),
            fmt::format("finish: {}, {}, scallop {:.6g} {}, tolerance {:.6g}{}, {}",
                        choice_.strategy, words_of(choice_.tools.back(), request_.inch),
                        *request_.scallop, choice_.unit, choice_.tolerance,
                        request_.tolerance ? "" : " (--tolerance)", request_.output)};
}

}  // namespace

OneLineJob one_line_job(const OneLineRequest& request,
                        const job::Strategies& strategies,
                        PartFiles& parts)
{
    const OneLineChoice choice = choose(request, strategies, parts);
    const OneLineWriter writer{request, choice};
    return {writer.toml(), writer.said()};
}

}  // namespace cusp::import
