#include "dynamics/contact_term.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

/// Depth that the object's own pressure may press a vertex in, m. Smaller is stiffer and harder to solve.
constexpr double kRestingDepth = 4e-4;

/// Contact is at least so many times as stiff as the cell behind it, so that no body is much stiffer than its contact.
constexpr double kStiffnessRatio = 1;

/// Time constant of the damping while touching, s: about half of critical for a tray's load of tissue.
constexpr double kDampingTime = 0.005;

/// The part of v along the face.
Eigen::Vector3d Across(const HalfSpace& face, const Eigen::Vector3d& v) { return v - face.normal.dot(v) * face.normal; }

}  // namespace

ContactTerm::ContactTerm(const std::vector<ObstacleConfig>& obstacles, const ContactScale& scale)
    : stiffness_per_area_(
          std::max(kStiffnessRatio * scale.modulus_pa / scale.cell_m, scale.own_pressure_pa / kRestingDepth)),
      cell_(scale.cell_m) {
  for (const ObstacleConfig& obstacle : obstacles) obstacles_.emplace_back(obstacle);
}

void ContactTerm::SetSkin(const SurfacePoints& skin, int particles, bool changed) {
  skin_ = &skin;
  if (!changed && arranged_.share.size() == static_cast<std::size_t>(skin.count())) return;
  arranged_.Build(skin, particles);
  memory_.resize(skin.count());
  candidates_.reserve(obstacles_.size() * skin.count());
  active_.reserve(obstacles_.size() * skin.count());
  active_tangent_.reserve(obstacles_.size() * skin.count());
}

Eigen::Vector3d ContactTerm::PositionOf(int vertex, const Field& y) const {
  const std::size_t first = static_cast<std::size_t>(vertex) * skin_->support_size;
  Vector4 sum;
  for (int k = 0; k < skin_->support_size; ++k) sum += skin_->weights[first + k] * y[skin_->particles[first + k]];
  return sum.vector();
}

Eigen::Vector3d ContactTerm::EndOf(const Candidate& c, const Field& y) const {
  return c.start + (PositionOf(c.vertex, y) - c.start) / stage_;
}

void ContactTerm::AddCandidate(int vertex, int obstacle, const StageMotion& motion) {
  const Memory& memory = memory_[vertex];
  const bool touched = memory.step == step_ && memory.obstacle == obstacle;
  const Eigen::Vector3d x = PositionOf(vertex, *motion.start);
  Candidate c;
  c.vertex = vertex;
  c.obstacle = obstacle;
  c.face = obstacles_[obstacle].ChooseFace(x, touched ? memory.face : Obstacle::kNoFace);
  c.stiffness = stiffness_per_area_ * cell_ * cell_ * arranged_.share[vertex];
  c.touched = touched && memory.face == c.face;
  c.stuck = c.touched && memory.stuck;
  c.friction_force = c.touched ? obstacles_[obstacle].friction() * memory.normal_force : 0;
  c.anchor = c.touched ? memory.anchor : x;
  c.start = x;
  candidates_.push_back(c);
}

void ContactTerm::BeginStep(const StageMotion& motion) {
  stage_ = motion.stage;
  damping_per_stiffness_ = kDampingTime / motion.step_s;
  candidates_.clear();
  active_.clear();
  Eigen::AlignedBox3d bounds;
  for (const Vector4& x : *motion.start) bounds.extend(x.vector());
  // A vertex lies within a cell of the particle that it hangs on, and cells may be stretched.
  const double margin = 4 * cell_ + motion.reach;
  for (int o = 0; o < static_cast<int>(obstacles_.size()); ++o) {
    if (!obstacles_[o].Near(bounds, margin)) continue;
    for (int j = 0; j + 1 < static_cast<int>(arranged_.begin.size()); ++j) {
      if (arranged_.begin[j] == arranged_.begin[j + 1]) continue;
      if (obstacles_[o].Distance((*motion.start)[j].vector()) > margin) continue;
      for (int n = arranged_.begin[j]; n < arranged_.begin[j + 1]; ++n) AddCandidate(arranged_.vertices[n], o, motion);
    }
  }
}

double ContactTerm::Evaluate(const Field& y, Field& gradient) {
  double energy = 0;
  const int K = skin_->support_size;
  for (const Candidate& c : candidates_) {
    const HalfSpace& face = obstacles_[c.obstacle].face(c.face);
    const Eigen::Vector3d x = EndOf(c, y);
    const double gap = face.Gap(x);
    if (gap >= 0 && !c.touched) continue;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    if (gap < 0) {
      energy += 0.5 * c.stiffness * gap * gap;
      force = c.stiffness * gap * face.normal;
    }
    if (c.touched) {
      const double damping = c.stiffness * damping_per_stiffness_;
      Eigen::Vector3d way = x - c.start;
      if (!c.stuck) way = face.normal.dot(way) * face.normal;
      energy += 0.5 * damping * way.squaredNorm();
      force += damping * way;
    }
    if (c.friction_force > 0) {
      const Eigen::Vector3d t = Across(face, x - c.anchor);
      const double length = t.norm();
      if (c.stiffness * length <= c.friction_force) {
        energy += 0.5 * c.stiffness * length * length;
        force += c.stiffness * t;
      } else {
        energy += c.friction_force * (length - 0.5 * c.friction_force / c.stiffness);
        force += (c.friction_force / length) * t;
      }
    }
    const Vector4 f = Vector4::From(force);
    const std::size_t first = static_cast<std::size_t>(c.vertex) * K;
    for (int k = 0; k < K; ++k) gradient[skin_->particles[first + k]] += skin_->weights[first + k] * f;
  }
  return stage_ * energy;
}

