// "Did you mean ...?" for misspelt keys.
#pragma once

#include <string>
#include <vector>

namespace meshless_cutting {

/// Edits (insert, remove, replace, swap neighbours) that turn `a` into `b`; upper and lower case count as equal.
int EditDistance(const std::string& a, const std::string& b);

/// The candidate nearest to `word`, or empty when none is near enough to have been meant.
std::string ClosestKey(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace meshless_cutting
