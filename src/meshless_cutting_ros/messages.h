// The package's own messages, in its namespace.
#pragma once

#include <meshless_cutting/CutEvent.h>
#include <meshless_cutting/FrameInput.h>
#include <meshless_cutting/SessionInfo.h>
#include <meshless_cutting/StepStatistics.h>
#include <meshless_cutting/SurfacePositions.h>
#include <meshless_cutting/SurfaceTopology.h>
