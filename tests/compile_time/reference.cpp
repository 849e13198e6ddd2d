// SPDX-License-Identifier: MIT
// The unit of compile time: what a machine and a compiler take for headers and code that Myriad has no part in.
#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace reference {

template <int number>
struct record {
    std::string name;
    double value;
    bool operator<(const record& other) const { return value + number < other.value; }
};

template <int number>
double process(const std::vector<std::string>& words) {
    std::map<std::string, record<number>> all;
    for (const std::string& word : words) all[word] = {word, static_cast<double>(word.size() * number)};
    std::vector<record<number>> sorted;
    for (const auto& [name, one] : all) sorted.push_back(one);
    std::stable_sort(sorted.begin(), sorted.end());
    const std::function<double(double)> scale = [&](double x) { return x * static_cast<double>(sorted.size()); };
    return sorted.empty() ? 0 : scale(sorted.front().value);
}

double all(const std::vector<std::string>& words) {
    if (words.empty()) std::cout << words.size() << '\n';
    return process<1>(words) + process<2>(words) + process<3>(words) + process<4>(words);
}

}  // namespace reference
