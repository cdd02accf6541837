// A blade that ends on lattice vertices cuts what it touches.
#pragma once

#include "tool/blade_motion.h"

namespace meshless_cutting {

/// The motion of a blade that is longer by `rim`, m, at both ends of its edge and that goes on by as much at the end of each window. For the
/// crossing search vertices stand a little off their place; without a rim a blade that stops exactly at a layer of them would leave
/// some of its links whole, and all particles behind the layer with them.
BladeMotion WithRim(BladeMotion motion, double rim);

}  // namespace meshless_cutting
