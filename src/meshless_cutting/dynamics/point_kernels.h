// The loops over integration points, compiled for several instruction sets and chosen once when the program runs. All
// give the same bits: the same operations in the same order, none of them fused.
#pragma once

#include "dynamics/field.h"
#include "dynamics/point_groups.h"
#include "scene/scene.h"
#include "tissue/materials.h"

namespace meshless_cutting {

/// What a loop reads and writes. The tangent belongs to the group, slots to all groups. What is single is for `product`
/// alone; a tangent is kept either way.
struct KernelArguments {
  const PointGroup* group = nullptr;
  PointChunk chunk;
  int slot_count = 0;  // size of a buffer of slots
  const int* slot_particle = nullptr;  // see PointGroups
  LameConstants lame;
  const Vector4* field = nullptr;  // per particle: positions, m, or a direction
  Vector4* slots = nullptr;        // buffer of slots
  const SingleVector4* single_field = nullptr;
  SingleVector4* single_slots = nullptr;
  double* tangent = nullptr;        // [batch][tangent_size][lane]
  float* single_tangent = nullptr;  // likewise, if there is no other
  bool filtered = true;             // linearise: positive semidefinite

  // evaluate_damped: damping / 2 way^T K way is added, K the tangent and way = field - still.
  const Vector4* still = nullptr;
  double damping = 0;
};

/// The loops for one material law and one shape of support.
struct PointKernels {
  int tangent_size;  // numbers per point

  /// Energy of the points, J, strain and stabilisation; its gradient by each particle goes to the slots, N.
  double (*evaluate)(const KernelArguments&);
  double (*evaluate_damped)(const KernelArguments&);
  /// The tangent at `field`, if filtered made positive semidefinite.
  void (*linearise)(const KernelArguments&);
  /// Tangent times direction into the slots, N.
  void (*product)(const KernelArguments&);
  /// The same in single precision throughout.
  void (*single_product)(const KernelArguments&);
  /// The 3 x 3 blocks of the diagonal, N/m: two buffers' worth, first xx yy zz, then xy xz yz.
  void (*diagonal)(const KernelArguments&);
  /// Blocks B_cd = g_c,a (d2Psi / dF_ia dF_lb) h_d,b of one point, times its volume, for four vectors g and four h:
  /// blocks[c][3 i + l][d]. Vectors are given as [component][4].
  void (*blocks)(const KernelArguments&, const PointPlace& place, const double (*g)[4], const double (*h)[4],
                 double (*blocks)[9][4]);
  /// tensor[3 a + b][3 i + l] += d2Psi / dF_ia dF_lb times volume, for points of the group.
  void (*add_tensors)(const KernelArguments&, const PointPlace* places, int count, double (*tensor)[9]);
};

/// The fastest that this processor can run.
const PointKernels& SelectPointKernels(MaterialModel model, SupportShape shape);

/// One instruction set's table, [model][shape].
using PointKernelTable = PointKernels[4][kSupportShapes];
extern const PointKernelTable kPointKernelsBaseline;
#if defined(__x86_64__)
extern const PointKernelTable kPointKernelsAvx2;
extern const PointKernelTable kPointKernelsAvx512;
#endif

}  // namespace meshless_cutting
