#include "cut/stroke_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "../lattice/meshes.h"
#include "crossing/edge_edge.h"
#include "crossing/find_crossings.h"
#include "cut/soft_body.h"
#include "lattice/lattice_builder.h"
#include "simulation_checks.h"

namespace meshless_cutting {
namespace {

using Random = std::mt19937_64;

double Uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
bool Chance(Random& random, double p) { return Uniform(random, 0, 1) < p; }
int Pick(Random& random, int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }
Eigen::Vector3d RandomVector(Random& random, double size) {
  return {Uniform(random, -size, size), Uniform(random, -size, size), Uniform(random, -size, size)};
}

/// Links that one of the blades crosses in the window, by trying them all.
std::vector<int> ExhaustiveSearch(const SoftBody& body, const std::vector<BladeMotion>& blades) {
  auto at = [](const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, double t) -> Eigen::Vector3d {
    return (1 - t) * x0 + t * x1;
  };
  std::vector<LatticeMotion::Window> windows;
  for (size_t v = 0; v < body.lattice().vertices.size(); ++v) windows.push_back(body.motion().At(static_cast<int>(v)));
  std::vector<int> links;
  for (size_t l = 0; l < body.lattice().links.size(); ++l) {
    if (body.graph().IsCut(static_cast<int>(l))) continue;
    const LatticeMotion::Window &a = windows[body.lattice().links[l][0]], &b = windows[body.lattice().links[l][1]];
    bool crossed = false;
    for (const BladeMotion& blade : blades)
      for (const BladeWindow& w : blade) {
        const MovingSegment object = {at(a.start, a.end, w.t0), at(b.start, b.end, w.t0), at(a.start, a.end, w.t1),
                                      at(b.start, b.end, w.t1)};
        for (size_t e = 0; e + 1 < w.points_t0.size() && !crossed; ++e)
          crossed = FindFirstCrossing({w.points_t0[e], w.points_t0[e + 1], w.points_t1[e], w.points_t1[e + 1]}, object)
                        .has_value();
      }
    if (crossed) links.push_back(static_cast<int>(l));
  }
  return links;
}

/// A polyline that flies through the body, bends and twists; or one that is laid exactly on vertices of the lattice.
class RandomBlade {
 public:
  RandomBlade(const SoftBody& body, Random& random) : random_(random) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& x : body.surface().positions) box.extend(x);
    size_ = box.sizes().norm();
    exact_ = Chance(random, 0.15);
    if (exact_) {
      for (int i = Pick(random, 2, 4); i > 0; --i) points_.push_back(VertexOf(body));
      return;
    }
    const int edges = Pick(random, 1, 6);
    const Eigen::Vector3d start = box.center() + RandomVector(random, 0.6 * size_);
    const Eigen::Vector3d along = RandomVector(random, 1).normalized() * Uniform(random, 0.1, 1.2) * size_;
    const double bend = Chance(random, 0.5) ? 0 : 0.1 * size_;
    for (int i = 0; i <= edges; ++i)
      points_.push_back(start + along * (static_cast<double>(i) / edges - 0.5) + RandomVector(random, bend));
    if (Chance(random, 0.1)) points_.push_back(points_.back());  // an edge without length
    const double frames = Chance(random, 0.2) ? 1 : Uniform(random, 2, 6);
    velocity_ = (box.center() - start) * (2 / frames) + RandomVector(random, 0.02 * size_);
    twist_ = RandomVector(random, Chance(random, 0.5) ? 0.3 : 0);
  }

  BladeMotion Frame(const SoftBody& body) {
    const int windows = Pick(random_, 1, 3);
    BladeMotion motion;
    const double mode = Uniform(random_, 0, 1);  // rest, go back, go on
    if (mode < 0.1) velocity_ = -velocity_;
    for (int i = 0; i < windows; ++i) {
      BladeWindow w{i / static_cast<double>(windows), (i + 1) / static_cast<double>(windows), points_, {}};
      if (mode > 0.2) {
        const Eigen::Vector3d centre = points_[points_.size() / 2];
        const Eigen::Matrix3d turn =
            twist_.norm() > 0 ? Eigen::AngleAxisd(twist_.norm() / windows, twist_.normalized()).toRotationMatrix()
                              : Eigen::Matrix3d::Identity();
        for (Eigen::Vector3d& p : points_) {
          if (exact_)
            p = VertexOf(body);
          else
            p = centre + turn * (p - centre) + velocity_ / windows;
        }
      }
      w.points_t1 = points_;
      motion.push_back(w);
    }
    return motion;
  }

