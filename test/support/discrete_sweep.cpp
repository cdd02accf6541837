#include "support/discrete_sweep.h"

#include <Eigen/Geometry>
#include <array>

#include "cut/soft_body.h"

namespace meshless_cutting {
namespace {

/// Whether the segment pq meets the triangle (Möller & Trumbore 1997).
bool Meets(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const std::array<Eigen::Vector3d, 3>& triangle) {
  const Eigen::Vector3d e1 = triangle[1] - triangle[0], e2 = triangle[2] - triangle[0], d = q - p;
  const Eigen::Vector3d h = d.cross(e2);
  const double a = e1.dot(h);
  if (a == 0) return false;
  const Eigen::Vector3d s = p - triangle[0];
  const double u = s.dot(h) / a;
  const Eigen::Vector3d r = s.cross(e1);
  const double v = d.dot(r) / a, t = e2.dot(r) / a;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

}  // namespace

void DiscreteSweep::Before(const Simulation& simulation) {
  const SoftBody& body = simulation.body();
  object_.resize(body.lattice().vertices.size());
  for (size_t v = 0; v < object_.size(); ++v) object_[v] = body.motion().At(static_cast<int>(v)).end;
  was_cut_.resize(body.lattice().links.size());
  for (size_t l = 0; l < was_cut_.size(); ++l) was_cut_[l] = body.graph().IsCut(static_cast<int>(l));
  blade_ = simulation.blade(tool_);
}

void DiscreteSweep::After(const Simulation& simulation) {
  const SoftBody& body = simulation.body();
  const std::vector<Eigen::Vector3d> blade = simulation.blade(tool_);
  const bool swept = blade_.size() == blade.size();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : blade_) box.extend(x);
  for (const Eigen::Vector3d& x : blade) box.extend(x);
  for (size_t l = 0; l < was_cut_.size(); ++l) {
    if (was_cut_[l]) continue;
    const bool touched = body.graph().IsCut(static_cast<int>(l));
    const auto& [a, b] = body.lattice().links[l];
    bool found = false;
    if (swept && box.intersects(Eigen::AlignedBox3d(object_[a].cwiseMin(object_[b]), object_[a].cwiseMax(object_[b]))))
      for (size_t e = 0; e + 1 < blade.size() && !found; ++e)
        found = Meets(object_[a], object_[b], {blade_[e], blade_[e + 1], blade[e]}) ||
                Meets(object_[a], object_[b], {blade_[e + 1], blade[e + 1], blade[e]});
    both_ += touched && found;
    missed_ += touched && !found;
    wrong_ += found && !touched;
  }
}

}  // namespace meshless_cutting
