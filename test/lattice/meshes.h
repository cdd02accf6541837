// Input surfaces for the tests of the lattice, good and bad ones.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "lattice/triangle_mesh.h"

namespace meshless_cutting::meshes {

inline constexpr double kPi = 3.14159265358979323846;

inline TriangleMesh Box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(), i & 4 ? max.z() : min.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// A closed grid of rows and columns, wrapping in both directions: `point(i / rows, j / columns)`.
template <typename Point>
TriangleMesh Wrapped(int rows, int columns, const Point& point) {
  TriangleMesh mesh;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) mesh.vertices.push_back(point(double(i) / rows, double(j) / columns));
  }
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const int a = i * columns + j;
      const int b = (i + 1) % rows * columns + j;
      const int c = (i + 1) % rows * columns + (j + 1) % columns;
      const int d = i * columns + (j + 1) % columns;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

inline TriangleMesh Torus(double major, double minor, int rows = 64, int columns = 32) {
  return Wrapped(rows, columns, [&](double u, double v) {
    const double r = major + minor * std::cos(2 * kPi * v);
    return Eigen::Vector3d(r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), minor * std::sin(2 * kPi * v));
  });
}

/// Latitudes and longitudes with a pole at either end, about the origin.
inline TriangleMesh Sphere(double radius, int rows = 32, int columns = 64) {
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0, 0, radius);
  for (int i = 1; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double theta = kPi * i / rows;
      const double phi = 2 * kPi * j / columns;
      mesh.vertices.emplace_back(radius * std::sin(theta) * std::cos(phi), radius * std::sin(theta) * std::sin(phi),
                                 radius * std::cos(theta));
    }
  }
  mesh.vertices.emplace_back(0, 0, -radius);
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int i, int j) { return 1 + (i - 1) * columns + j % columns; };
  for (int j = 0; j < columns; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (int i = 1; i + 1 < rows; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    mesh.triangles.push_back({last, at(rows - 1, j + 1), at(rows - 1, j)});
  }
  return mesh;
}

inline TriangleMesh Moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& p : mesh.vertices) p += by;
  return mesh;
}

inline TriangleMesh Rotated(TriangleMesh mesh, double angle, const Eigen::Vector3d& axis) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  for (Eigen::Vector3d& p : mesh.vertices) p = R * p;
  return mesh;
}

inline TriangleMesh Joined(TriangleMesh a, const TriangleMesh& b) {
  const int first = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return a;
}

/// Turns each triangle around with probability `share`.
inline TriangleMesh Flipped(TriangleMesh mesh, double share, unsigned seed = 1) {
  std::mt19937 random(seed);
  for (auto& t : mesh.triangles) {
    if (random() < share * 4294967296.0) std::swap(t[1], t[2]);
  }
  return mesh;
}

/// Every triangle `times` times, copies turned around with probability `flipped`.
inline TriangleMesh Repeated(const TriangleMesh& mesh, int times, double flipped, unsigned seed = 2) {
  TriangleMesh repeated = mesh;
  for (int i = 1; i < times; ++i) {
    const TriangleMesh copy = Flipped(mesh, flipped, seed + i);
    repeated.triangles.insert(repeated.triangles.end(), copy.triangles.begin(), copy.triangles.end());
  }
  return repeated;
}

/// Three own vertices for each triangle, as in an STL file.
inline TriangleMesh Soup(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const auto& t : mesh.triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (const int v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// Removes the triangles whose centre `is_removed`.
template <typename Predicate>
TriangleMesh Without(TriangleMesh mesh, const Predicate& is_removed) {
  const auto removed = std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const std::array<int, 3>& t) {
    return is_removed(Eigen::Vector3d((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3));
  });
  mesh.triangles.erase(removed, mesh.triangles.end());
  return mesh;
}

/// Moves each vertex by up to `amplitude` along each axis.
inline TriangleMesh Shaken(TriangleMesh mesh, double amplitude, unsigned seed) {
  std::mt19937 random(seed);
  const auto next = [&] { return amplitude * (random() / 2147483648.0 - 1); };
  for (Eigen::Vector3d& p : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += next();
  }
  return mesh;
}

/// Triangles between random points of the unit cube: nothing closed, nothing manifold.
inline TriangleMesh Noise(int vertices, int triangles, unsigned seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh;
  for (int i = 0; i < vertices; ++i) {
    const double x = random() / 4294967296.0;
    const double y = random() / 4294967296.0;
    const double z = random() / 4294967296.0;
    mesh.vertices.emplace_back(x, y, z);
  }
  const auto index = [&] { return static_cast<int>(random() % static_cast<unsigned>(vertices)); };
  for (int i = 0; i < triangles; ++i) {
    const int a = index();
    const int b = index();
    const int c = index();
    mesh.triangles.push_back({a, b, c});
  }
  return mesh;
}

}  // namespace meshless_cutting::meshes