 private:
  /// Where the search has a vertex now, to the last bit.
  Eigen::Vector3d VertexOf(const SoftBody& body) {
    return body.motion().At(Pick(random_, 0, static_cast<int>(body.lattice().vertices.size()) - 1)).end;
  }

  Random& random_;
  double size_ = 0;
  bool exact_ = false;
  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), twist_ = Eigen::Vector3d::Zero();
};

/// Sums over the particles: mass, momentum, angular momentum, first moment.
Eigen::Matrix<double, 10, 1> Totals(const SoftBody& body) {
  Eigen::Matrix<double, 10, 1> sum = Eigen::Matrix<double, 10, 1>::Zero();
  for (size_t j = 0; j < body.state().position.size(); ++j) {
    const double m = body.tissue().particle_mass[j];
    const Eigen::Vector3d &x = body.state().position[j], &v = body.state().velocity[j];
    sum[0] += m;
    sum.segment<3>(1) += m * v;
    sum.segment<3>(4) += m * x.cross(v);
    sum.segment<3>(7) += m * x;
  }
  return sum;
}

class Episode {
 public:
  Episode(const Lattice& lattice, const ObjectConfig& config, std::uint64_t seed, SearchCounts& counts)
      : random_(seed), counts_(counts), body_(lattice, config, true), cell_size_(config.cell_size_m) {
    for (int i = 0; i < 2; ++i) finders_.emplace_back(body_.lattice(), body_.graph());
    volume_ = RestVolume(body_.surface());
  }

  std::string Stroke() {
    std::vector<RandomBlade> blades;
    for (int i = Chance(random_, 0.2) ? 2 : 1; i > 0; --i) blades.emplace_back(body_, random_);
    const bool repeats = !last_stroke_.empty() && Chance(random_, 0.15);  // follows an earlier cut
    std::vector<std::vector<BladeMotion>> stroke;
    const size_t frames = repeats ? last_stroke_.size() : static_cast<size_t>(Pick(random_, 3, 8));
    ++counts_.strokes;
    for (size_t frame = 0; frame < frames; ++frame) {
      std::vector<BladeMotion> motions;
      if (repeats)
        motions = last_stroke_[frame];
      else
        for (RandomBlade& blade : blades) motions.push_back(blade.Frame(body_));
      stroke.push_back(motions);
      if (std::string error = Frame(motions); !error.empty()) return "frame " + std::to_string(frame) + ": " + error;
    }
    last_stroke_ = std::move(stroke);
    return {};
  }

  const SoftBody& body() const { return body_; }

 private:
  std::string Frame(const std::vector<BladeMotion>& blades) {
    ++counts_.frames;
    std::vector<LinkCut> cuts;
    std::vector<int> links;
    for (size_t i = 0; i < blades.size(); ++i)
      for (const Crossing& c : finders_[i].Find(blades[i], body_.motion())) {
        if (!(c.t >= 0 && c.t <= 1 && c.cut.u >= 0 && c.cut.u <= 1)) return "a crossing outside its frame or link";
        if (std::find(links.begin(), links.end(), c.cut.link) != links.end()) continue;  // of the other blade
        links.push_back(c.cut.link);
        cuts.push_back(c.cut);
      }
    std::sort(links.begin(), links.end());
    ++counts_.predicates;
    if (links != ExhaustiveSearch(body_, blades)) return "the search and an exhaustive exact search differ";
    body_.CloseWindow();
    counts_.links_cut += static_cast<long>(links.size());
    if (!cuts.empty())
      if (std::string error = Cut(cuts); !error.empty()) return error;
    Move();
    return {};
  }

