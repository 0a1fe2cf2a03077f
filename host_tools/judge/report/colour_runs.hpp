// Maps of squares with few strokes: a run of one colour along a column is one stroke.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fmt/format.h"

namespace cusp::report {

// Squares are added column by column, upwards. All runs of a colour are one path with integer
// coordinates, a tenth of the size of single rectangles.
class ColourRuns {
public:
    static constexpr int kNothing = -1;

    explicit ColourRuns(int colours) : paths_(static_cast<std::size_t>(colours)) {}

    // colour  0 to colours - 1, or kNothing
    void add(std::size_t column, std::size_t row, int colour)
    {
        if (column != column_ || row != end_ || colour != colour_) {
            finish();
            column_ = column;
            begin_ = row;
            colour_ = colour;
        }
        end_ = row + 1;
    }

    // x, y        of the lower left corner of the first square, `side` of a square, in the picture
    // attributes  of the path of a colour
    template <class Attributes>
    std::string text(double x, double y, double side, const Attributes& attributes)
    {
        finish();
        constexpr double kOverlap = 1.05;  // avoids gaps between neighbours
        std::string out = fmt::format(
            "<g transform=\"translate({:.4f} {:.4f}) scale({:.6f} {:.6f})\" fill=\"none\" "
            "stroke-width=\"{}\">\n",
            x + side / 2, y, side, -side, kOverlap);
        for (std::size_t k = 0; k < paths_.size(); ++k) {
            if (!paths_[k].empty()) {
                out += fmt::format("<path {} d=\"{}\"/>\n", attributes(static_cast<int>(k)),
                                   paths_[k]);
            }
        }
        return out + "</g>\n";
    }

private:
    void finish()
    {
        if (colour_ != kNothing) {
            paths_[static_cast<std::size_t>(colour_)] +=
                fmt::format("M{} {}v{}", column_, begin_, end_ - begin_);
        }
        colour_ = kNothing;
    }

    std::vector<std::string> paths_;
    std::size_t column_{};
    std::size_t begin_{};
    std::size_t end_{};
    int colour_{kNothing};
};

}  // namespace cusp::report