Eigen::Matrix3d ContactTerm::TangentOf(const Candidate& c, const Eigen::Vector3d& x) const {
  const HalfSpace& face = obstacles_[c.obstacle].face(c.face);
  const Eigen::Matrix3d along = face.normal * face.normal.transpose();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
  const double damping = c.stiffness * damping_per_stiffness_;
  Eigen::Matrix3d tangent = ((face.Gap(x) < 0 ? c.stiffness : 0) + (c.touched ? damping : 0)) * along;
  if (c.stuck) tangent += damping * across;
  if (c.friction_force > 0) {
    const Eigen::Vector3d t = Across(face, x - c.anchor);
    const double length = t.norm();
    if (c.stiffness * length <= c.friction_force) {
      tangent += c.stiffness * across;
    } else {
      tangent += (c.friction_force / length) * (across - t * t.transpose() / (length * length));
    }
  }
  return tangent / stage_;
}

void ContactTerm::Linearise(const Field& y) {
  active_.clear();
  active_tangent_.clear();
  for (int n = 0; n < static_cast<int>(candidates_.size()); ++n) {
    const Candidate& c = candidates_[n];
    const Eigen::Vector3d x = EndOf(c, y);
    if (!c.touched && obstacles_[c.obstacle].face(c.face).Gap(x) >= 0) continue;
    active_.push_back(n);
    active_tangent_.push_back(TangentOf(c, x));
  }
}

void ContactTerm::AddProduct(const Field& p, Field& q) {
  const int K = skin_->support_size;
  for (std::size_t n = 0; n < active_.size(); ++n) {
    const std::size_t first = static_cast<std::size_t>(candidates_[active_[n]].vertex) * K;
    const int* particles = &skin_->particles[first];
    const double* weights = &skin_->weights[first];
    Vector4 sum;
    for (int k = 0; k < K; ++k) sum += weights[k] * p[particles[k]];
    const Vector4 f = Vector4::From(active_tangent_[n] * sum.vector());
    for (int k = 0; k < K; ++k) q[particles[k]] += weights[k] * f;
  }
}

void ContactTerm::AddDiagonal(BlockField& blocks) {
  const int K = skin_->support_size;
  for (std::size_t n = 0; n < active_.size(); ++n) {
    const Eigen::Matrix3d& tangent = active_tangent_[n];
    const std::size_t first = static_cast<std::size_t>(candidates_[active_[n]].vertex) * K;
    for (int k = 0; k < K; ++k) {
      const double w = skin_->weights[first + k] * skin_->weights[first + k];
      SymmetricBlock& block = blocks[skin_->particles[first + k]];
      block.xx += w * tangent(0, 0);
      block.yy += w * tangent(1, 1);
      block.zz += w * tangent(2, 2);
      block.xy += w * tangent(0, 1);
      block.xz += w * tangent(0, 2);
      block.yz += w * tangent(1, 2);
    }
  }
}

void ContactTerm::AddCoarse(CoarseMatrix& matrix) {
  const int K = skin_->support_size;
  const Aggregates& aggregates = matrix.aggregates();
  for (std::size_t n = 0; n < active_.size(); ++n) {
    const std::size_t first = static_cast<std::size_t>(candidates_[active_[n]].vertex) * K;
    for (int k = 0; k < K; ++k) {
      const int jk = skin_->particles[first + k], a = aggregates.of_particle[jk];
      if (a < 0) continue;
      for (int l = 0; l < K; ++l) {
        const int jl = skin_->particles[first + l], b = aggregates.of_particle[jl];
        if (b < matrix.first_coupled(a) || b > a) continue;
        const double* bk = &aggregates.basis[jk].x;
        const double* bl = &aggregates.basis[jl].x;
        for (int f = 0; f < CoarseMatrix::kFunctions; ++f) {
          for (int g = 0; g < CoarseMatrix::kFunctions; ++g) {
            const double weight = skin_->weights[first + k] * skin_->weights[first + l] * bk[f] * bl[g];
            const Eigen::Matrix3d block = weight * active_tangent_[n];  // symmetric: rows or columns alike
            matrix.Add(a, f, b, g, block.data());
          }
        }
      }
    }
  }
}

void ContactTerm::EndStep(const Field& y) {
  ++step_;
  contact_count_ = 0;
  for (const Candidate& c : candidates_) {
    const HalfSpace& face = obstacles_[c.obstacle].face(c.face);
    const Eigen::Vector3d x = EndOf(c, y);
    const double gap = face.Gap(x);
    if (gap >= 0) continue;
    ++contact_count_;
    Memory& memory = memory_[c.vertex];
    memory.step = step_;
    memory.obstacle = c.obstacle;
    memory.face = c.face;
    memory.normal_force = -c.stiffness * gap;
    memory.anchor = c.anchor;
    // Where the spring has yielded, the anchor is dragged along.
    const Eigen::Vector3d t = Across(face, x - c.anchor);
    const double length = t.norm(), limit = obstacles_[c.obstacle].friction() * memory.normal_force / c.stiffness;
    memory.stuck = length <= limit;
    if (!memory.stuck) memory.anchor += (1 - limit / length) * t;
  }
}

}  // namespace meshless_cutting
