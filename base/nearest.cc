#include "base/nearest.h"

#include <algorithm>
#include <cctype>

namespace densify {
namespace {

// Optimal string alignment distance, in half edits.
int distance(std::string_view a, std::string_view b) {
  const auto same_letter = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  };
  std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = 2 * static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = 2 * static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char x = a[i - 1];
      const char y = b[j - 1];
      const int replace = x == y ? 0 : same_letter(x, y) ? 1 : 2;
      int best = std::min({cost[i - 1][j] + 2, cost[i][j - 1] + 2, cost[i - 1][j - 1] + replace});
      if (i > 1 && j > 1 && x == b[j - 2] && y == a[i - 2]) best = std::min(best, cost[i - 2][j - 2] + 2);
      cost[i][j] = best;
    }
  }
  return cost[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::optional<std::string> best;
  int best_distance = (2 * static_cast<int>(word.size()) + 1) / 3 + 1;
  for (const std::string& candidate : candidates) {
    const int d = distance(word, candidate);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::optional<std::string> near = nearest(word, candidates);
  return near ? "; did you mean \"" + *near + "\"?" : "";
}

}  // namespace densify
