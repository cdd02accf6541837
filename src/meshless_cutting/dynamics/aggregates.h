// Groups of neighbouring particles that move together: the coarse space of the solver.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/field.h"
#include "tissue/tissue.h"

namespace meshless_cutting {

/// Every particle that moves belongs to one aggregate. Its particles lie in one cell of a coarse grid and hang together
/// by integration points inside that cell: two lips of a cut, two fragments, two banks of a fold are never one
/// aggregate. An aggregate carries an affine field; `basis` holds the values b_0 .. b_3 of its up to four scalar
/// functions at a particle, orthonormal over the aggregate (where it is flat some of them are zero everywhere).
struct Aggregates {
  std::vector<int> of_particle;  // aggregate, -1: none
  Field basis;                   // per particle

  // The particles of aggregate a: particles[begin[a], begin[a + 1]).
  std::vector<int> begin{0}, particles;

  int count() const { return static_cast<int>(begin.size()) - 1; }

  /// `free`: 1 for particles that move. Aims at `wanted` aggregates; no more than half as many again where the pieces
  /// are large enough to be joined.
  void Build(const Tissue& tissue, const std::vector<double>& free, int wanted);

  /// After a cut, without looking at what it separated: new particles join the aggregate that the particle at their
  /// rest position, of which they are twins, was put into by Build. A new particle that is nobody's twin is in none.
  void Extend(const Tissue& tissue, const std::vector<double>& free);

 private:
  /// Where Build found a particle, sorted by X.
  struct Site {
    Eigen::Vector3d X;
    int aggregate;
    Vector4 basis;
  };

  void BuildOnce(const Tissue& tissue, const std::vector<double>& free, int wanted);
  void List();
  int Find(int j);
  void Join(const Tissue& tissue);
  void MergeSmall(const Tissue& tissue);
  void Number(const std::vector<double>& free);
  void BuildBasis(const Tissue& tissue);

  std::vector<Site> sites_;
  std::vector<int> cell_, parent_, size_, number_;
};

}  // namespace meshless_cutting
