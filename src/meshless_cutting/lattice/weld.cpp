#include "lattice/weld.h"

#include <algorithm>
#include <numeric>

namespace meshless_cutting {

TriangleMesh WeldEqualVertices(const TriangleMesh& mesh) {
  const int count = static_cast<int>(mesh.vertices.size());
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&](int i, int j) {
    const Eigen::Vector3d& p = mesh.vertices[i];
    const Eigen::Vector3d& q = mesh.vertices[j];
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] != q[axis]) return p[axis] < q[axis];
    }
    return false;
  };
  std::stable_sort(order.begin(), order.end(), less);
  std::vector<int> representative(count);
  for (int i = 0; i < count; ++i) {
    representative[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? representative[order[i - 1]] : order[i];
  }
  TriangleMesh welded;
  std::vector<int> index(count, -1);
  for (const auto& triangle : mesh.triangles) {
    std::array<int, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = representative[triangle[k]];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (int& corner : corners) {
      if (index[corner] < 0) {
        index[corner] = static_cast<int>(welded.vertices.size());
        welded.vertices.push_back(mesh.vertices[corner]);
      }
      corner = index[corner];
    }
    welded.triangles.push_back(corners);
  }
  return welded;
}

}  // namespace meshless_cutting
