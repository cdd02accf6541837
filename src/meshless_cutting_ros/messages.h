// The package's own messages. The generator puts them into the namespace of the package, where the simulation has
// values named CutEvent and StepStatistics: those two messages are renamed here, and only here may their headers be
// included.
#pragma once

#define CutEvent CutEventMsg
#define CutEventPtr CutEventMsgPtr
#define CutEventConstPtr CutEventMsgConstPtr
#include <meshless_cutting/CutEvent.h>
#undef CutEvent
#undef CutEventPtr
#undef CutEventConstPtr

#define StepStatistics StepStatisticsMsg
#define StepStatisticsPtr StepStatisticsMsgPtr
#define StepStatisticsConstPtr StepStatisticsMsgConstPtr
#include <meshless_cutting/StepStatistics.h>
#undef StepStatistics
#undef StepStatisticsPtr
#undef StepStatisticsConstPtr

#include <meshless_cutting/SessionInfo.h>
#include <meshless_cutting/SurfacePositions.h>
#include <meshless_cutting/SurfaceTopology.h>
