// A bounding volume hierarchy over triangles: the common ground of closest points, rays and winding numbers.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "lattice/triangle_mesh.h"

namespace meshless_cutting {

/// Binary tree over the triangles of a mesh that outlives it. Deterministic: the split depends on the mesh alone.
class TriangleTree {
 public:
  struct Node {
    Eigen::AlignedBox3d box;
    int left = -1;  // children of an inner node; -1 in a leaf
    int right = -1;
    int first = 0;  // the triangles below this node: order()[first] .. order()[last - 1]
    int last = 0;
    bool is_leaf() const { return left < 0; }
  };

  explicit TriangleTree(const TriangleMesh& mesh);

  const TriangleMesh& mesh() const { return *mesh_; }
  /// Node 0 is the root; children come after their parent. Empty when the mesh has no triangle.
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Triangle indices in leaf order.
  const std::vector<int>& order() const { return order_; }
  /// Corner positions of a triangle.
  std::array<Eigen::Vector3d, 3> corners(int triangle) const {
    const auto& t = mesh_->triangles[triangle];
    return {mesh_->vertices[t[0]], mesh_->vertices[t[1]], mesh_->vertices[t[2]]};
  }

 private:
  int Build(int first, int last, const std::vector<Eigen::Vector3d>& centres);

  const TriangleMesh* mesh_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace meshless_cutting
