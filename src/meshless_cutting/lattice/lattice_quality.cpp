#include "lattice/lattice_quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "lattice/closest_point.h"
#include "lattice/triangle_tree.h"
#include "lattice/winding_number.h"

namespace meshless_cutting {
namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;

/// Whether a piece of the input bounds the object: inside on one side of it, outside on the other. Inner walls, parts
/// that lie in other parts and fins without thickness do not. The winding number grows by 1 from the front of an
/// oriented triangle to its back, so that one side tells both.
bool IsBoundary(const WindingNumber& winding, const Eigen::Vector3d& before_front) {
  const double front = winding(before_front);
  return front <= 0.5 && front > -0.5;
}

}  // namespace

std::array<double, 2> DihedralRange(const std::array<Eigen::Vector3d, 4>& corners) {
  std::array<Eigen::Vector3d, 4> normals;
  for (int f = 0; f < 4; ++f) {
    const auto& face = kTetrahedronFaces[f];
    normals[f] = (corners[face[1]] - corners[face[0]]).cross(corners[face[2]] - corners[face[0]]).normalized();
  }
  double low = 1;
  double high = -1;
  for (const auto& [i, j] : kTetrahedronLinks) {
    const double cosine = -normals[i].dot(normals[j]);
    low = std::min(low, cosine);
    high = std::max(high, cosine);
  }
  const auto degrees = [](double cosine) { return kDegreesPerRadian * std::acos(std::clamp(cosine, -1.0, 1.0)); };
  return {degrees(high), degrees(low)};
}

TriangleMesh SkinOf(const Lattice& lattice) {
  TriangleMesh skin;
  std::vector<int> index(lattice.vertices.size(), -1);
  for (size_t f = 0; f < lattice.faces.size(); ++f) {
    if (lattice.face_tetrahedra[f][1] >= 0) continue;
    std::array<int, 3> triangle = lattice.faces[f];
    for (int& v : triangle) {
      if (index[v] < 0) {
        index[v] = static_cast<int>(skin.vertices.size());
        skin.vertices.push_back(lattice.vertices[v]);
      }
      v = index[v];
    }
    skin.triangles.push_back(triangle);
  }
  return skin;
}

double EnclosedVolume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Eigen::Vector3d& origin = mesh.vertices[0];  // near the object: less cancellation
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - origin;
    six_volumes += a.dot((mesh.vertices[t[1]] - origin).cross(mesh.vertices[t[2]] - origin));
  }
  return six_volumes / 6;
}

void MeasureLattice(const Lattice& lattice, const TriangleMesh& input, double lattice_size, LatticeReport* report) {
  report->min_dihedral_deg = 180;
  report->max_dihedral_deg = 0;
  for (const auto& t : lattice.tetrahedra) {
    const auto [low, high] =
        DihedralRange({lattice.vertices[t[0]], lattice.vertices[t[1]], lattice.vertices[t[2]], lattice.vertices[t[3]]});
    report->min_dihedral_deg = std::min(report->min_dihedral_deg, low);
    report->max_dihedral_deg = std::max(report->max_dihedral_deg, high);
  }
  const TriangleMesh skin = SkinOf(lattice);
  report->volume_m3 = EnclosedVolume(skin);

  const TriangleTree input_tree(input);
  report->skin_to_input_max_m = 0;
  for (const Eigen::Vector3d& p : skin.vertices) {
    report->skin_to_input_max_m = std::max(report->skin_to_input_max_m, FindClosestPoint(input_tree, p).distance);
  }
  const TriangleTree skin_tree(skin);
  const WindingNumber winding(input_tree);
  report->input_to_skin_max_m = 0;
  double weighted = 0;
  double weight = 0;
  for (const auto& t : input.triangles) {
    const Eigen::Vector3d& a = input.vertices[t[0]];
    const Eigen::Vector3d& b = input.vertices[t[1]];
    const Eigen::Vector3d& c = input.vertices[t[2]];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int pieces = std::clamp(static_cast<int>(std::ceil(longest / lattice_size + 0.5)), 1, 200);
    const Eigen::Vector3d offset = 1e-4 * lattice_size * (b - a).cross(c - a).stableNormalized();
    double sum = 0;
    int samples = 0;
    std::optional<bool> is_boundary;  // asked only where it matters: it costs more than the distance
    for (int i = 0; i <= pieces; ++i) {
      for (int j = 0; i + j <= pieces; ++j) {
        const Eigen::Vector3d p = a + (b - a) * i / pieces + (c - a) * j / pieces;
        const double distance = FindClosestPoint(skin_tree, p).distance;
        if (distance > 0.1 * lattice_size) {
          if (!is_boundary || pieces > 2) {
            is_boundary = IsBoundary(winding, (pieces > 2 ? p : Eigen::Vector3d((a + b + c) / 3)) + offset);
          }
          if (!*is_boundary) continue;
        }
        ++samples;
        report->input_to_skin_max_m = std::max(report->input_to_skin_max_m, distance);
        sum += distance;
      }
    }
    if (samples == 0) continue;
    const double area = (b - a).cross(c - a).norm();
    weighted += area * sum / samples;
    weight += area;
  }
  report->input_to_skin_mean_m = weight > 0 ? weighted / weight : 0;
}

}  // namespace meshless_cutting
