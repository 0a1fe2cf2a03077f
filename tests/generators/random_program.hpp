// Random G-code in the style of CAM systems: rounded decimals, inches, arcs in all planes, splines.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::test {

// A program in absolute coordinates within about a metre of zero, without M2 or M30.
class RandomProgram {
public:
    explicit RandomProgram(std::uint64_t seed) : random_{seed}, turns_{seed}
    {
        inches_ = number() % 4 == 0;
        decimals_ = static_cast<int>(2 + number() % 4);
        line(inches_ ? "G20 G90" : "G21 G90");
        choose_control();
        scale_ = std::pow(10, between(-2, 1.5));
        choose_feed();
        const auto count = 1 + number() % 15;
        for (std::uint64_t i = 0; i < count; ++i) {
            add();
        }
    }

    const std::vector<std::string>& lines() const { return lines_; }

private:
    void add()
    {
        switch (number() % 9) {
            case 0:
                scale_ = std::pow(10, between(-2, 1.5));
                choose_feed();
                choose_control();
                break;
            case 1:
                to(at_ + any() * scale_, "G0");
                break;
            case 2:
            case 3:
                to(at_ + any() * scale_, "G1");
                break;
            case 4:
                add_dense_lines();
                break;
            case 5:
                add_arc();
                break;
            case 6:
                add_uniform_nurbs();
                break;
            default:
                add_nurbs();
                break;
        }
    }

    // Bounded from below, so that no program takes an hour.
    void choose_feed()
    {
        const double feed = std::max(std::pow(10, between(1, 3.9)), 5 * scale_);
        line("F" + value(inches_ ? feed / 25.4 : feed, 1));
    }

    void choose_control()
    {
        switch (number() % 3) {
            case 0:
                line("G61");
                break;
            case 1:
                line("G64 P" + value(std::pow(10, between(-3, -1)), 4));
                break;
            default:
                break;
        }
    }

    // Chords of a sine in a random direction.
    void add_dense_lines()
    {
        const Vec3d along = any();
        const Vec3d across = any();
        const auto chords = 10 + number() % 60;
        const double chord = between(0.02, 0.6);
        const double wave = between(0.5, 5) / chord;
        const double height = between(0, 0.3) / wave;
        const Vec3d from = at_;
        for (std::uint64_t i = 1; i <= chords; ++i) {
            const double s = chord * static_cast<double>(i);
            to(from + along * s + across * (height * std::sin(wave * s)), "G1");
        }
    }

    void add_arc()
    {
        constexpr std::array<const char*, 3> kPlanes = {"G17", "G18", "G19"};
        // First and second axis of each plane, and their offset words.
        constexpr std::array<std::array<unsigned, 2>, 3> kAxes = {{{0, 1}, {2, 0}, {1, 2}}};
        const auto plane = number() % 3;
        const unsigned first = kAxes[plane][0];
        const unsigned second = kAxes[plane][1];
        const double radius = std::max(0.05, scale_ * between(0.1, 1));
        const double from = between(-3.14, 3.14);
        const double sweep = between(0.1, 6.1);
        const bool clockwise = number() % 2 == 0;
        const double to_angle = clockwise ? from - sweep : from + sweep;
        // Number of decimals with which both radii agree within the limit of the dialect, 0.005 mm:
        // four of an inch round them apart by up to 0.0054 mm.
        const int digits = decimals_;
        decimals_ = std::max(decimals_, inches_ ? 5 : 4);
        Vec3d end = at_;
        end[first] += radius * (std::cos(to_angle) - std::cos(from));
        end[second] += radius * (std::sin(to_angle) - std::sin(from));
        if (number() % 2 == 0) {
            end[3 - first - second] += between(-1, 1) * radius;
        }
        const char letters[] = "IJK";
        std::string words = std::string{kPlanes[plane]} + (clockwise ? " G2" : " G3");
        std::string offsets = std::string{" "} + letters[first] + length(-radius * std::cos(from)) +
                              " " + letters[second] + length(-radius * std::sin(from));
        to(end, words, offsets);
        decimals_ = digits;
    }

    void add_uniform_nurbs()
    {
        const auto order = 2 + number() % 4;
        const auto points = order + number() % 8;
        line("G5.2 P" + weight() + " L" + std::to_string(order));
        for (std::uint64_t i = 1; i < points; ++i) {
            to(at_ + any() * (scale_ * between(0.05, 1)), "", " P" + weight());
        }
        line("G5.3");
    }

    void add_nurbs()
    {
        const auto order = 2 + number() % 4;
        const auto points = order + number() % 8;
        const bool even = number() % 2 == 0;
        to(at_, "G1");  // the first point is the current position, in the program's decimals
        double knot = 0;
        std::uint64_t repeated = 1;
        for (std::uint64_t i = 0; i < points; ++i) {
            if (i >= order) {
                const bool repeat = i > order && number() % 5 == 0 && repeated + 1 < order;
                repeated = repeat ? repeated + 1 : 1;
                knot += repeat ? 0 : even ? 1 : between(0.1, 2);
            }
            const std::string words = " R" + weight() + " K" + value(knot, 4);
            if (i == 0) {
                to(at_, "G6.2 P" + std::to_string(order), words);
            } else {
                to(at_ + any() * (scale_ * between(0.05, 1)), "", words);
            }
        }
        knot += even ? 1 : between(0.1, 2);
        for (std::uint64_t i = 0; i < order; ++i) {
            line("K" + value(knot, 4));
        }
    }

    // To `end`, rounded to the program's decimals.
    void to(Vec3d end, const std::string& words, const std::string& more = "")
    {
        std::string text = words;
        const char letters[] = "XYZ";
        for (unsigned axis = 0; axis < 3; ++axis) {
            const std::string number = length(std::clamp(end[axis], -500.0, 500.0));
            at_[axis] = std::stod(number) * (inches_ ? 25.4 : 1);
            text += std::string{" "} + letters[axis] + number;
        }
        line(text + turn_for(words) + more);
    }

    // Lines and arcs turn A too, if the machine has it: some by little, some far.
    std::string turn_for(const std::string& words)
    {
        const bool is_curve = words.empty() || words.substr(0, 4) == "G6.2";
        if (!kHasRotaryAxis || is_curve || turns_() % 3 == 0) {
            return "";
        }
        std::uniform_real_distribution<double> exponent{-2, 2};
        std::normal_distribution<double> size;
        turn_ += size(turns_) * std::pow(10, exponent(turns_));
        return " A" + value(turn_, decimals_);
    }

    void line(const std::string& text) { lines_.push_back(text); }

    std::string length(double mm) const { return value(inches_ ? mm / 25.4 : mm, decimals_); }
    std::string weight() { return number() % 2 == 0 ? "1" : value(std::pow(4, between(-1, 1)), 3); }
    static std::string value(double x, int decimals)
    {
        char text[40];
        std::snprintf(text, sizeof text, "%.*f", decimals, x);
        return text;
    }

    Vec3d any()
    {
        const Vec3d a{between(-1, 1), between(-1, 1), number() % 2 == 0 ? 0 : between(-1, 1)};
        return a / std::max(norm(a), 1e-3);
    }
    double between(double low, double high)
    {
        return std::uniform_real_distribution<double>{low, high}(random_);
    }
    std::uint64_t number() { return random_(); }

    std::mt19937_64 random_;
    std::mt19937_64 turns_;  // of A alone: the rest of a program is the same without it
    std::vector<std::string> lines_;
    Vec3d at_{};
    double turn_{0};
    double scale_{1};
    int decimals_{3};
    bool inches_{false};
};

}  // namespace cusp::test
