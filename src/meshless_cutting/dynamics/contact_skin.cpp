#include "dynamics/contact_skin.h"

#include <cmath>

namespace meshless_cutting {

void ContactSkin::Build(const SurfacePoints& skin, int particles) {
  const int count = skin.count(), K = skin.support_size;
  use_.assign(particles, 0);
  owner_.resize(count);
  begin.assign(particles + 1, 0);
  vertices.resize(count);
  share.resize(count);
  for (int v = 0; v < count; ++v) {
    const std::size_t first = static_cast<std::size_t>(v) * K;
    int best = 0;
    for (int k = 0; k < K; ++k) {
      use_[skin.particles[first + k]] += std::abs(skin.weights[first + k]);
      if (skin.weights[first + k] > skin.weights[first + best]) best = k;
    }
    owner_[v] = skin.particles[first + best];
    ++begin[owner_[v] + 1];
  }
  for (int j = 0; j < particles; ++j) begin[j + 1] += begin[j];
  for (int v = count - 1; v >= 0; --v) vertices[--begin[owner_[v] + 1]] = v;
  // Filling from the back moved every entry of `begin` down to the start of its own row, one place too high.
  for (int j = 0; j < particles; ++j) begin[j] = begin[j + 1];
  begin[particles] = count;
  for (int v = 0; v < count; ++v) {
    const std::size_t first = static_cast<std::size_t>(v) * K;
    double sum = 0;
    for (int k = 0; k < K; ++k) {
      const double use = use_[skin.particles[first + k]];
      if (use > 0) sum += std::abs(skin.weights[first + k]) / use;
    }
    share[v] = sum;
  }
}

}  // namespace meshless_cutting
