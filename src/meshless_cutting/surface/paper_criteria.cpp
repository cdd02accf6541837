#include "surface/paper_criteria.h"

#include <algorithm>
#include <utility>

namespace meshless_cutting {
namespace {

// How many cells away a point may be. The criteria of the paper have no limit; beyond this a mapping would be wrong
// whatever side it is on.
constexpr int kReachCells = 2;

}  // namespace

void PaperCriteria::Count(const Eigen::Vector3d& X, const std::vector<int>& own, const Criteria& criteria) {
  const Eigen::Vector3i centre = grid_->CellCoordinates(grid_->CellAt(X));
  const Eigen::Vector3i low = (centre.array() - kReachCells).max(0);
  const Eigen::Vector3i high = (centre.array() + kReachCells).min(grid_->cells().array() - 1);
  std::vector<std::pair<double, int>> near;
  Eigen::Vector3i c;
  for (c[2] = low[2]; c[2] <= high[2]; ++c[2])
    for (c[1] = low[1]; c[1] <= high[1]; ++c[1])
      for (c[0] = low[0]; c[0] <= high[0]; ++c[0])
        for (int p : points_->InCell(grid_->CellIndex(c)))
          near.emplace_back((points_->points()[p].centroid - X).squaredNorm(), p);
  std::sort(near.begin(), near.end());

  auto has = [](const std::vector<int>& sorted, int p) { return std::binary_search(sorted.begin(), sorted.end(), p); };
  auto is_across = [&](auto entry) {
    const int p = entry->second;
    return !has(own, p) &&
           std::none_of(own.begin(), own.end(), [&](int q) { return has(points_->Neighbours(q), p); });
  };
  ++counts_.mapped;
  auto at = near.begin();
  counts_.nearest += is_across(at);
  // Each criterion goes on from the choice of those before it.
  auto next = [&](const auto& meets, std::uint64_t& count) {
    at = std::find_if(at, near.end(), [&](const auto& entry) { return meets(entry.second); });
    if (at != near.end()) count += is_across(at);
  };
  auto tangent = [&](int p) { return criteria.tangent_plane(p); };
  auto cut = [&](int p) { return tangent(p) && criteria.cut_plane(p); };
  auto shared = [&](int p) { return cut(p) && criteria.shared_particle(p); };
  next(tangent, counts_.tangent_plane);
  next(cut, counts_.cut_plane);
  next(shared, counts_.shared_particle);
  counts_.none += at == near.end();
}

}  // namespace meshless_cutting
