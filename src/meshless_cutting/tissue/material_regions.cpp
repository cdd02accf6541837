#include "tissue/material_regions.h"

#include <memory>

#include "lattice/surface_orientation.h"
#include "lattice/triangle_tree.h"
#include "lattice/winding_number.h"

namespace meshless_cutting {
namespace {

/// The tree refers to the mesh, the winding number to the tree.
struct Inside {
  explicit Inside(const TriangleMesh& surface) : mesh(OrientOutward(surface)), tree(mesh), winding(tree) {}
  TriangleMesh mesh;
  TriangleTree tree;
  WindingNumber winding;
};

}  // namespace

MaterialRegions::MaterialRegions(const ObjectConfig& config) {
  density_.push_back(config.material.density_kg_m3);
  for (const MaterialRegion& region : config.regions) {
    density_.push_back(region.material.density_kg_m3);
    if (region.box) {
      regions_.push_back([box = *region.box](const Eigen::Vector3d& X) { return box.Holds(X, 0); });
    } else {
      const auto inside = std::make_shared<Inside>(ReadTriangleMesh(region.mesh, config.scale));
      regions_.push_back([inside](const Eigen::Vector3d& X) { return inside->winding(X) > 0.5; });
    }
  }
}

int MaterialRegions::At(const Eigen::Vector3d& X) const {
  for (std::size_t i = regions_.size(); i > 0; --i) {
    if (regions_[i - 1](X)) return static_cast<int>(i);
  }
  return 0;
}

}  // namespace meshless_cutting
