// Post-order of the loop tree, deepest branch first.
#include "host_tools/cam/clearing/cutting_order.hpp"

#include <algorithm>

namespace cusp::clearing {

namespace {

constexpr int kNone = -1;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<int> cutting_order(const std::vector<int>& parents)
{
    const int n = static_cast<int>(parents.size());
    std::vector<int> height(parents.size(), 0);
    std::vector<std::vector<int>> children(parents.size());
    std::vector<int> roots;
    for (int i = n - 1; i >= 0; --i) {
        const int parent = parents[at(i)];
        if (parent == kNone) {
            roots.push_back(i);
            continue;
        }
        children[at(parent)].push_back(i);
        height[at(parent)] = std::max(height[at(parent)], height[at(i)] + 1);
    }
    const auto first_cut_last = [&](std::vector<int>& siblings) {
        std::sort(siblings.begin(), siblings.end(), [&](int a, int b) {
            return height[at(a)] != height[at(b)] ? height[at(a)] < height[at(b)] : a < b;
        });
    };
    // The reverse of "root, then its children, last cut first" is "children, then root".
    std::vector<int> order;
    std::vector<int> stack;
    first_cut_last(roots);
    std::reverse(roots.begin(), roots.end());
    stack.insert(stack.end(), roots.begin(), roots.end());
    while (!stack.empty()) {
        const int node = stack.back();
        stack.pop_back();
        order.push_back(node);
        first_cut_last(children[at(node)]);
        for (auto child = children[at(node)].rbegin(); child != children[at(node)].rend();
             ++child) {
            stack.push_back(*child);
        }
    }
    std::reverse(order.begin(), order.end());
    return order;
}

}  // namespace cusp::clearing
