#include "lattice/triangle_tree.h"

#include <algorithm>
#include <numeric>

namespace meshless_cutting {
namespace {

constexpr int kLeafSize = 4;

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) : mesh_(&mesh), order_(mesh.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Eigen::Vector3d> centres(mesh.triangles.size());
  for (size_t i = 0; i < centres.size(); ++i) {
    const auto [a, b, c] = corners(static_cast<int>(i));
    centres[i] = (a + b + c) / 3;
  }
  nodes_.reserve(mesh.triangles.size());
  if (!order_.empty()) Build(0, static_cast<int>(order_.size()), centres);
}

int TriangleTree::Build(int first, int last, const std::vector<Eigen::Vector3d>& centres) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.first = first;
  node.last = last;
  Eigen::AlignedBox3d spread;
  for (int i = first; i < last; ++i) {
    for (const Eigen::Vector3d& p : corners(order_[i])) node.box.extend(p);
    spread.extend(centres[order_[i]]);
  }
  if (last - first > kLeafSize) {
    int axis = 0;
    spread.sizes().maxCoeff(&axis);
    const int middle = first + (last - first) / 2;
    // The index breaks ties, so that the tree does not depend on the library's nth_element.
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int i, int j) {
      return centres[i][axis] != centres[j][axis] ? centres[i][axis] < centres[j][axis] : i < j;
    });
    std::sort(order_.begin() + first, order_.begin() + middle);
    std::sort(order_.begin() + middle, order_.begin() + last);
    node.left = Build(first, middle, centres);
    node.right = Build(middle, last, centres);
  }
  nodes_[index] = node;
  return index;
}

}  // namespace meshless_cutting
