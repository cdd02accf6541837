#include "scene/closest_key.h"

#include <algorithm>
#include <cctype>

namespace meshless_cutting {
namespace {

bool SameLetter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

}  // namespace

int EditDistance(const std::string& a, const std::string& b) {
  const int rows = static_cast<int>(a.size()) + 1;
  const int columns = static_cast<int>(b.size()) + 1;
  std::vector<std::vector<int>> edits(rows, std::vector<int>(columns, 0));
  for (int i = 0; i < rows; ++i) edits[i][0] = i;
  for (int j = 0; j < columns; ++j) edits[0][j] = j;
  for (int i = 1; i < rows; ++i) {
    for (int j = 1; j < columns; ++j) {
      const int replace = edits[i - 1][j - 1] + (SameLetter(a[i - 1], b[j - 1]) ? 0 : 1);
      edits[i][j] = std::min({edits[i - 1][j] + 1, edits[i][j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && SameLetter(a[i - 1], b[j - 2]) && SameLetter(a[i - 2], b[j - 1]);
      if (swapped) edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
    }
  }
  return edits[rows - 1][columns - 1];
}

std::string ClosestKey(const std::string& word, const std::vector<std::string>& candidates) {
  std::string closest;
  int least = std::max(2, static_cast<int>(word.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    int distance = EditDistance(word, candidate);
    // A unit left out or a word cut short: `cell_size` for `cell_size_m`.
    const bool prefix = word.size() >= 4 && candidate.compare(0, word.size(), word) == 0;
    if (prefix) distance = 1;
    if (distance < least) {
      least = distance;
      closest = candidate;
    }
  }
  return closest;
}

}  // namespace meshless_cutting