  std::string Cut(const std::vector<LinkCut>& cuts) {
    for (Eigen::Vector3d& v : body_.mutable_state().velocity) v = RandomVector(random_, 1);
    const auto before = Totals(body_);
    body_.Cut(cuts);
    const auto after = Totals(body_);
    counts_.predicates += 8;
    // Each component is a sum of positive and negative parts no larger than mass times size times speed.
    double extent = 1;
    for (const Eigen::Vector3d& x : body_.state().position) extent = std::max(extent, x.cwiseAbs().maxCoeff());
    if (!((after - before).cwiseAbs().maxCoeff() <= 1e-11 * before[0] * extent))
      return "mass, momentum or angular momentum changed by a cut";
    if (std::string error = CheckBody(body_); !error.empty()) return error;
    if (!(std::abs(RestVolume(body_.surface()) - volume_) <= 1e-11 * volume_)) return "the rest volume changed by a cut";
    return {};
  }

  /// Any motion of the particles will do: a common drift, a flow and noise; now and then rest.
  void Move() {
    body_.BeginAdvance();
    if (Chance(random_, 0.8)) {
      const Eigen::Vector3d drift = RandomVector(random_, 0.3 * cell_size_);
      const Eigen::Matrix3d flow = Eigen::Matrix3d::NullaryExpr([&] { return Uniform(random_, -0.05, 0.05); });
      const double noise = Uniform(random_, 0, 0.05) * cell_size_;
      for (Eigen::Vector3d& x : body_.mutable_state().position) x += drift + flow * x + RandomVector(random_, noise);
    }
    body_.EndAdvance();
  }

  Random random_;
  SearchCounts& counts_;
  SoftBody body_;
  double cell_size_, volume_ = 0;
  std::vector<CrossingFinder> finders_;
  std::vector<std::vector<BladeMotion>> last_stroke_;
};

Lattice Fill(const TriangleMesh& mesh, double size) { return FillWithLattice(mesh, size).lattice; }

TriangleMesh Liver() { return ReadTriangleMesh(MESHLESS_CUTTING_SOURCE_DIR "/meshes/liver.obj", 1); }

}  // namespace

const std::vector<SearchBody>& SearchBodies() {
  static const std::vector<SearchBody> bodies = {
      {"block", 0.01, [] { return Fill(meshes::Box({-0.02, -0.015, -0.01}, {0.02, 0.015, 0.01}), 0.006); }},
      {"plate", 0.008, [] { return Fill(meshes::Box({-0.02, -0.02, -0.001}, {0.02, 0.02, 0.001}), 0.005); }},
      {"sphere", 0.013, [] { return Fill(meshes::Sphere(0.02), 0.009); }},
      {"torus", 0.01, [] { return Fill(meshes::Torus(0.02, 0.008), 0.006); }},
      {"liver", 0.035, [] { return Fill(Liver(), 0.025); }},
      {"brain", 0.028,
       [] { return Fill(ReadTriangleMesh(MESHLESS_CUTTING_SOURCE_DIR "/meshes/brain.obj", 1), 0.018); }},
      {"flipped", 0.013, [] { return Fill(meshes::Flipped(meshes::Sphere(0.02), 0.3), 0.009); }},
      {"holed", 0.013,
       [] {
         return Fill(meshes::Without(meshes::Sphere(0.02), [](const Eigen::Vector3d& c) { return c[2] > 0.0185; }),
                     0.009);
       }},
      {"shaken", 0.012, [] { return Fill(meshes::Shaken(meshes::Torus(0.02, 0.009), 0.002, 7), 0.007); }},
  };
  return bodies;
}

std::string SearchEpisode(const Lattice& lattice, double cell_size_m, std::uint64_t seed, int strokes,
                          SearchCounts& counts) {
  ObjectConfig config;
  config.cell_size_m = cell_size_m;
  config.material.density_kg_m3 = 1000;
  Box low;  // every second body is held by its lower third
  low.min = low.max = lattice.vertices[0];
  for (const Eigen::Vector3d& X : lattice.vertices) {
    low.min = low.min.cwiseMin(X);
    low.max = low.max.cwiseMax(X);
  }
  low.max[2] = low.min[2] + (low.max[2] - low.min[2]) / 3;
  if (seed % 2 == 0) config.fixed.push_back(low);
  Episode episode(lattice, config, seed, counts);
  for (int i = 0; i < strokes; ++i)
    if (std::string error = episode.Stroke(); !error.empty()) return "stroke " + std::to_string(i) + ", " + error;
  counts.fragments += static_cast<long>(episode.body().surface().fragment_volume_m3.size());
  return {};
}

}  // namespace meshless_cutting
