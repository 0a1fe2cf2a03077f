// The yardstick of build_cost.py: headers that compilers are slow at, and no file of ours.
#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <string>
#include <unordered_map>
#include <vector>

std::map<std::string, std::vector<double>> numbers_of(const std::string& text)
{
    static const std::regex kNumber{"([A-Z])([-+]?[0-9]*[.]?[0-9]+)"};
    std::map<std::string, std::vector<double>> numbers;
    for (std::sregex_iterator at{text.begin(), text.end(), kNumber}, end; at != end; ++at) {
        numbers[(*at)[1]].push_back(std::stod((*at)[2]));
    }
    for (auto& [letter, values] : numbers) {
        std::stable_sort(values.begin(), values.end(), std::greater<>{});
    }
    return numbers;
}

std::unordered_map<std::string, std::function<double(double)>> functions()
{
    return {{"twice",
             [](double x) {
                 return 2.0 * x;
             }},
            {"square", [](double x) {
                 return x * x;
             }}};
}
