#include "dynamics/contact_term.h"

#include <algorithm>
#include <cmath>

namespace meshless_cutting {
namespace {

/// Depth that the object's own pressure may press a vertex in, m. Smaller is stiffer and harder to solve.
constexpr double kRestingDepth = 2e-4;

/// Contact is at least so many times as stiff as the cell behind it, so that no body is much softer than its contact.
constexpr double kStiffnessRatio = 2;

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
  candidates_.reserve(skin.count());
  active_.reserve(skin.count());
}

Eigen::Vector3d ContactTerm::PositionOf(int vertex, const Field& y) const {
  const std::size_t first = static_cast<std::size_t>(vertex) * skin_->support_size;
  Vector4 sum;
  for (int k = 0; k < skin_->support_size; ++k) sum += skin_->weights[first + k] * y[skin_->particles[first + k]];
  return sum.vector();
}

void ContactTerm::AddCandidate(int vertex, int obstacle, const StageMotion& motion) {
  const Memory& memory = memory_[vertex];
  const bool touched = memory.step == step_ - 1 && memory.obstacle == obstacle;
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
  c.still = PositionOf(vertex, *motion.still);
  c.normal_tangent = c.across_tangent = 0;
  candidates_.push_back(c);
}

void ContactTerm::BeginStep(const StageMotion& motion) {
  ++step_;
  rate_ = motion.rate;
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
    const Eigen::Vector3d x = PositionOf(c.vertex, y);
    const double gap = face.Gap(x);
    if (gap >= 0 && !c.touched) continue;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    if (gap < 0) {
      energy += 0.5 * c.stiffness * gap * gap;
      force = c.stiffness * gap * face.normal;
    }
    if (c.touched) {
      const double damping = c.stiffness * kDampingTime * rate_;
      Eigen::Vector3d way = x - c.still;
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
  return energy;
}

void ContactTerm::Linearise(const Field& y) {
  active_.clear();
  for (int n = 0; n < static_cast<int>(candidates_.size()); ++n) {
    Candidate& c = candidates_[n];
    const HalfSpace& face = obstacles_[c.obstacle].face(c.face);
    const Eigen::Vector3d x = PositionOf(c.vertex, y);
    c.normal_tangent = face.Gap(x) < 0 ? c.stiffness : 0;
    c.across_tangent = 0;
    const double damping = c.stiffness * kDampingTime * rate_;
    if (c.touched) c.normal_tangent += damping;
    if (c.stuck) c.across_tangent += damping;
    if (c.friction_force > 0) {
      // Of the yielding part, the secant: positive definite, and never softer than the true one.
      const double length = Across(face, x - c.anchor).norm();
      c.across_tangent += std::min(c.stiffness, c.friction_force / std::max(length, 1e-300));
    }
    if (c.normal_tangent > 0) active_.push_back(n);
  }
}

void ContactTerm::AddProduct(const Field& p, Field& q) {
  const int K = skin_->support_size;
  for (int n : active_) {
    const Candidate& c = candidates_[n];
    const Vector4 normal = Vector4::From(obstacles_[c.obstacle].face(c.face).normal);
    const std::size_t first = static_cast<std::size_t>(c.vertex) * K;
    const int* particles = &skin_->particles[first];
    const double* weights = &skin_->weights[first];
    Vector4 sum;
    for (int k = 0; k < K; ++k) sum += weights[k] * p[particles[k]];
    const Vector4 f = ((c.normal_tangent - c.across_tangent) * Dot(normal, sum)) * normal + c.across_tangent * sum;
    for (int k = 0; k < K; ++k) q[particles[k]] += weights[k] * f;
  }
}

void ContactTerm::AddDiagonal(BlockField& blocks) {
  const int K = skin_->support_size;
  for (int index : active_) {
    const Candidate& c = candidates_[index];
    const Eigen::Vector3d& n = obstacles_[c.obstacle].face(c.face).normal;
    const double a = c.normal_tangent - c.across_tangent, b = c.across_tangent;
    const std::size_t first = static_cast<std::size_t>(c.vertex) * K;
    for (int k = 0; k < K; ++k) {
      const double w = skin_->weights[first + k] * skin_->weights[first + k];
      SymmetricBlock& block = blocks[skin_->particles[first + k]];
      block.xx += w * (a * n.x() * n.x() + b);
      block.yy += w * (a * n.y() * n.y() + b);
      block.zz += w * (a * n.z() * n.z() + b);
      block.xy += w * a * n.x() * n.y();
      block.xz += w * a * n.x() * n.z();
      block.yz += w * a * n.y() * n.z();
    }
  }
}

void ContactTerm::AddCoarse(CoarseMatrix& matrix) {
  const int K = skin_->support_size;
  const Aggregates& aggregates = matrix.aggregates();
  for (int index : active_) {
    const Candidate& c = candidates_[index];
    const Eigen::Vector3d& n = obstacles_[c.obstacle].face(c.face).normal;
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> stiffness = (c.normal_tangent - c.across_tangent) * n * n.transpose();
    stiffness.diagonal().array() += c.across_tangent;
    const std::size_t first = static_cast<std::size_t>(c.vertex) * K;
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
            const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block = weight * stiffness;
            matrix.Add(a, f, b, g, block.data());
          }
        }
      }
    }
  }
}

void ContactTerm::EndStep(const Field& y) {
  contact_count_ = 0;
  for (const Candidate& c : candidates_) {
    const HalfSpace& face = obstacles_[c.obstacle].face(c.face);
    const Eigen::Vector3d x = PositionOf(c.vertex, y);
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
